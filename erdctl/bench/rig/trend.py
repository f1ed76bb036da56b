"""One number of each record against the trend that the other records have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import Array

FREEDOM = 2  # degrees of freedom that the scatter of the others has, at least
LEVER = 4.0  # uncertainty of the trend over the scatter, squared, beyond which it tells nothing
EPS = float(np.finfo(np.float64).eps)
CLEAR = 3.0  # below which nobody need ask for the chance
CHANCE = 4e-3  # of such a number among records that are alike, all of them together
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

    which is, with the rest e of a trend fitted to all and H = X (X' X)^-1 X',

        d = e_i / (1 - H_ii),   1 + x_i (X' X)^-1 x_i' = 1 / (1 - H_ii)

    prior : a scatter that is known beforehand, taken with PRIOR degrees of freedom
    Left out are rows that the others do not reach: their trend is not known there.
    Check: 0, 0, 1, -1, 10 about a mean: d = 10, s = sqrt(2 / 3), t = 10 / (s sqrt(5 / 4)) = 10.954.
    >>> found = studentised(np.array([0.0, 0.0, 1.0, -1.0, 10.0]), np.ones((5, 1)))
    >>> round(found[4].student, 3)
    10.954
    """
    left, sizes, _ = np.linalg.svd(trend, full_matrices=False)
    rank = int(np.count_nonzero(sizes > sizes.max(initial=0.0) * max(trend.shape) * EPS))
    free = len(values) - 1 - rank
    if free < FREEDOM:
        return []
    basis = left[:, :rank]
    own = np.sum(basis**2, axis=1)  # of the trend at a record that is the record itself
    rest = values - basis @ (basis.T @ values)
    squares = float(rest @ rest)
    more = PRIOR if prior > 0 else 0
    out = []
    for i in np.flatnonzero(own <= LEVER / (1.0 + LEVER)).tolist():
        others = 1.0 - float(own[i])
        square = max(squares - float(rest[i]) ** 2 / others, 0.0) + more * prior**2
        scatter = float(np.sqrt(square / (free + more)))
        away = float(rest[i]) / others
        t = away / (max(scatter, 1e-12) * others**-0.5)
        out.append(Away(i, away, scatter, t, free + more))
    return out


def clearest(
    values: Sequence[float], trend: Array, least: Sequence[float], prior: float
) -> Away | None:
    """The record that is farthest out, by its number, if any is by more than `least` of it."""
    found = [
        a
        for a in studentised(np.array(values), trend, prior)
        if abs(a.difference) > least[a.index]
        and abs(a.student) > CLEAR
        and a.chance * len(values) < CHANCE
    ]
    return max(found, key=lambda a: abs(a.student), default=None)
