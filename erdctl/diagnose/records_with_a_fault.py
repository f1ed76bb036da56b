"""Records that a fault sets apart: those of which some forces are smaller than those of the others.

    residual = J dp + sum_r g_r A_r,   A_r : the forces that a fault takes a part of, in record r

The gains g_r are the records' order, and of all cuts of that order the one whose lower records
together, with one gain, leave least has the fault below it. With all products summed up by records
once, no cut costs more than a few small systems.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, slopes
from erdctl.model.effect import Effect
from erdctl.model.slots import Values


def apart(best: Hypothesis, fault: Effect) -> tuple[int, ...]:
    """Records that have a fault from their beginnings, as they would if some have: by gains."""
    G, p = _products(best, fault)
    told = _told(G, p)  # others are as they would be without
    count = len(told)
    order = np.argsort(-np.where(told, _gains(G)[p:], np.inf), kind="stable")
    cuts = range(max(int(np.count_nonzero(~told)), 1), count)
    left = [_left(_summed(G, p, order[cut:])) for cut in cuts]
    return tuple(sorted(order[cuts[int(np.argmin(left))] :].tolist())) if left else ()


def is_no_scatter(
    best: Hypothesis, fault: Effect, f: float, having: Sequence[int], *, may_be_a_gain: bool
) -> bool:
    """Whether what is left of some records is far below the others, held against how they scatter.

    best : with the fault;  f : what it leaves [1]
    having : the records that have it from their beginnings
    may_be_a_gain : whether it is like a gain of records: then of a rig that is off, however far,
        a cut of all these gains must hardly go as far
    """
    scatter, records = _scatter(best, fault, having)
    lost = 1.0 - f
    if may_be_a_gain and lost < by_chance(records) * scatter:
        return False
    return lost >= thresholds.LOST_OVER_SCATTER * max(scatter, thresholds.GAIN_HOLDS)


def seems_no_scatter(best: Hypothesis, fault: Effect, f: float, having: Sequence[int]) -> bool:
    """The same before any fit has the fault, or what else is missing: of most cuts it is none."""
    scatter, _ = _scatter(best, fault, having)
    least = thresholds.LOST_OVER_SCATTER * thresholds.GAIN_HOLDS
    return 1.0 - f >= max(least, thresholds.SEEMS_LOST * scatter)


def is_no_law_of_duty(best: Hypothesis, fault: Effect, f: float, having: Sequence[int]) -> bool:
    """Whether some records lack a force that no law of the duty would take from them.

    No yield force falls as the duty rises, and beyond that nobody knows its law: what is missing at
    a duty that no other record has is one of these laws, or a fault, and nothing tells which. So
    most of what fails must be below the yield force of other records at no more than that duty.
    f : what the fault leaves [1];  having : the records that would have it
    """
    s, weight = best.problem.block.signals, best.problem.block.weight
    failing = weight * _failing(best, fault, {**best.values, **fault.off}) ** 2
    rows = np.isin(np.repeat(np.arange(len(s.starts) - 1), np.diff(s.starts)), having)
    total = told = 0.0
    levels = best.model.fields(s, best.values)
    for level, way in zip(levels, (s.xdot > 0.0, s.xdot <= 0.0), strict=True):
        own, others = rows & way, ~rows & way
        order = np.argsort(s.duty[others], kind="stable")
        next_to = np.searchsorted(
            s.duty[others][order], thresholds.SAME_DUTY * s.duty[own], "right"
        )
        below = np.concatenate([[-np.inf], level[others][order]])[next_to]
        # A law that does not fall may take half of what is missing, then.
        total += float(failing[own].sum())
        told += float(failing[own][below >= 0.5 * (1.0 + f) * level[own]].sum())
    return told >= thresholds.TOLD_BESIDE * total


def telling(best: Hypothesis, fault: Effect) -> tuple[int, ...]:
    """Records that would show a force without the fault, which takes a part of it, or all.

    best : with the fault
    """
    block = best.problem.block
    force = _failing(best, fault, {**best.values, **fault.off})
    power = np.add.reduceat(block.weight * force**2, block.signals.starts[:-1])
    return tuple(np.flatnonzero(_tells(power)).tolist())


def _scatter(best: Hypothesis, fault: Effect, having: Sequence[int]) -> tuple[float, int]:
    """Standard deviation of the gains of records about the two means, and how many tell of one."""
    G, p = _products(best, fault)
    told = _told(G, p)
    power, gains = np.where(told, np.diag(G)[p:-1], 0.0), _gains(G)[p:]
    faulty = np.isin(np.arange(len(told)), having)
    square = 0.0
    for own in (power * faulty, power * ~faulty):
        if own.any():
            square += float(np.dot(own, (gains - np.average(gains, weights=own)) ** 2))
    records = int(np.count_nonzero(told))
    return float(np.sqrt(square / float(power.sum()) * records / max(records - 2, 1))), records


@lru_cache
def by_chance(count: int) -> float:
    """How far apart the best cut of so many normal values has its two means, over what is left.

    What `thresholds.CHANCE_OF_A_CUT` of such draws exceed; of two values nothing is left.
    Check: of three one can be next to another by chance, of eight hardly any two groups are.
    >>> by_chance(3) > 50.0, 5.0 < by_chance(8) < 10.0
    (True, True)
    """
    if count < 3:
        return np.inf
    draws = np.sort(np.random.default_rng(0).normal(size=(thresholds.CUTS_DRAWN, count)), axis=1)
    sums, squares = np.cumsum(draws, axis=1), np.sum(draws**2, axis=1)
    lower = np.arange(1, count)
    means = sums[:, :-1] / lower, (sums[:, -1:] - sums[:, :-1]) / (count - lower)
    left = squares[:, None] - means[0] ** 2 * lower - means[1] ** 2 * (count - lower)
    best = np.argmin(left, axis=1)[:, None]
    apart_by = np.take_along_axis(means[1] - means[0], best, axis=1)
    scatter = np.sqrt(np.take_along_axis(left, best, axis=1).clip(1e-300) / (count - 2))
    return float(np.quantile(apart_by / scatter, 1.0 - thresholds.CHANCE_OF_A_CUT))


def _products(best: Hypothesis, fault: Effect) -> tuple[Array, int]:
    """Of J (p, n), the forces of records, and the residual, all with all."""
    s, weight = best.problem.block.signals, best.problem.block.weight
    failing = _failing(best, fault, best.values)
    records = np.repeat(np.eye(len(s.starts) - 1), np.diff(s.starts), axis=1)
    J = slopes(best)
    rows = np.vstack([J, records * failing, best.residual])
    return (rows * weight) @ rows.T, len(J)


def _failing(best: Hypothesis, fault: Effect, values: Values) -> Array:
    """(n,) forces that a fault takes a part of [N]."""
    parts = best.model.prepare(best.problem.block.signals, values).parts(values)
    return np.asarray(np.sum([parts[group] for group in fault.sets_in], axis=0))


def _told(G: Array, p: int) -> npt.NDArray[np.bool_]:
    """Which records say something of a gain."""
    return _tells(np.diag(G)[p:-1])


def _tells(power: Array) -> npt.NDArray[np.bool_]:
    return np.asarray(power > thresholds.TELLS_A_GAIN * power.max())


def _summed(G: Array, p: int, records: Index) -> Array:
    """The products of J, the forces of some records together, and the residual."""
    keep = np.zeros((p + 2, len(G)))
    keep[:p, :p] = np.eye(p)
    keep[p, p + records] = 1.0
    keep[-1, -1] = 1.0
    return np.asarray(keep @ G @ keep.T)


def _gains(G: Array) -> Array:
    """Sizes of all rows but the last in that one, the least where several do."""
    scale = np.sqrt(np.maximum(np.diag(G)[:-1], 0.0))
    scale[scale == 0.0] = 1.0
    N, right = G[:-1, :-1] / np.outer(scale, scale), G[:-1, -1] / scale
    return np.asarray(np.linalg.lstsq(N, right, rcond=thresholds.CV_SINGULAR)[0] / scale)


def _left(G: Array) -> float:
    """Square that the others leave of the last row."""
    return float(G[-1, -1] - _gains(G) @ G[:-1, -1])
