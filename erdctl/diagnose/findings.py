"""The findings of a search, and whether they have earned their names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import Comparison, compare
from erdctl.diagnose.discriminating_drive import DiscriminatingDrive, discriminating_drive
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.localisation import Region
from erdctl.diagnose.residual.places import acting
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.resolved import away_from_turns
from erdctl.diagnose.search import Selection
from erdctl.diagnose.sets_in_once import SetsInOnce
from erdctl.model.effect import Effect


@dataclass(frozen=True, eq=False)
class Finding:
    """One effect that the paper's model left out.

    gain : against the best model without it, on what neither has seen;  acts : where it does
    before, after : NRMSE on groups left out of the fit, without and with it
    caveat : what its value says besides, as of a delay within a sample
    test : the drive that would tell it from its equivalents, if it has any
    """

    effect: Effect
    equivalent: tuple[str, ...]
    gain: Comparison
    acts: tuple[Region, ...]
    before: float
    after: float
    runner_up: str | None
    test: DiscriminatingDrive | None
    caveat: str = ""

    @property
    def where(self) -> Region | None:
        """The place at which it acts most."""
        return self.acts[0] if self.acts else None


def findings(problem: Problem, selection: Selection) -> tuple[Finding, ...]:
    """The chosen effects, the one that takes most of the misfit away from turns first."""
    best = selection.best
    scale = float(np.ptp(problem.block.force))
    found = []
    with_all = best.model.force(problem.block.signals, best.values)
    chosen = {e.name for e in best.effects}
    order = (h.effects[-1].name for h in selection.singles)
    step = Signals.of(problem.recording).typical_step
    runner = next((name for name in order if name not in chosen), None)
    for effect in selection.named:
        without = selection.without[effect.name]
        # Where it acts; what acts everywhere is seen where the other parameters fail to absorb it.
        alone = best.model.force(problem.block.signals, {**best.values, **effect.off})
        absent = without.model.force(problem.block.signals, without.values)
        squares = [(with_all - force) ** 2 for force in (alone, absent)]
        gain = compare(problem, without, best)
        found.append(
            Finding(
                effect=effect,
                equivalent=tuple(name for name, _ in selection.look_alikes[effect.name]),
                test=discriminating_drive(problem, best, selection.look_alikes[effect.name]),
                gain=gain,
                acts=tuple(acting(best.problem, effect, best.values, squares)),
                before=float(np.sqrt(gain.before)) / scale,
                after=float(np.sqrt(gain.after)) / scale,
                runner_up=runner,
                caveat=effect.caveat(effect.among(best.values), step) if effect.caveat else "",
            )
        )
    return tuple(sorted(found, key=lambda f: -_share(selection, f)))


def _share(selection: Selection, finding: Finding) -> float:
    """What an effect takes of the mean square, as the first one and as the last one [N^2].

    As the last one alone, a strong effect that some faint ones can stand in for together would
    count less than these. The mean over all orders is L. S. Shapley's value (Contributions to the
    Theory of Games 2 (1953) 307-317), of which these are the two ends.
    """
    names = {finding.effect.name, *finding.effect.equivalents}
    alone = [_left(h) for h in selection.singles if h.effects[-1].name in names]
    first = max(_left(selection.base) - min(alone), 0.0) if alone else 0.0
    without = selection.without[finding.effect.name]
    return first + _left(without) - _left(selection.best)


def _left(hypothesis: Hypothesis) -> float:
    """Mean square error on groups left out, but for the samples next to turns [N^2].

    A direction that is wrong in one of them is an error of twice the yield force: a velocity that
    is a little noisy would come before what is several times as strong everywhere else.
    """
    block = hypothesis.problem.block
    weight = block.weight * away_from_turns(block.signals)
    if not weight.any():
        return hypothesis.score
    return float(np.average(hypothesis.cross_validated**2, weights=weight))


def part_taken(selection: Selection, left: LackOfFit, fault: SetsInOnce | None = None) -> float:
    """The part of the misfit's square, beyond noise, that the chosen effects take [1].

    What stays in a record that is unlike the others acts there alone, and says nothing of what is
    chosen for the others, however large it is; nor does what a fault that sets in once leaves of
    its records, and what it does to the fit of all.
    """
    both = selection.base, selection.best
    if fault is not None and (others := fault.order[: fault.first]):
        both = _of_records(both[0], others), _of_records(both[1], others)
        left = lack_of_fit_of(both[1])
    weight = np.minimum(*(h.problem.block.weight for h in both))
    if left.loud is not None:
        weight = np.where(left.loud > 0.0, 0.0, weight)
    if not weight.any():
        return 1.0
    before, after = (float(np.average(h.cross_validated**2, weights=weight)) for h in both)
    misfit = before - left.noise_rms**2
    return (before - after) / misfit if misfit > 0.0 else 1.0


def _of_records(hypothesis: Hypothesis, records: Sequence[int]) -> Hypothesis:
    """The same, fitted to some of the records."""
    problem, start = hypothesis.problem.of(sorted(records)), hypothesis.values
    return fit_hypothesis(problem, hypothesis.effects, [start], thresholds.STEPS_AGAIN)


def matters(problem: Problem, selection: Selection, lack_of_fit: LackOfFit) -> bool:
    """Whether a rest is more than noise, rounding, and the last per cent of what was explained."""
    if not lack_of_fit.significant:
        return False
    misfit, noise = lack_of_fit.misfit_rms, lack_of_fit.noise_rms
    missed = max(selection.base.score - noise**2, 0.0)
    rounding = thresholds.ROUNDING * float(np.ptp(problem.block.force))
    least = max(thresholds.MISFIT_OVER_NOISE * noise, rounding)
    return misfit > least and (misfit > noise or misfit**2 > thresholds.MISFIT_PART * missed)


def earned(part: float) -> bool:
    """Whether effects take more of a misfit than they leave.

    Where most of it stays, what stays may be all of it: some form that bends a little like the
    missing physics is always found among many, and its name would be a wrong one.
    """
    return part >= thresholds.LEAST_TAKEN
