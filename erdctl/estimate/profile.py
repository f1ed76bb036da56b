"""Intervals of parameters that the cost is no parabola of: profile likelihood.

    c(theta) = min over the others of sum w r^2,   {theta : c(theta) - c_min <= 1.96^2 phi}

phi : noise variance as it counts for the parameter, its robust variance over that of the normal
equations alone (so that correlated and uneven noise widen the interval as they do an error). Where
contacts, delays and onsets pass from sample to sample the cost goes in steps, and a slope at one
point says nothing; at a bound only one side is left. The others follow to first order.

Source: D. J. Venzon, S. H. Moolgavkar, Appl. Statist. 37 (1988) 87-94 (profile-likelihood-based
confidence intervals).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.estimate.normal_equations import Normal
from erdctl.model.parameters import NORMAL_95

LIKE = (0.5, 2.0)  # of the rise that a parabola has at a few errors, to count as one
BEYOND = 4.0  # times the rise that ends an interval: no more is looked for
FARTHEST = 16  # doublings from a tenth of an error
AROUND, POINTS = 0.01, 21  # part of a value to either side, evenly looked at
SHORT = 0.7  # of the rise that ends an interval, below which refits look farther out
NARROWEST = 1e-3  # of a value or a start, the first step of these
HALVINGS = 5  # of what lies between a value inside and one outside


@dataclass(frozen=True, eq=False)
class Linear:
    """What the other parameters can take up: rows (p - 1, n) times the root weight."""

    rows: Array
    normal: Normal

    @classmethod
    def of(cls, rows: Array) -> Linear:
        """Of rows (k, n)."""
        return cls(rows, Normal.of(rows @ rows.T))

    def left(self, residual: Array) -> float:
        """Sum of squares of a weighted residual (n,) beyond them."""
        right = self.rows @ residual
        taken = float(right @ self.normal.solve(right))
        return float(residual @ residual) - taken


def parabolic(cost: Callable[[float], float], q: Quantity, value: float, error: float) -> bool:
    """Whether the cost, over phi, is a parabola up to three errors to either side."""
    if not (np.isfinite(error) and error > 0.0):
        return False
    least = cost(value)
    for way in (-2.0, 2.0, -3.0, 3.0, -1.0, 1.0):
        at = value + way * error
        if not q.low <= at <= q.high:
            return False
        if not LIKE[0] * way**2 <= cost(at) - least <= LIKE[1] * way**2:
            return False
    return True


def interval(
    cost: Callable[[float], float], q: Quantity, value: float, error: float
) -> tuple[float, float, float]:
    """Best value, low and high end of the 95 % interval; an end may be a bound of the parameter.

    cost : over phi;  error : a guess of the size of the interval
    """
    known = {value: cost(value)}
    # The least may lie some dips away, whatever the slope at the value says.
    width = max(AROUND * abs(value), 3.0 * error)
    for at in np.clip(np.linspace(value - width, value + width, POINTS), q.low, q.high).tolist():
        known[at] = cost(at)
    value = min(known, key=lambda v: known[v]) if known[value] > min(known.values()) else value
    inside = NORMAL_95**2
    ends = [_outwards(cost, q, value, way * error, known) for way in (-1.0, 1.0)]
    least = min(known.values())
    best = value if known[value] <= least + 0.05 else min(known, key=lambda v: known[v])
    good = [v for v, c in known.items() if c <= least + inside]
    out = []
    for way, end in zip((-1.0, 1.0), ends, strict=True):
        last = max(good, key=lambda v: way * v)
        past = [v for v in known if way * v > way * last]
        if not past:
            out.append(end)
            continue
        first = min(past, key=lambda v: way * v)
        for _ in range(HALVINGS):
            middle = 0.5 * (last + first)
            if cost(middle) <= least + inside:
                last = middle
            else:
                first = middle
        out.append(first)
    return best, out[0], out[1]


def widened(
    cost: Callable[[float], float], q: Quantity, best: float, low: float, high: float
) -> tuple[float, float]:
    """Ends of an interval (low, high) moved to where the cost ends it, where that is farther out.

    cost : over phi, with the others refitted. Where they follow along a bend, to first order they
        fall behind, and an interval comes out too narrow; it is never too wide by that.
    """
    inside = NORMAL_95**2
    known = {v: cost(v) for v in (best, low, high)}
    out = []
    for way, end, bound in ((-1.0, low, q.low), (1.0, high, q.high)):
        last, past = end, end
        reach = max(abs(end - best), NARROWEST * max(abs(best), abs(q.start)))
        for _ in range(FARTHEST):
            if last == bound or known[last] > min(known.values()) + SHORT * inside:
                break
            reach *= 2.0
            at = float(np.clip(best + way * reach, q.low, q.high))
            known[at] = cost(at)
            past = at
            if known[at] > min(known.values()) + inside:
                break
            last = at
        for _ in range(HALVINGS if past != last else 0):
            middle = 0.5 * (last + past)
            known[middle] = cost(middle)
            if known[middle] <= min(known.values()) + inside:
                last = middle
            else:
                past = middle
        out.append(past)
    return out[0], out[1]


def _outwards(
    cost: Callable[[float], float],
    q: Quantity,
    value: float,
    step: float,
    known: dict[float, float],
) -> float:
    """Look at values farther and farther to one side; the last one, a bound if nothing ends it."""
    reach, passed = 0.1 * step, 0
    for _ in range(FARTHEST):
        at = float(np.clip(value + reach, q.low, q.high))
        known.setdefault(at, cost(at))
        passed = passed + 1 if known[at] > min(known.values()) + BEYOND * NORMAL_95**2 else 0
        if passed > 1 or at in (q.low, q.high):
            return at
        reach *= 2.0
    return q.low if step < 0.0 else q.high


def others(rows: Array, free: Sequence[str], name: str) -> Linear:
    """What is left of rows (p, n) without one of the free parameters."""
    return Linear.of(rows[[i for i, n in enumerate(free) if n != name]])
