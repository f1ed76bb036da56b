"""Whether the force of records rises or falls in their order: what warms up, wears or drifts.

Each record begins anew for every model, so that no law of the time in a record is this. Tests go
through duties and motions in some order, and a law of these that is missing makes levels that go
with it; so the order must say more than a straight line over duty, speed and stroke does.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.record_effects import RecordEffects, Varying, estimate


class OfRecords(NamedTuple):
    """What a gain and a zero of each record are of what a model leaves.

    square : mean square of that force, beyond the errors of these [N^2]
    course : gains of the first and of the last record on the straight line over their order, where
        there is one beyond chance
    """

    square: float
    course: tuple[float, float] | None


def of_records(best: Hypothesis) -> OfRecords:
    """What tells the records of a log apart beside a model."""
    block, count = best.problem.block, len(best.problem.recording.names)
    begun = best.record_effects or RecordEffects.none(count)
    modelled = best.model.force(block.signals, best.values)
    both = Varying(gain=True, offset=True)
    found = estimate(both, begun.shared(block), modelled, RecordEffects.none(count))
    gain, offset = found.along(block.signals.starts)
    square = float(np.average(((gain - 1.0) * modelled + offset) ** 2, weights=block.weight))
    return OfRecords(square, course(found.gain, _set_by_test(best.problem.recording)))


def course(gains: Array, test: Array) -> tuple[float, float] | None:
    """Gains at either end of the straight line over the order, if it is one beyond chance.

    gains : (r,);  test : (r, k) what the test set for each, beside whose straight lines the order
        has to say more
    Check: a gain of 1 that is 1.09 by the tenth record is a course where the duty goes up and down;
    beside a duty that rises with the order it is none.
    >>> order, scatter = np.arange(10.0), 1e-3 * np.array([1, -1, 0, 1, -1, 1, 0, -1, 1, -1])
    >>> [round(g, 2) for g in course(1.0 + 0.01 * order + scatter, (order % 3)[:, None])]
    [1.0, 1.09]
    >>> course(1.0 + 0.01 * order + scatter, order[:, None]) is None
    True
    """
    from scipy.special import stdtr

    count = len(gains)
    order = np.arange(count) - 0.5 * (count - 1)
    other = np.column_stack([np.ones(count), test])
    other[:, 1:] -= other[:, 1:].mean(axis=0)
    left, sizes, _ = np.linalg.svd(other, full_matrices=False)
    basis = left[:, : int(np.count_nonzero(sizes > thresholds.BASIS * sizes[0]))]
    free = count - basis.shape[1] - 1
    own = order - basis @ (basis.T @ order)
    if free < thresholds.COURSE_FREE or own @ own < thresholds.COURSE_OWN * (order @ order):
        return None
    slope = float(own @ gains) / float(own @ own)
    rest = gains - slope * order
    rest = rest - basis @ (basis.T @ rest)
    error = float(np.sqrt(rest @ rest / free / (own @ own)))
    chance = 2.0 * float(stdtr(free, -abs(slope) / max(error, 1e-300)))
    if chance > thresholds.COURSE_CHANCE or abs(slope) * (count - 1) < thresholds.COURSE_LEAST:
        return None
    middle = float(np.mean(gains))
    return middle + slope * float(order[0]), middle + slope * float(order[-1])


def _set_by_test(recording: Recording) -> Array:
    """(r, 3) mean duty, and logarithms of speed and stroke of each record."""
    return np.array([
        [
            float(np.mean(recording.duty[part])),
            *(np.log(max(float(np.std(v[part])), 1e-12)) for v in (recording.xdot, recording.x)),
        ]
        for part in recording.slices
    ])  # fmt: skip
