"""Records that a fault sets apart: those of which some forces are smaller than those of the others.

    residual = J dp + sum_r g_r A_r,   A_r : the forces that a fault takes a part of, in record r

The gains g_r are the records' order, and of all cuts of that order the one whose lower records
together, with one gain, leave least has the fault below it. With all products summed up by records
once, no cut costs more than a few small systems.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, slopes
from erdctl.model.effect import Effect


def apart(best: Hypothesis, fault: Effect) -> tuple[int, ...]:
    """Records that have a fault from their beginnings, as they would if some have: by gains."""
    G, p = _products(best, fault)
    told = _told(G, p)  # others are as they would be without
    count = len(told)
    order = np.argsort(-np.where(told, _gains(G)[p:], np.inf), kind="stable")
    cuts = range(max(int(np.count_nonzero(~told)), 1), count)
    left = [_left(_summed(G, p, order[cut:])) for cut in cuts]
    return tuple(sorted(order[cuts[int(np.argmin(left))] :].tolist())) if left else ()


def is_no_scatter(best: Hypothesis, fault: Effect, f: float, first: int) -> bool:
    """Whether what is left of some records is far below the others, held against how they scatter.

    best : with the fault, from the beginning of its record number `first` on
    f : what it leaves [1]
    """
    G, p = _products(best, fault)
    power = np.where(_told(G, p), np.diag(G)[p:-1], 0.0)
    gains, square = _gains(G)[p:], 0.0
    for of in (slice(None, first), slice(first, None)):
        if power[of].any():
            mean = np.average(gains[of], weights=power[of])
            square += float(np.dot(power[of], (gains[of] - mean) ** 2))
    records = int(np.count_nonzero(power))
    square *= records / max(records - 2, 1) / float(power.sum())
    scatter = max(float(np.sqrt(square)), thresholds.GAIN_HOLDS)
    return 1.0 - f >= thresholds.LOST_OVER_SCATTER * scatter


def _products(best: Hypothesis, fault: Effect) -> tuple[Array, int]:
    """Of J (p, n), the forces of records, and the residual, all with all."""
    s, weight = best.problem.block.signals, best.problem.block.weight
    parts = best.model.prepare(s, best.values).parts(best.values)
    failing = np.sum([parts[group] for group in fault.sets_in], axis=0)
    records = np.repeat(np.eye(len(s.starts) - 1), np.diff(s.starts), axis=1)
    J = slopes(best)
    rows = np.vstack([J, records * failing, best.residual])
    return (rows * weight) @ rows.T, len(J)


def _told(G: Array, p: int) -> npt.NDArray[np.bool_]:
    """Which records say something of a gain."""
    power = np.diag(G)[p:-1]
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
