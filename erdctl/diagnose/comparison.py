"""One hypothesis against another, on what the fit of neither has seen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem

T_STRETCHES = 3.5  # how many times its scatter a gain must be, over stretches of a second
T_GROUPS = 1.5  # the same, over groups left out
LEAST = 0.004  # relative gain in unseen mean square below which nothing is worth a name
FINEST = 2e-4  # of the range of the force: less may be the rounding of a simulation


@dataclass(frozen=True)
class Comparison:
    """How much better one hypothesis is than another on what neither has seen.

    gain : relative reduction of the unseen mean square
    clear, steady : see `Problem.clearly`, on errors of fits that have left the group out
    size : root of the reduction over the range of the force
    before, after : the mean squares themselves, of the same samples [N^2]
    """

    gain: float
    t_stretches: float
    t_groups: float
    size: float
    before: float
    after: float

    @property
    def significant(self) -> bool:
        """Whether the gain is more than scatter, and worth a name."""
        worth = self.gain > LEAST and self.size > FINEST
        return worth and self.t_stretches > T_STRETCHES and self.t_groups > T_GROUPS


def compare(problem: Problem, worse: Hypothesis, better: Hypothesis) -> Comparison:
    """The gain of one hypothesis over another."""
    # Where a channel makes samples doubtful for one of them, both go without.
    weight = np.minimum(worse.problem.block.weight, better.problem.block.weight)
    common = replace(problem, block=problem.block._replace(weight=weight))
    t_stretches, t_groups = common.t_statistics(worse.cross_validated, better.cross_validated)
    before, after = (
        float(np.average(t.cross_validated**2, weights=weight)) for t in (worse, better)
    )
    gain = (before - after) / before if before > 0.0 else 0.0
    size = float(np.sqrt(max(before - after, 0.0))) / float(np.ptp(problem.block.force))
    return Comparison(gain, t_stretches, t_groups, size, before, after)
