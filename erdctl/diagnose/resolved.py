"""What the samples next to turns of the motion tell alone, and what the steps of a log make.

In the step in which the piston turns, a yield force or a friction passes to its other side, and the
sample before and the one behind hold a part of that which depends on when, to a fraction of the
step. A compliance, a play, a lag or a delay much shorter than the step move that moment alike, and
so does an error of the measured velocity: such a log does not tell them from each other, nor from
nothing that is in the damper.

Nor from the error of the steps themselves: where a model in finer steps, with the parameters that
it has without an effect, leaves no more than one with it in the log's own, there is no effect.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.comparison import ranked
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.estimate.finer import Finer


def resolved(x: Exploration, best: Hypothesis) -> Hypothesis:
    """Remove effects that take what they take next to turns alone, or what finer steps take."""
    finer = Finer.of(x.problem.block.signals)
    while x.added(best):
        smaller = without_each(x, best)
        idle = [
            h for h in smaller
            if next_to_turns(x.problem, h, best) or taken_by_steps(finer, h, best)
        ]  # fmt: skip
        if not idle:
            break
        best = ranked(idle)[0]
    return best


def next_to_turns(
    problem: Problem,
    worse: Hypothesis,
    better: Hypothesis,
    least: float = thresholds.LEAST_ELSEWHERE,
) -> bool:
    """Whether less than a least part of what the better of two takes lies away from turns."""
    between = away_from_turns(problem.block.signals)
    weight = np.minimum(worse.problem.block.weight, better.problem.block.weight)
    saved = weight * (worse.cross_validated**2 - better.cross_validated**2)
    return not float(between @ saved) > least * float(saved.sum())


def taken_by_steps(finer: Finer, worse: Hypothesis, better: Hypothesis) -> bool:
    """Whether the worse of two, simulated in finer steps, leaves no more than the better one."""
    own = worse.model.force(finer.log, worse.values)
    residual = worse.residual + own - finer.force(worse.model, worse.values)
    weight = np.minimum(worse.problem.block.weight, better.problem.block.weight)
    return float(weight @ residual**2) <= float(weight @ better.residual**2)


def away_from_turns(signals: Signals) -> Array:
    """(n,) 0 for the two samples between which the direction changes, or motion begins, else 1.

    Check: velocities 1, 1, -1, -1 have the turn between the second and the third.
    >>> v = np.array([1.0, 1.0, -1.0, -1.0])
    >>> ends = np.array([0, 4])
    >>> away_from_turns(Signals(v, v, v, v, np.ones(4), ends)).tolist()
    [1.0, 0.0, 0.0, 1.0]
    """
    turn = np.diff(np.sign(signals.xdot)) != 0.0
    turn[signals.starts[1:-1] - 1] = False
    out = np.ones(len(signals))
    out[:-1][turn], out[1:][turn] = 0.0, 0.0
    return out
