"""The whole diagnosis: search, refit, test the lack of fit, locate, explain."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial

from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import untestable
from erdctl.bench.rig import Rig, RigFault, look
from erdctl.core.cluster import Cluster
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Recording
from erdctl.diagnose import scores, thresholds
from erdctl.diagnose.bounds import Bounds
from erdctl.diagnose.conditions import cannot_tell, cannot_tell_several, most_told
from erdctl.diagnose.detectable import Detectable, detectable
from erdctl.diagnose.executor import Executor, executor
from erdctl.diagnose.fault_of_given import FaultOfGiven, fault_of_given
from erdctl.diagnose.findings import Finding, earned, findings, matters, part_taken
from erdctl.diagnose.fit_errors import fit_errors, may_be_absent
from erdctl.diagnose.forward_step import key_of
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.learning.stage import Learned, learned
from erdctl.diagnose.on_all_samples import on_all, refit
from erdctl.diagnose.problem import Problem, check_enough, prepare, with_given
from erdctl.diagnose.record_effects import NONE_VARY, RecordEffects, Varying
from erdctl.diagnose.residual.ceiling import ceilings
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.localisation import Region
from erdctl.diagnose.residual.places import places
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.residual.resemblance import Resemblance, resemblance
from erdctl.diagnose.residual.unlogged import Unlogged, regions, unlogged, without
from erdctl.diagnose.search import Selection, named_again
from erdctl.diagnose.searched import Searched, searched
from erdctl.diagnose.sets_in_once import SetsInOnce, sets_in_once
from erdctl.diagnose.slight_lag import freed
from erdctl.diagnose.thin import thinned
from erdctl.diagnose.unseen import Unseen, kept_aside, on_unseen
from erdctl.diagnose.withdrawal import that_hold
from erdctl.estimate.covariance import Fit
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters
from erdctl.model.simulate import simulate
from erdctl.score.nrmse import Validation


class Verdict(StrEnum):
    """The answer in one word."""

    ADEQUATE = "adequate"
    EXPLAINED = "explained"
    UNEXPLAINED = "unexplained"


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What was found; see the contract for the meaning of the verdicts.

    cannot_tell : under which conditions something is left out that several effects, and other
        values of the paper's parameters, would explain alike, see `conditions`; or that the model
        holds within the limits of a channel, beyond which nothing is known; "" where the log can
        tell
    baseline : scores of the given parameters as they are, or else of the paper's model refitted
    refitted : scores of that model fitted to this recording
    corrected, carried : scores of the best model without and with the record effects, which
        are the same where none is carried
    cross_validated : scores of the model to answer for and of the best, each sample by a fit
        without its group, beyond the record effects
    unseen : errors by what was left out, that which neither fit nor search has seen first
    withdrawn : effects that the search chose, and that predict what it has not seen the worse, or
        that leave more of the misfit than the part `taken` that they take
    undetected : what was not named, and the size from which these data would have shown it
    rig : what is wrong with the recording; if all of it is, nothing was searched
    tried : how many effects were;  searched : what the search found, before it met all samples
    learned : what the data say of a rest that no effect explains; `fit`, `corrected` and all that
        is said of the best model are then of the one with these laws
    once : a fault that sets in once, from which no law is learned
    as_fault : of the damper that has the given parameters, if one does nearly what a new fit does
    apart : strokes that motion and duty do not tell from the others, of which all else is
    """

    verdict: Verdict
    cannot_tell: str
    noise_rms: float
    problem: Problem
    selection: Selection
    fit: Fit
    findings: tuple[Finding, ...]
    mismatch: tuple[Region, ...]
    given: Parameters | None
    baseline: Validation
    refitted: Validation
    corrected: Validation
    carried: Validation
    cross_validated: tuple[Validation, Validation]
    unseen: tuple[Unseen, ...]
    withdrawn: tuple[Effect, ...]
    taken: float | None
    record_effects: RecordEffects | None
    lack_of_fit: LackOfFit
    resemblance: Resemblance | None
    untestable: dict[str, str]
    undetected: tuple[Detectable, ...]
    rig: Rig
    learned: Learned | None
    tried: int
    searched: Searched
    once: SetsInOnce | None = None
    as_fault: FaultOfGiven | None = None
    apart: tuple[Unlogged, ...] = ()


def diagnose(
    recording: Recording,
    candidates: Sequence[Effect],
    *,
    most: int = thresholds.MOST_EFFECTS,
    seed: int = 0,
    given: Parameters | None = None,
    free: Varying = NONE_VARY,
    accepted: Sequence[str] = (),
    limits: bool = True,
    learning: bool = True,
    once: bool = True,
    jobs: int = 1,
    cluster: Cluster | None = None,
    progress: Progress = lambda stage, what: None,
    apart: tuple[Unlogged, ...] = (),
    cut: tuple[RigFault, ...] = (),
    known: Searched | None = None,
) -> Diagnosis:
    """Diagnose a recording with a measured force against a catalogue of effects.

    given : parameters to answer for, not the paper's model; what they contain is not found again
    free : record effects, which are estimated and not named
    accepted : rig checks that the user says are right as they are
    limits : say from which size what was not named would have shown; nothing else rests on that
    learning : whether to learn what no effect explains; which effects are found does not rest on
        that, but for those that stand in for a law
    once : look for a fault that sets in once in all of the log
    jobs, cluster : processes here, or a cluster, that try hypotheses; the results are the same
    apart, cut : strokes, and ends of a range, to leave out, as a first diagnosis has found them
    known : the search of one that differed by nothing before it
    """
    again = partial(
        diagnose, recording, candidates, most=most, seed=seed, given=given, free=free,
        accepted=accepted, limits=limits, learning=learning, once=once, jobs=jobs,
        cluster=cluster, progress=progress, cut=cut,
    )  # fmt: skip
    rig = look(recording).accept(accepted).beside(cut)
    recording = without(rig.usable(), apart)
    problem = prepare(recording, free)
    check_enough(problem)
    survey = Survey.of(recording)
    if given is not None:
        simulate(given, recording)  # one that diverges is refused before the search, not judged
        problem = with_given(problem, given, untestable(survey, given.model.effects))
        candidates = [e for e in candidates if e not in given.model.effects]
    else:
        problem = freed(problem)
    if rig.blocking:
        candidates = []  # what a wrong sign or unit does is no physics
    missing, most = untestable(survey, candidates), most_told(recording, most)
    testable = [e for e in candidates if e.name not in missing]
    aside = kept_aside(recording, testable)
    seen = problem.of([r for r in range(len(recording.names)) if r not in aside])
    thin = thinned(seen, thresholds.SEARCH_SAMPLES)
    untested = [e for e in candidates if e.name in missing]
    bounds = Bounds.of(candidates, problem.block)
    with ExitStack() as pools:
        there = partial(executor, jobs=jobs, progress=progress, bounds=bounds, cluster=cluster)
        known, workers = searched(
            (thin, seen, problem), testable, most, lambda p: pools.enter_context(there(p)), seed,
            given, untested, once=once and not free, known=known,
        )  # fmt: skip
        (thin, seen, problem), sought = known.problems, known.selection
        chosen: Selection | None = (settled := refit(seen, sought, workers))
        if 0 < len(settled.named) < len(sought.named):
            sought = named_again(thin, sought, settled.best, testable, workers, untested)
            chosen = refit(seen, sought, workers)
        unfitted, withdrawn = problem.of(aside) if aside else None, tuple[Effect, ...]()
        while chosen is not None:
            selection, gone, unseen = that_hold(chosen, unfitted, seen, workers)
            withdrawn += gone
            found, kept = findings(seen, selection), selection
            if aside:
                selection = on_all(problem, selection, workers)
            fit, record_effects = fit_errors(problem, selection.best, progress, jobs)
            idle = next((e for e in selection.named if _idle(e, fit, workers)), None)
            chosen = refit(seen, kept, workers, idle) if idle else None
        progress("lack of fit", part_of("regression of the residual", 1, 1))
        lack_of_fit, taken = lack_of_fit_of(selection.best, seed), None
        fault: SetsInOnce | None = None
        if once and not free:
            fault = sets_in_once(selection.best, testable, lack_of_fit.misfit_rms)
            if fault is None and known.selection.ended:
                return again(apart=apart, once=False)
        if selection.named and matters(problem, selection, lack_of_fit):
            part = part_taken(selection, lack_of_fit, fault)
            if not earned(part):
                withdrawn, found, taken = selection.named, (), part
                selection, kept = selection.nothing, kept.nothing
                base = selection.base
                unseen = on_unseen(unfitted, base, base)
                lack_of_fit = lack_of_fit_of(selection.best, seed)
                fit, record_effects = fit_errors(problem, selection.best, progress, jobs)
        if ends := ceilings(rig, problem, (selection.base, selection.best), lack_of_fit):
            return again(apart=apart, cut=ends)
        if not (apart or rig.blocking) and (told := unlogged(selection.best, stays=not fault)):
            return again(apart=told)
        left, more = matters(problem, selection, lack_of_fit), None
        untold = cannot_tell(recording, selection.named)
        if learning and left and not (rig.blocking or untold or fault):
            start = sought.base, _on_thin(thin, sought.best, selection.best)
            more = learned(
                (thin, seen, problem), unfitted, kept, start, testable, lack_of_fit, workers, seed
            )
    if not left and not untold and len(selection.named) > 1:
        untold = cannot_tell_several(recording, selection.named)
    if not left and not selection.named and rig.cut:
        untold = "a channel that stops at a limit"
    named, noise = selection.best, lack_of_fit.noise_rms
    if left or rig.blocking or untold or apart:
        verdict = Verdict.UNEXPLAINED
    else:
        verdict = Verdict.EXPLAINED if selection.named else Verdict.ADEQUATE
    mismatch: list[Region] = []
    if verdict is not Verdict.ADEQUATE:
        missed = selection.base.residual - named.residual  # what both predict, so without noise
        square = lack_of_fit.square(missed) if left else missed**2
        acted = [(f.effect, f.acts) for f in found]
        mismatch = places(named.problem, square, acted, sure=not left)
    mismatch = [*regions(apart, named, lack_of_fit.misfit_rms), *mismatch]
    base, best = selection.base, named
    similar = resemblance(named.problem, lack_of_fit.predicted) if left else None
    if more is not None:
        best, fit, record_effects = more.selection.best, more.fit, more.record_effects
        unseen, lack_of_fit, found = more.unseen, more.lack_of_fit, more.findings
        noise = lack_of_fit.noise_rms  # misfit that the law takes is none
        taking = {f.effect.name for f in found}  # what a law leaves of the misfit, they take
        withdrawn = tuple(e for e in withdrawn if e.name not in taking)
        taken = taken if withdrawn else None
    if aside and withdrawn and found:
        unseen = (replace(unseen[0], decided=True), *unseen[1:])
    refitted = scores.of(problem, base.model, base.values)
    corrected = scores.of(problem, fit.model, fit.values)
    as_fault = None if given is None else fault_of_given(problem, given, testable, best)
    undetected: tuple[Detectable, ...] = ()
    if limits:
        undetected = _undetected(thin, sought.best, named, candidates, missing, progress)
    return Diagnosis(
        verdict=verdict,
        cannot_tell=untold,
        noise_rms=noise,
        problem=problem,
        selection=selection,
        fit=fit,
        record_effects=record_effects,
        findings=found,
        mismatch=tuple(mismatch),
        given=given,
        baseline=refitted if given is None else scores.of(problem, given.model, given.values),
        refitted=refitted,
        corrected=corrected,
        carried=corrected if record_effects is None else scores.carried(problem, best),
        unseen=unseen,
        withdrawn=withdrawn,
        taken=taken,
        cross_validated=(
            scores.cross_validated(best.problem, selection.base),
            scores.cross_validated(best.problem, best),
        ),
        lack_of_fit=lack_of_fit,
        resemblance=similar,
        untestable=missing,
        undetected=undetected,
        rig=rig,
        learned=more,
        tried=len(testable),
        searched=known,
        once=None if untold else fault,
        as_fault=as_fault,
        apart=apart,
    )


def _idle(effect: Effect, fit: Fit, workers: Executor) -> bool:
    """Whether the last step leaves nothing of an effect, or more than the log allows.

    It then made up for steps of the log that are long for what happens in them; between samples,
    where the damper is, there is none of it. Or for something else that is missing.
    """
    own = {effect.key(q.symbol): fit.values[effect.key(q.symbol)] for q in effect.quantities}
    return may_be_absent(effect, fit) or not workers.possible(own)


def _undetected(
    thin: Problem,
    searched: Hypothesis,
    best: Hypothesis,
    candidates: Sequence[Effect],
    untestable: dict[str, str],
    progress: Progress,
) -> tuple[Detectable, ...]:
    """What could have been missed, on the samples among whose hypotheses was searched."""
    on_thin = _on_thin(thin, searched, best)
    return detectable(thin, on_thin, candidates, untestable, progress)


def _on_thin(thin: Problem, searched: Hypothesis, best: Hypothesis) -> Hypothesis:
    """A hypothesis on the samples among whose hypotheses was searched."""
    if key_of(searched.effects) == key_of(best.effects):
        return searched
    steps, effects = thresholds.STEPS_AGAIN, best.record_effects
    return fit_hypothesis(thin, best.effects, [best.values], steps, effects)
