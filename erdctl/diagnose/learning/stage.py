"""The stage of a diagnosis behind the catalogue: what is learned, and whether it carries over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import scores, thresholds
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.findings import Finding, findings
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.forward_step import key_of
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.learn import learn
from erdctl.diagnose.learning.promising import learned_in
from erdctl.diagnose.learning.unseen_corners import goes_beyond_what_was_seen
from erdctl.diagnose.on_all_samples import on_all, refit
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.record_effects import RecordEffects
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.search import Selection
from erdctl.diagnose.unseen import Unseen, on_unseen
from erdctl.estimate.covariance import Fit
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.learned.law import Law, LearnedEffect
from erdctl.model.learned.surface import Surface
from erdctl.model.slots import Values


@dataclass(frozen=True, eq=False)
class LearnedLaw:
    """One law that a model lacks.

    finding : what it is worth, and the drive that would tell it from its look-alikes
    alike : laws that would do as well in its place
    tau : the time constant of its coordinate, if that has one [s], or its travel [m]
    z : of each coordinate (k,) values;  f : (k,) or (k, m) the curve [N], [m], or [1] of a factor
        less 1
    turns : (z, f) where a curve over one coordinate is smallest and largest, also between those
    """

    law: Law
    finding: Finding
    alike: tuple[Law, ...]
    tau: float | None
    z: tuple[Array, ...]
    f: Array
    turns: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, eq=False)
class Learned:
    """A model with what was learned beside what was named.

    selection : of effects and laws;  findings : of the effects that are named still
    unseen : errors by what was left out, of the model to answer for and of this one
    """

    selection: Selection
    laws: tuple[LearnedLaw, ...]
    findings: tuple[Finding, ...]
    unseen: tuple[Unseen, ...]
    fit: Fit
    record_effects: RecordEffects | None
    lack_of_fit: LackOfFit


def learned(
    problems: tuple[Problem, Problem, Problem],
    aside: Problem | None,
    named: Selection,
    start: tuple[Hypothesis, Hypothesis],
    candidates: Sequence[Effect],
    rest: LackOfFit,
    executor: Executor,
    seed: int,
) -> Learned | None:
    """What can be learned of a rest; None if nothing carries over.

    problems : the thinned one, what the search may see, and all samples
    aside : what neither fit nor search has seen, if there is any
    named : the model that leaves the rest, and the one to answer for
    start : these two on the thinned problem, that to answer for first
    candidates : the effects that the log can show;  rest : what is to be learned of
    """
    thin, seen, problem = problems
    line = None if rest.spectral_line is None else rest.spectral_line.frequency
    found = learn(thin, *start, candidates, line, executor, seed)
    if not learned_in(found.named):
        return None
    known = {n: named.look_alikes.get(n) or alike for n, alike in found.look_alikes.items()}
    found = refit(seen, replace(found, look_alikes=known, singles=named.singles), executor)
    # What predicts anything worse than the model without it is no correction.
    parts = on_unseen(aside, named.best, found.best)
    if not learned_in(found.named) or any(u.worse for u in parts):
        return None
    if goes_beyond_what_was_seen(found.best):
        return None
    stay = key_of(found.base.effects)  # which their own part of the misfit speaks for
    said = (*(f for f in findings(seen, named) if f.effect.name in stay), *findings(seen, found))
    unseen = on_unseen(aside, named.base, found.best)
    if aside is not None:
        found = on_all(problem, found, executor)
    fit, record_effects = fit_errors(problem, found.best, executor.progress, executor.jobs)
    # Nor what pays where records settle, which no fit weighs.
    pair = (scores.of(problem, fit.model, fit.values), scores.of(problem, *_of(named.best)))
    if pair[0].overall.rms > pair[1].overall.rms:
        return None
    return Learned(
        selection=found,
        laws=tuple(_law(found, f, fit.values) for f in said if isinstance(f.effect, LearnedEffect)),
        findings=tuple(f for f in said if not isinstance(f.effect, LearnedEffect)),
        unseen=unseen,
        fit=fit,
        record_effects=record_effects,
        lack_of_fit=lack_of_fit_of(found.best, seed),
    )


def _of(hypothesis: Hypothesis) -> tuple[Model, dict[str, float]]:
    return hypothesis.model, hypothesis.values


def _law(found: Selection, finding: Finding, values: Values) -> LearnedLaw:
    """A law with the values of the last step, which are those that are written."""
    effect = finding.effect
    assert isinstance(effect, LearnedEffect)
    law, p = effect.law, effect.local(values)
    curve = law.curve
    z = tuple(np.linspace(*axis.range, thresholds.CURVE_POINTS) for axis in curve.axes)
    sizes = np.array([p[q.symbol] for q in law.curve.amplitudes(law.unit)])
    turns: tuple[tuple[float, float], ...] = ()
    if isinstance(curve, Surface):
        shape = len(z[0]), len(z[1])
        rows = curve.at_both(np.repeat(z[0], shape[1]), np.tile(z[1], shape[0]))
    else:
        shape, rows = z[0].shape, curve.at(z[0], p)
        fine = np.linspace(*curve.axes[0].range, thresholds.CURVE_WORDS)
        f = sizes @ curve.at(fine, p)
        turns = tuple((float(fine[k]), float(f[k])) for k in (f.argmin(), f.argmax()))
    others = [h.effects[-1] for _, h in found.look_alikes[effect.name]]
    return LearnedLaw(
        law=law,
        finding=finding,
        alike=tuple(e.law for e in learned_in(others)),
        tau=p.get("tau"),
        z=z,
        f=(sizes @ rows).reshape(shape),
        turns=turns,
    )
