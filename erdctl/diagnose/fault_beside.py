"""A fault that sets in once, fitted beside the effects that a search has named without it.

The likelihood of its onset has spoken for it, against all that noise of any kind was seen to do.
Here it must take what is missing from its onset on: what is left there beyond what is left of all
other samples, of which it says nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.sets_in_once import sets_in_once
from erdctl.estimate.onset_profile import Onset, Profile
from erdctl.estimate.onsets import profile, profile_within
from erdctl.model.effect import Effect
from erdctl.model.onset import AMOUNT, RAMP, START, onset_weight


@dataclass(frozen=True, eq=False)
class FaultBeside:
    """A fault fitted beside other effects.

    at : the profile of its onset;  onset : in the time of the recording [s]
    ratio : likelihood ratio against none
    taken : of the mean square over all samples [N^2]
    share : of the mean square that is missing while it acts, which it takes [1]
    alike : other kinds that are behind by no more than some kind of noise can make it
    """

    effect: Effect
    hypothesis: Hypothesis
    at: Profile
    onset: Onset
    ratio: float
    taken: float
    share: float
    alike: tuple[str, ...] = ()

    @property
    def explained(self) -> bool:
        """Whether no misfit shows with it."""
        return not lack_of_fit_of(self.hypothesis).significant


# Each step of a search asks, and the search at its end.
@lru_cache(maxsize=2)
def a_fault_explains(best: Hypothesis, candidates: tuple[Effect, ...], seed: int) -> bool:
    """Whether a fault that sets in once, beside the effects of a hypothesis, leaves no misfit."""
    once = sets_in_once(best, candidates, lack_of_fit_of(best, seed).misfit_rms)
    if once is None:
        return False
    found = fault_beside(best.problem, best, once.kinds, once.in_order(best.problem.recording))
    return found is not None and found.explained


def fault_beside(
    problem: Problem, named: Hypothesis, kinds: Iterable[Effect], recording: Recording
) -> FaultBeside | None:
    """The most likely of some kinds of fault beside the effects of a hypothesis, if one is likely.

    recording : of the problem, in a time in which the fault sets in once
    """
    again = prepare(recording, problem.free)
    again = replace(again, held=problem.held, needs=problem.needs)
    without = fit_hypothesis(again, named.effects, [named.values])
    fits = [_fitted(again, without, effect) for effect in kinds]
    best = max(fits, key=lambda f: f.taken)
    if best.ratio < thresholds.ONCE_RATIO:
        return None
    # By the noise of the best one: another's, misfit and all, makes it the less likely itself.
    least = best.taken * thresholds.ONCE_RATIO / best.ratio
    alike = [f for f in fits if f is not best and best.taken - f.taken < least]
    return replace(best, alike=tuple(f.effect.name for f in alike))


def _fitted(problem: Problem, without: Hypothesis, effect: Effect) -> FaultBeside:
    s, block = problem.block.signals, without.problem.block
    lever = np.sqrt(block.weight)
    begun = profile(
        without.model, effect, s, without.residual * lever, lever, without.values, problem.held
    ).best()
    start = {effect.key(symbol): value for symbol, value in begun.values.items()}
    found = fit_hypothesis(problem, (*without.effects, effect), [{**without.values, **start}])
    at = profile_within(
        found.model, effect, found.problem.block, found.values, found.problem.held
    )  # fmt: skip
    onset = at.least(*(found.values[effect.key(symbol)] for symbol in (START, RAMP, AMOUNT)))
    ratio = at.ratio(Onset(1.0, onset.t_0, onset.t_r, at.square), onset)
    acts = onset_weight(s.t, onset.t_0, onset.t_r, s.typical_step) > 0.0
    weight = np.minimum(block.weight, found.problem.block.weight)
    here, elsewhere = weight * acts, weight * ~acts
    taken = np.average(without.residual**2 - found.residual**2, weights=weight)
    share = 0.0
    if here.any() and elsewhere.any():
        before, after = (np.average(h.residual**2, weights=here) for h in (without, found))
        missing = before - np.average(found.residual**2, weights=elsewhere)
        share = float((before - after) / missing) if missing > 0.0 else 0.0
    return FaultBeside(effect, found, at, onset, ratio, float(taken), min(share, 1.0))
