"""What parameters that were given miss, as a fault of that damper would have it.

    F = F_given(f),   f : what is left of the forces that a fault takes a part of, all along

Parameters of a healthy damper and a log of the same one damaged: fitted anew they hold both, and
the search has nothing to name. What a fault with one number takes of what the new fit takes, says
which it would be, and how much is left.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.energy import energy_test
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.model.checked import GROUPS
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.onset import AMOUNT, RAMP, START
from erdctl.model.parameters import Parameters


@dataclass(frozen=True)
class FaultOfGiven:
    """A fault of a damper that is as the given parameters have it.

    f : what is left [1], and its standard error over parts of the log
    share : of the mean square by which given parameters are worse than fitted ones [1]
    alike : other faults from which these data do not tell it;  rms : of what it leaves [N]
    may_be_a_gain : whether it, or one of these, takes a part of all forces alike, as a rig may
    """

    effect: Effect
    f: float
    stderr: float
    share: float
    rms: float
    alike: tuple[str, ...] = ()
    may_be_a_gain: bool = False


def fault_of_given(
    problem: Problem, given: Parameters, kinds: Iterable[Effect], fitted: Hypothesis
) -> FaultOfGiven | None:
    """The fault that takes most of what is missing, if it takes it all but a little.

    kinds : none of them among the given effects
    fitted : the same model fitted to the problem, and with what the search has named
    """
    block, weight = problem.block, problem.block.weight
    missed = block.force - given.model.force(block.signals, given.values)
    before, least = (float(np.dot(weight, r**2)) for r in (missed, fitted.residual))
    tried = [_fitted(problem, given, effect) for effect in kinds if effect.sets_in]
    if not tried or not before > least:
        return None
    square = [float(np.dot(weight, left**2)) for _, left in tried]
    k = int(np.argmin(square))
    (best, left), share = tried[k], min((before - square[k]) / (before - least), 1.0)
    lost = 1.0 - best.f
    if (
        share < thresholds.GIVEN_SHARE
        or lost < thresholds.LOST_OVER_SCATTER * thresholds.GAIN_HOLDS
        or lost < thresholds.Z_ENERGY * best.stderr
    ):
        return None
    alike = [
        other.effect for other, rest in tried
        if other is not best and not energy_test(problem, rest, left).significant
    ]  # fmt: skip
    gain = any(set(GROUPS) <= {*e.sets_in} for e in (best.effect, *alike))
    names = tuple(e.name for e in alike)
    return replace(best, share=share, alike=names, may_be_a_gain=gain)


def _fitted(problem: Problem, given: Parameters, effect: Effect) -> tuple[FaultOfGiven, Array]:
    """The f of a fault from before the log on that leaves least, and what that is (n,) [N]."""
    from scipy.optimize import minimize_scalar

    s, force, weight = problem.block.signals, problem.block.force, problem.block.weight
    model = Model((*given.model.effects, effect))
    before = {effect.key(START): float(s.t.min()) - 1.0, effect.key(RAMP): 0.0}

    def left(f: float) -> Array:
        return force - model.force(s, {**given.values, **before, effect.key(AMOUNT): f})

    def square(f: float) -> float:
        return float(np.dot(weight, left(f) ** 2))

    f = float(minimize_scalar(square, bounds=(0.0, 1.0), method="bounded").x)
    rest, step = left(f), thresholds.GAIN_HOLDS
    slope = (left(f) - left(f + step)) / step
    sums = problem.per_group(slope * rest)
    error = float(np.sqrt(np.sum(sums**2))) / max(float(np.dot(weight, slope**2)), 1e-300)
    rms = float(np.sqrt(np.mean(rest**2)))
    return FaultOfGiven(effect, f, error, 0.0, rms), rest
