"""The whole diagnosis: locate, screen, refit, choose, explain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import untestable
from erdctl.core.blocks import thinned
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Recording
from erdctl.diagnose.comparison import FINEST, Comparison, compare
from erdctl.diagnose.discriminating_drive import Test, telling_apart
from erdctl.diagnose.executor import Progress, crew
from erdctl.diagnose.hypothesis import Trial
from erdctl.diagnose.problem import SHORTEST, Study, keeping, prepare
from erdctl.diagnose.record_effects import NOTHING, Free, Scatter, errors
from erdctl.diagnose.residual.localisation import Region, locate
from erdctl.diagnose.residual.predictability import Remainder, examine
from erdctl.diagnose.search import Choice, choose, confirm
from erdctl.estimate.covariance import Fit, assess
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters
from erdctl.score.nrmse import Normalise, Validation, validate

SEARCH = 12_000  # samples for the search among hypotheses; what it finds is fitted to all
PARTS = 5  # of a log that must be there to be left out in turn
REST = 0.05  # of what the paper's model misses, in mean square, that counts where noise is louder
LEFT = 0.3  # misfit over noise up to which what remains counts as noise


class Verdict(StrEnum):
    """The answer in one word."""

    ADEQUATE = "adequate"
    EXPLAINED = "explained"
    UNEXPLAINED = "unexplained"


@dataclass(frozen=True, eq=False)
class Finding:
    """One effect that the paper's model left out.

    gain : against the best model without it, on what neither has seen;  where : it acts
    before, after : NRMSE on groups left out of the fit, without and with it
    test : the drive that would tell it from its equivalents, if it has any
    """

    effect: Effect
    equivalent: tuple[str, ...]
    gain: Comparison
    where: Region | None
    before: float
    after: float
    runner_up: str | None
    test: Test | None


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What was found; see the contract for the meaning of the verdicts.

    baseline : scores of the given parameters as they are, or else of the paper's model refitted
    refitted : scores of that model fitted to this recording
    corrected, carried : scores of the best model without and with the scatter of the records, which
        are the same where none is carried
    unseen : scores of the model to answer for and of the best, each sample by a fit without its
        group, beyond the scatter of the records
    """

    verdict: Verdict
    noise_rms: float
    study: Study
    choice: Choice
    fit: Fit
    findings: tuple[Finding, ...]
    mismatch: tuple[Region, ...]
    given: Parameters | None
    baseline: Validation
    refitted: Validation
    corrected: Validation
    carried: Validation
    unseen: tuple[Validation, Validation]
    scatter: Scatter | None
    remainder: Remainder
    untestable: dict[str, str]


def diagnose(
    recording: Recording,
    candidates: Sequence[Effect],
    *,
    most: int = 5,
    seed: int = 0,
    given: Parameters | None = None,
    free: Free = NOTHING,
    jobs: int = 1,
    progress: Progress = lambda stage, what: None,
) -> Diagnosis:
    """Diagnose a recording with a measured force against a catalogue of effects.

    given : parameters of the model to answer for, in place of the paper's; what they already
        contain is not found again
    free : what of the force may scatter from record to record, which is carried and not named
    jobs : processes that try hypotheses; the results are the same for any number
    """
    study = prepare(recording, free)
    _enough(study)
    search = prepare(thinned(recording, SEARCH), free)
    survey = Survey(recording, study.block.signals)
    if given is not None:
        lacking = untestable(survey, given.model.effects)
        study, search = (keeping(s, given, lacking) for s in (study, search))
        candidates = [e for e in candidates if e not in given.model.effects]
    missing = untestable(survey, candidates)
    testable = [e for e in candidates if e.name not in missing]
    with crew((search, study), jobs, progress) as workers:
        choice = choose(search, testable, most, workers, seed, given)
        choice = confirm(study, choice, workers)
    best = choice.best
    progress("what remains", "")
    remainder = examine(best.study, best.residual, seed)
    noise = remainder.noise_rms
    left = remainder.real and _matters(study, choice, remainder)
    if left:
        verdict = Verdict.UNEXPLAINED
    else:
        verdict = Verdict.EXPLAINED if choice.named else Verdict.ADEQUATE
    findings = _findings(study, choice)
    energy = (best.residual - choice.base.residual) ** 2
    if left:
        energy += remainder.excess
    mismatch = locate(best.study, energy) if verdict is not Verdict.ADEQUATE else []
    refitted = _validate(study, choice.base)
    fit, scatter = _errors(study, best)
    return Diagnosis(
        verdict=verdict,
        noise_rms=noise,
        study=study,
        choice=choice,
        fit=fit,
        scatter=scatter,
        findings=findings,
        mismatch=tuple(mismatch[:3]),
        given=given,
        baseline=refitted if given is None else _as_given(study, given),
        refitted=refitted,
        corrected=_validate(study, best),
        carried=_carried(study, best),
        unseen=(_unseen(best.study, choice.base), _unseen(best.study, best)),
        remainder=remainder,
        untestable=missing,
    )


def _matters(study: Study, choice: Choice, remainder: Remainder) -> bool:
    """Whether a rest is more than noise, rounding, and the last per cent of what was explained."""
    misfit, noise = remainder.misfit_rms, remainder.noise_rms
    missed = max(choice.base.score - noise**2, 0.0)
    least = max(LEFT * noise, FINEST * float(np.ptp(study.block.force)))
    return misfit > least and (misfit > noise or misfit**2 > REST * missed)


def _enough(study: Study) -> None:
    """Refuse a recording that can show nothing."""
    weight, moving = study.block.weight, study.block.signals.xdot != 0.0
    if np.ptp(study.block.force) == 0.0:
        raise InputProblem("the force never changes: there is nothing to diagnose")
    if not (moving & (weight > 0)).any():
        raise InputProblem("the damper never moves: there is nothing to diagnose")
    count = int(np.count_nonzero(study.weight_of))
    if count < PARTS:
        raise InputProblem(
            f"too short to diagnose: {PARTS} parts of {SHORTEST:g} s or more are left out in turn,"
            f" and this log has {count}; record at least {2 * PARTS * SHORTEST:g} s"
        )


def _findings(study: Study, choice: Choice) -> tuple[Finding, ...]:
    best = choice.best
    scale = float(np.ptp(study.block.force))
    found = []
    with_all = best.model.force(study.block.signals, best.values)
    ranking = sorted(choice.singles, key=lambda t: t.score)
    chosen = {e.name for e in best.effects}
    runner = next((t.effects[-1].name for t in ranking if t.effects[-1].name not in chosen), None)
    for effect in choice.named:
        without = choice.without[effect.name]
        # Where it acts; what acts everywhere is seen where the other parameters fail to absorb it.
        alone = best.model.force(study.block.signals, {**best.values, **effect.off})
        absent = without.model.force(study.block.signals, without.values)
        regions = [r for f in (alone, absent) for r in locate(best.study, (with_all - f) ** 2)[:1]]
        gain = compare(study, without, best)
        found.append(
            Finding(
                effect=effect,
                equivalent=tuple(name for name, _ in choice.rivals[effect.name]),
                test=telling_apart(study, best, choice.rivals[effect.name]),
                gain=gain,
                where=regions[0] if regions else None,
                before=float(np.sqrt(gain.before)) / scale,
                after=float(np.sqrt(gain.after)) / scale,
                runner_up=runner,
            )
        )
    return tuple(sorted(found, key=lambda f: -f.gain.gain))


def _errors(study: Study, trial: Trial) -> tuple[Fit, Scatter | None]:
    model = trial.model
    at_bound = [n for n, q in model.quantities.items() if not q.low < trial.values[n] < q.high]
    block, scatter = trial.study.block, trial.scatter
    shared = block if scatter is None else scatter.shared(block)
    fit = assess(model, [shared], trial.values, fixed={*study.held, *at_bound}, threads=1)
    if scatter is None:
        return fit, None
    covariance, scatter = errors(study.free, block, model, fit.values, fit.free, scatter)
    return replace(fit, covariance=covariance), scatter


def _as_given(study: Study, given: Parameters) -> Validation:
    force = given.model.force(study.block.signals, given.values)
    return validate(study.recording, force, Normalise.RANGE)


def _validate(study: Study, trial: Trial) -> Validation:
    if trial.scatter is None:
        return _carried(study, trial)
    force = trial.model.force(study.block.signals, trial.values)
    return validate(study.recording, force, Normalise.RANGE)


def _carried(study: Study, trial: Trial) -> Validation:
    modelled: Array = study.block.force - trial.residual
    return validate(study.recording, modelled, Normalise.RANGE)


def _unseen(study: Study, trial: Trial) -> Validation:
    """Scores on what the fit left out, of the samples that a study gives weight."""
    r, rows = study.recording, np.flatnonzero(study.block.weight)
    ends = np.searchsorted(rows, r.starts)
    names = [name for name, size in zip(r.names, np.diff(ends), strict=True) if size]
    kept = r.take(rows, np.unique(ends), names)
    return validate(kept, (study.block.force - trial.unseen)[rows], Normalise.RANGE)
