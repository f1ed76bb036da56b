"""One number of each record against the trend that the other records have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import Array

FREEDOM = 2  # degrees of freedom that the scatter of the others has, at least
LEVER = 4.0  # uncertainty of the trend over the scatter, squared, beyond which it tells nothing
PRIOR = 4  # degrees of freedom that a scatter known beforehand counts


@dataclass(frozen=True)
class Away:
    """A number against the trend of the others.

    index : which;  difference : from the trend;  scatter : of the others about it
    student : the one over the other, with what the trend itself is uncertain by
    free : degrees of freedom of the scatter
    """

    index: int
    difference: float
    scatter: float
    student: float
    free: int

    @property
    def chance(self) -> float:
        """Of so large a number, either way, among values that are alike (Student's t)."""
        from scipy.special import stdtr

        return 2.0 * float(stdtr(self.free, -abs(self.student)))


def studentised(values: Array, trend: Array, prior: float = 0.0) -> list[Away]:
    """Each of values (k,) against the trend (k, p) that the others have.

        d = y_i - x_i b,   t = d / (s sqrt(1 + x_i (X' X)^-1 x_i')),   b, s, X without record i

    prior : a scatter that is known beforehand, taken with PRIOR degrees of freedom
    Left out are rows that the others do not reach: their trend is not known there.
    Check: 0, 0, 1, -1, 10 about a mean: d = 10, s = sqrt(2 / 3), t = 10 / (s sqrt(5 / 4)) = 10.954.
    >>> found = studentised(np.array([0.0, 0.0, 1.0, -1.0, 10.0]), np.ones((5, 1)))
    >>> round(found[4].student, 3)
    10.954
    """
    out = []
    for i in range(len(values)):
        others = np.arange(len(values)) != i
        X, y = trend[others], values[others]
        rank = int(np.linalg.matrix_rank(X))
        free = len(y) - rank
        if free < FREEDOM or np.linalg.matrix_rank(trend) > rank:
            continue
        inverse = np.linalg.pinv(X)
        b = inverse @ y
        more = PRIOR if prior > 0 else 0
        square = float(np.sum((y - X @ b) ** 2)) + more * prior**2
        scatter = float(np.sqrt(square / (free + more)))
        lever = float(np.sum((trend[i] @ inverse) ** 2))
        if lever > LEVER:
            continue
        away = float(values[i] - trend[i] @ b)
        t = away / (max(scatter, 1e-12) * float(np.sqrt(1.0 + lever)))
        out.append(Away(i, away, scatter, t, free + more))
    return out
