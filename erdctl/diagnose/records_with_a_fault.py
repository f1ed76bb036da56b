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

from erdctl.bench.strokes import steady, strokes
from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, slopes
from erdctl.diagnose.kinds_of_excitation import motion_of_records
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


def is_no_law(best: Hypothesis, fault: Effect, f: float, having: Sequence[int]) -> bool:
    """Whether no law of what drives a damper would take a force from some records alone.

    f : what the fault leaves [1];  having : the records that would have it
    """
    s = best.problem.block.signals
    rows = np.isin(np.repeat(np.arange(len(s.starts) - 1), np.diff(s.starts)), having)
    return _is_no_law_of_duty(best, fault, f, rows) and _is_no_law_of_motion(best, fault, having)


def _is_no_law_of_duty(
    best: Hypothesis, fault: Effect, f: float, rows: npt.NDArray[np.bool_]
) -> bool:
    """Whether forces are below those at the same duty or a lower one, in samples (n,) of records.

    Neither force of the fluid falls as the duty rises, and beyond that nobody knows its law: what
    is missing at a duty that no other record has is one of these laws, or a fault, and nothing
    tells which. A law that does not fall may take half of it, then.
    """
    s, weight = best.problem.block.signals, best.problem.block.weight
    values = {**best.values, **fault.off}
    parts, fields = best.model.prepare(s, values).parts(values), best.model.fields(s, values)
    up = s.compressing
    level = {"yield": np.where(up, *fields), "viscous": np.ones(len(rows))}
    whole = told = np.zeros(len(rows))
    for group in fault.sets_in:
        power = weight * parts[group] ** 2
        whole = whole + power
        if group in level:
            falls = sum(_falls(level[group], s.duty, rows, way, f) for way in (up, ~up))
            told = told + power * falls
        else:
            told = told + power
    return any(
        told[side].sum() >= thresholds.TOLD_BESIDE * whole[side].sum() for side in (rows, ~rows)
    )


def _falls(
    level: Array, duty: Array, rows: npt.NDArray[np.bool_], way: npt.NDArray[np.bool_], f: float
) -> npt.NDArray[np.bool_]:
    """(n,) whether some samples, with a part of their level, are below others at no more duty.

    rows : (n,) of those that have a part f of it;  way : (n,) of those that are compared
    True for both: for one below the next others, and for one of these above the next below.
    """
    own, others = np.flatnonzero(rows & way), np.flatnonzero(~rows & way)
    own, others = (k[np.argsort(duty[k], kind="stable")] for k in (own, others))
    most, same = 0.5 * (1.0 + f) * level[own], thresholds.SAME_DUTY * duty[own]
    before = np.concatenate([[-np.inf], level[others]])
    behind = np.concatenate([most, [np.inf]])
    out = np.zeros(len(rows), dtype=bool)
    out[own] = before[np.searchsorted(duty[others], same, "right")] >= most
    out[others] = level[others] >= behind[np.searchsorted(same, duty[others])]
    return out


def _is_no_law_of_motion(best: Hypothesis, fault: Effect, having: Sequence[int]) -> bool:
    """Whether some records lack a force that others have whose motion is of the same kind.

    What all steady records of one stroke and frequency lack, and no others, is a fault that came
    and went with them, or a law that rests on these. A motion that wanders goes where others go.
    """
    power, recording = _power(best, fault), best.problem.recording
    kinds = np.where(_steady(recording), motion_of_records(recording), 0)
    rows = np.isin(np.arange(len(power)), having)
    own, others = (np.bincount(kinds, power * side, kinds.max() + 1) for side in (rows, ~rows))
    alike = np.minimum(own, others)[1:].sum()
    wanders = min(own[0], others.sum()) + min(others[0], own.sum())
    least = thresholds.TOLD_BESIDE * min(own.sum(), others.sum())
    return bool(alike + wanders >= least)


def _steady(recording: Recording) -> npt.NDArray[np.bool_]:
    """(r,) whether most of a record's strokes are halves of cycles that close."""
    found = strokes(recording)
    count = len(recording.names)
    whole = np.bincount(found.record, minlength=count)
    closed = np.bincount(found.record, steady(recording, found), minlength=count)
    return np.asarray(closed >= thresholds.STEADY * np.maximum(whole, 1))


def telling(best: Hypothesis, fault: Effect) -> tuple[int, ...]:
    """Records that would show a force without the fault, which takes a part of it, or all.

    best : with the fault
    """
    return tuple(np.flatnonzero(_tells(_power(best, fault))).tolist())


def _power(best: Hypothesis, fault: Effect) -> Array:
    """(r,) squares of what a fault takes a part of, if it takes none, weighted [N^2]."""
    block = best.problem.block
    force = _failing(best, fault, {**best.values, **fault.off})
    return np.asarray(np.add.reduceat(block.weight * force**2, block.signals.starts[:-1]))


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
