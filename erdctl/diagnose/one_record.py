"""What is one record's own, a gain or a zero of its force, is not given the name of an effect.

A load cell that drifted before one run, or a record taken on another day, changes the force of that
record as a whole; an effect that happens to act there can take the place of it. So beside every
effect stands this rival: the model without it, and for one record

    F -> (1 + g) F + F_0

with g and F_0 free. An effect that predicts less than the best of these rivals is dropped, and the
misfit stays where it is: in that record.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis, left_out, slopes


def beyond_one_record(x: Exploration, best: Hypothesis) -> Hypothesis:
    """A hypothesis without the effects in whose place one record's gain and zero predict more."""
    if len(x.problem.recording.names) < thresholds.LEAST_RECORDS or x.problem.free:
        return best
    while x.added(best):
        smaller = without_each(x, best)
        errors = [_least(h, best) for h in smaller]
        least = int(np.argmin(errors))
        if errors[least] >= 1.0:
            break
        best = smaller[least]
    return best


def _least(hypothesis: Hypothesis, rival: Hypothesis) -> float:
    """Cross-validated mean square with the best record's own gain and zero, over the rival's."""
    weight = np.minimum(hypothesis.problem.block.weight, rival.problem.block.weight)
    starts = hypothesis.problem.block.signals.starts
    bar = float(np.dot(weight, rival.cross_validated**2))
    found = [
        float(np.dot(weight, _with_own(hypothesis, slice(a, b)) ** 2))
        for a, b in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True)
    ]
    return min(found) / bar if bar > 0.0 else np.inf


def _with_own(hypothesis: Hypothesis, record: slice) -> Array:
    """(n,) cross-validated residual with a gain and a zero of one record's own [N]."""
    problem, J, residual = hypothesis.problem, slopes(hypothesis), hypothesis.residual
    own = np.zeros((2, len(residual)))
    own[0, record] = (problem.block.force - residual)[record]
    own[1, record] = 1.0
    root = np.sqrt(problem.block.weight)
    columns = np.vstack([J, own])
    scale = np.sqrt(np.einsum("ij,ij,j->i", columns, columns, problem.block.weight))
    columns = columns[scale > 0.0] / scale[scale > 0.0, None]
    taken = np.linalg.lstsq((columns * root).T, residual * root, rcond=thresholds.BASIS)[0]
    return left_out(problem, columns, residual - taken @ columns)
