"""Intervals beside errors: where the cost is no parabola, and at bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.estimate.covariance import Fit
from erdctl.estimate.finer import MOST_SAMPLES, Finer
from erdctl.estimate.linearisation import linearised
from erdctl.estimate.profile import Linear, interval, others, parabolic
from erdctl.model.parameters import NORMAL_95

OUTLYING = 2.0  # standard deviations of the noise: no single sample rises beyond 1.96^2
ROUNDING = 1e-4  # of the force, below which nothing is told apart
GUESS = 1e-3  # of a value or a start, where there is no error to begin with


def with_intervals(
    found: Fit,
    blocks: Sequence[Block],
    finer: Sequence[Finer],
    plain: Array,
    bounded: Sequence[str] = (),
) -> Fit:
    """The fit with intervals of effects' parameters that the cost is no parabola of.

    plain : (p,) variances that noise of unit variance would make, for where each is told from
    bounded : parameters at a bound, which are not free
    Where a profile finds a better value, the fit has it.
    """
    model, free = found.model, found.free
    asked = [
        n for n in free
        if n.split(".")[0] not in DIRECTIONS and n not in model.linear
        and not any(n in group and group != (n,) for group in found.flat)
    ]  # fmt: skip
    if not (asked or bounded) or sum(len(b.force) for b in blocks) > MOST_SAMPLES:
        return found
    root = np.sqrt(np.concatenate([b.weight for b in blocks]))
    measured = np.concatenate([b.force for b in blocks])
    values, intervals = dict(found.values), {}
    rows = _rows(found, finer, values) * root
    limit = farthest(measured - _force(found, finer, values), root, measured)
    robust = np.diag(found.covariance)
    usual = _noise(robust, plain)
    for name in [*asked, *bounded]:
        q, at = model.quantities[name], [i for i, n in enumerate(free) if n == name]
        rest, own = others(rows, free, name), _noise(robust[at], plain[at])
        phi = max(own, usual) if np.isfinite(own) else usual
        if not np.isfinite(phi):
            continue
        cost = _cost(found, finer, values, name, rest, measured, root, limit, phi)
        error = float(np.sqrt(max(robust[at[0]], 0.0))) if at else 0.0
        if parabolic(cost, q, values[name], error):
            continue
        size = (
            error if error > 0.0 and np.isfinite(error) else GUESS * max(abs(values[name]), q.start)
        )
        best, low, high = interval(cost, q, values[name], NORMAL_95 * size)
        intervals[name] = (low, high)
        if best != values[name]:
            values = _taken_up(found, finer, {**values, name: best}, name, rest, measured, root)
    flat = tuple(g for g in found.flat if g[0] not in intervals)
    return replace(found, values=values, intervals=intervals, flat=flat)


def farthest(residual: Array, root: Array, measured: Array) -> float:
    """Residual beyond which a sample holds more than noise [N].

    A contact that falls to the other side of one sample is no noise, and must not decide against
    what all others tell: it counts as if it were no larger.
    """
    size = np.abs(residual[root > 0.0])
    if not size.size:
        return np.inf
    least = ROUNDING * float(np.abs(measured).max())
    return max(OUTLYING * 1.4826 * float(np.median(size)), least)


def _noise(robust: Array, plain: Array) -> float:
    """Variance of the noise as it counts for some parameters [N^2]."""
    known = (plain > 0.0) & (robust > 0.0)
    return float(np.median(robust[known] / plain[known])) if known.any() else float("nan")


def _rows(found: Fit, finer: Sequence[Finer], values: dict[str, float]) -> Array:
    parts = [linearised(found.model, f, values, found.free, wide=True)[1] for f in finer]
    return np.concatenate(parts, axis=1)


def _force(found: Fit, finer: Sequence[Finer], values: dict[str, float]) -> Array:
    return np.concatenate([f.force(found.model, values) for f in finer])


def _cost(
    found: Fit, finer: Sequence[Finer], values: dict[str, float], name: str, rest: Linear,
    measured: Array, root: Array, limit: float, phi: float,
) -> Callable[[float], float]:  # fmt: skip
    known: dict[float, float] = {}

    def cost(value: float) -> float:
        if value not in known:
            force = _force(found, finer, {**values, name: value})
            residual = measured - force
            over = np.abs(residual) > limit
            beyond = float(np.sum((root[over] * limit) ** 2))
            left = rest.left(np.where(over, 0.0, residual * root))
            known[value] = (left + beyond) / phi
        return known[value]

    return cost


def _taken_up(
    found: Fit, finer: Sequence[Finer], values: dict[str, float], name: str, rest: Linear,
    measured: Array, root: Array,
) -> dict[str, float]:  # fmt: skip
    """The values with the other parameters moved to a new one's best."""
    residual = (measured - _force(found, finer, values)) * root
    step = rest.normal.solve(rest.rows @ residual)
    out = dict(values)
    for other, move in zip([n for n in found.free if n != name], step.tolist(), strict=True):
        q = found.model.quantities[other]
        out[other] = float(np.clip(values[other] + move, q.low, q.high))
    return out
