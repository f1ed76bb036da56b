"""Whether a correction says more than which record is which.

Records differ in gain and zero by more than noise on every rig. A free parameter takes that as
readily as physics, and a coordinate that hardly moves within records (the largest stroke so far, a
duty that is held) tells them apart as well as their numbers do. What a correction does to the
levels of records is one observation for each of them, however many samples they have. So it has a
name, or is a law, by what it predicts within records, beyond a gain and a zero of each; or by what
it takes of the levels, if it takes more than as many parameters would by chance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.comparison import compare_alike, ranked
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.record_levels import with_levels
from erdctl.estimate.linearisation import jacobian


def beyond_levels(
    problem: Problem, worse: Hypothesis, better: Hypothesis, critical: float = 0.0
) -> bool:
    """Whether a model is better by more than levels of records, which chance gives.

    critical : see `energy.critical_value`
    """
    own = [with_levels(h, worse) for h in (worse, better)]
    # A level of a record with few samples of weight may miss the others; no model has it.
    if replace(compare_alike(problem, *own), settling=0.0).beyond(critical):
        return True
    weight = np.minimum(worse.problem.block.weight, better.problem.block.weight)
    before, after, least = (float(np.dot(weight, h.residual**2)) for h in (worse, better, own[1]))
    records = len(problem.recording.names)
    extra = _more_parameters(worse, better)
    return _chance(before, after, least, extra, records) < thresholds.CHANCE_OF_LEVELS


def not_of_records(x: Exploration, best: Hypothesis) -> Hypothesis:
    """Remove effects that only say which record is which, the one that takes the least first."""
    if len(x.problem.recording.names) < thresholds.LEVELS_FROM:
        return best
    while x.added(best):
        smaller = without_each(x, best)
        labels = [h for h in smaller if not beyond_levels(x.problem, h, best)]
        if not labels:
            break
        best = ranked(labels)[0]
    return best


def _more_parameters(worse: Hypothesis, better: Hypothesis) -> int:
    """How many more parameters one has that the force depends on, at least one.

    A lag under a control that every record holds takes nothing of any level.
    """
    quantities = better.model.quantities
    new = [n for n in quantities if n not in worse.model.quantities]
    block = better.problem.block
    J = jacobian(better.model, block.signals, better.values, new)
    sizes = [max(abs(better.values[n]), abs(quantities[n].start)) for n in new]
    moved = np.sqrt(J**2 @ block.weight) * sizes
    least = thresholds.MOVES * np.sqrt(float(np.dot(block.weight, block.force**2)))
    return max(int(np.count_nonzero(moved > least)), 1)


def _chance(before: float, after: float, least: float, extra: int, records: int) -> float:
    """Probability with which so many parameters take as much of what levels of records take, by F.

    before, after, least : sums of squares without and with the parameters, and with levels as well
    Of the gain and the zero of a record one is counted: often the other differs by noise alone.
    Check: of six records and three parameters F(3, 2) = 19.16 has 5 %.
    >>> round(_chance(4.0 + 3 / 2 * 19.16, 4.0, 3.0, 3, 6), 3)
    0.05
    """
    from scipy.stats import f

    left = records - 1 - extra
    if left < 1 or not before > after:
        return 1.0
    return float(f.sf((before - after) / extra / max((after - least) / left, 1e-300), extra, left))
