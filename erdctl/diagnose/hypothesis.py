"""One hypothesis: the paper's model with some effects, fitted, and cross-validated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.as_taken import as_taken, told_by_control
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.record_effects import RecordEffects, estimate
from erdctl.diagnose.told import as_begun, as_told
from erdctl.estimate.finer import Finer
from erdctl.estimate.held_lags import LAGS
from erdctl.estimate.jumps import slips
from erdctl.estimate.least_squares import Fitted, at_bound, fit
from erdctl.estimate.linearisation import jacobian
from erdctl.estimate.onsets import placed
from erdctl.model.composed import Model
from erdctl.model.effect import Effect


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A fitted model, and what it is worth on data that the fit has not used.

    problem : what it was fitted to, but for samples of which its channel makes nothing certain
    fitted : the fit, with the evaluations of all searches for it
    cross_validated : (n,) residual by a fit without the sample's group [N]
    record_effects : where the problem leaves them free; residuals are then beyond them
    """

    problem: Problem
    fitted: Fitted
    cross_validated: Array
    record_effects: RecordEffects | None = None

    @property
    def model(self) -> Model:
        """The paper's model with the effects."""
        return self.fitted.model

    @property
    def values(self) -> dict[str, float]:
        """Every parameter of the model."""
        return self.fitted.values

    @property
    def residual(self) -> Array:
        """(n,) measured less modelled force [N]."""
        return self.fitted.residual

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects beyond the paper's model."""
        return self.model.effects

    @property
    def free(self) -> list[str]:
        """The parameters that the data determine: neither held, nor at a bound, nor `instant`."""
        model = self.model
        held = self.problem.held.keys() | self.instant | model.said_by_effects
        return [
            name for name, q in model.quantities.items()
            if name not in held and not at_bound(q, self.values[name])
        ]  # fmt: skip

    @property
    def instant(self) -> set[str]:
        """Lags T_d of the yield force that are over by the next sample.

        The search has driven one to its shortest, where the residual pulls at it still, and the one
        sample right behind a turn of the motion, which would see it, makes a step by the slope
        there a leap: without that sample's group, or of the whole fit, to seconds.
        """
        shortest = thresholds.INSTANT * self.problem.block.signals.finest_step
        return {n for n in LAGS if self.values[n] < shortest}

    @cached_property
    def slips(self) -> bool:
        """Whether its piston sticks and slips behind a spring, see `erdctl.estimate.jumps`."""
        block = self.problem.block
        finer = Finer.of(block.signals)
        return slips(self.model, [block], [finer], self.values, self.free)

    @property
    def rms(self) -> float:
        """Of what it leaves of these samples, by their weights [N]."""
        return float(np.sqrt(np.average(self.residual**2, weights=self.problem.block.weight)))

    @property
    def score(self) -> float:
        """Cross-validated mean square [N^2], on the hypothesis's own samples."""
        return float(np.average(self.cross_validated**2, weights=self.problem.block.weight))


def fit_hypothesis(
    problem: Problem,
    effects: Sequence[Effect],
    starts: Sequence[Mapping[str, float]],
    max_evaluations: int = thresholds.STEPS_BASE,
    record_effects: RecordEffects | None = None,
) -> Hypothesis:
    """Fit from every start, and cross-validate the best.

    record_effects : to begin with
    Raises IncompatibleEffects if no model can hold these effects together.
    """
    model = Model(tuple(effects))
    if problem.free and record_effects is None:
        record_effects = RecordEffects.none(len(problem.recording.names))
    begun = told_by_control(problem, model, _complete(problem, model, starts[0]))
    found, evaluations = _best(begun, model, starts, max_evaluations, record_effects)
    part = as_taken(problem, model, found.values)
    if part.block is not problem.block or part.held.keys() != begun.held.keys():
        found = _fitted(part, model, found.values, max_evaluations, record_effects)
        part = as_taken(problem, model, found.values)
        evaluations += found.evaluations
    if record_effects is not None:
        for _ in range(thresholds.RECORD_ROUNDS):
            modelled = model.force(part.block.signals, found.values)
            last, record_effects = (
                record_effects,
                estimate(problem.free, part.block, modelled, record_effects),
            )
            found = _fitted(part, model, found.values, max_evaluations, record_effects)
            evaluations += found.evaluations
            if record_effects.settled(last):
                break
    fitted = replace(found, evaluations=evaluations)
    hypothesis = Hypothesis(part, fitted, found.residual, record_effects)
    return replace(hypothesis, cross_validated=_cross_validated(hypothesis))


def _best(
    problem: Problem,
    model: Model,
    starts: Sequence[Mapping[str, float]],
    max_evaluations: int,
    record_effects: RecordEffects | None,
) -> tuple[Fitted, int]:
    """The best of the searches from several starts, and the evaluations of all.

    Most starts end in one minimum or are far behind after a few steps: of those that have not
    converged by then only the ones near the best are searched to the end.
    """
    if len(starts) == 1:
        only = _fitted(problem, model, starts[0], max_evaluations, record_effects)
        return only, only.evaluations
    steps = min(thresholds.STEPS_LOOK, max_evaluations)
    looks = [_fitted(problem, model, start, steps, record_effects) for start in starts]
    evaluations = sum(f.evaluations for f in looks)
    bar = thresholds.LOOK_BEHIND * min(f.cost for f in looks)
    found = min(looks, key=lambda f: f.cost)
    for look in looks:
        if not look.converged and look.cost <= bar and max_evaluations > steps:
            end = _fitted(problem, model, look.values, max_evaluations - steps, record_effects)
            evaluations += end.evaluations
            found = min(found, end, key=lambda f: f.cost)
    return found, evaluations


def rank_starts(
    problem: Problem,
    effects: Sequence[Effect],
    points: Sequence[Mapping[str, float]],
    record_effects: RecordEffects | None = None,
) -> list[dict[str, float]]:
    """Starts after a short search from each, with onsets where they are, the best first."""
    model, steps = Model(tuple(effects)), thresholds.STEPS_RANKING
    problem = told_by_control(problem, model, _complete(problem, model, points[0]))
    still = [problem.holding(p, placed(model)) for p in points]  # to place them takes longest
    begun = zip(still, points, strict=True)
    found = [_fitted(part, model, p, steps, record_effects) for part, p in begun]
    return [f.values for f in sorted(found, key=lambda f: f.cost)]


def _fitted(
    problem: Problem,
    model: Model,
    start: Mapping[str, float],
    max_evaluations: int,
    record_effects: RecordEffects | None = None,
    whole: Array | None = None,
) -> Fitted:
    """A search from one start, which may be that of a larger model; beyond the record effects."""
    full = _complete(problem, model, start)
    block = problem.block if record_effects is None else record_effects.shared(problem.block)
    held = problem.held.keys() | model.said_by_effects
    tolerance = thresholds.SETTLED / max(int(np.count_nonzero(block.weight)), 1)

    def searched(begin: Mapping[str, float], at_once: Sequence[str], steps: int) -> Fitted:
        return fit(
            model, block, start=begin, fixed=held | set(at_once),
            max_evaluations=steps, tolerance=tolerance, anchor=whole,
        )  # fmt: skip

    none = all(full[n] == 0.0 for n in LAGS)
    found = searched(full, LAGS if none else (), max_evaluations)
    short = all(found.values[n] < block.signals.finest_step for n in LAGS)
    if short and problem.held.keys().isdisjoint(LAGS) and not none:
        # However short, a lag is over by the next sample; that there is none is another model.
        without = searched({**found.values, **dict.fromkeys(LAGS, 0.0)}, LAGS, 1)
        if without.cost < found.cost:
            found = searched(without.values, LAGS, max_evaluations)
    if record_effects is None:
        return found
    residual = found.residual * record_effects.along(block.signals.starts)[0]
    cost = float(np.dot(problem.block.weight, residual * residual))
    return replace(found, residual=residual, cost=cost if np.isfinite(cost) else np.inf)


def _complete(problem: Problem, model: Model, start: Mapping[str, float]) -> dict[str, float]:
    """Every parameter of a model, of a start that may be another's."""
    given = {**start, **problem.held}
    return {n: given.get(n, q.start) for n, q in model.quantities.items()}


def fitted_from(problem: Problem, hypothesis: Hypothesis, steps: int, whole: Array) -> Array:
    """(n,) residual of a hypothesis's model fitted to a part of the same records [N].

    whole : (n,) weights of all samples, see `least_squares.fit`
    """
    own, record_effects = hypothesis.model, hypothesis.record_effects
    start = as_begun(own, hypothesis.values)
    found = _fitted(problem, own, start, steps, record_effects, whole)
    s, rest = problem.block.signals, problem.block.weight
    model, values = as_told(own, found.values, s, rest, whole)
    told = model.force(s, values) - own.force(s, found.values) if model is not own else 0.0
    if record_effects is not None:
        told *= record_effects.along(s.starts)[0]
    return found.residual - told


def over_records(hypothesis: Hypothesis) -> Hypothesis:
    """The same fit, cross-validated with whole records left out in turn."""
    starts = hypothesis.problem.block.signals.starts
    return by_partition(hypothesis, np.repeat(np.arange(len(starts) - 1), np.diff(starts)))


def by_partition(hypothesis: Hypothesis, part: Index) -> Hypothesis:
    """The same fit, cross-validated with each part (n,) of the samples left out in turn."""
    again = replace(hypothesis, problem=replace(hypothesis.problem, group=part))
    return replace(again, cross_validated=_cross_validated(again))


def weighed_as(hypothesis: Hypothesis, weight: Array) -> Hypothesis:
    """The same model fitted with other weights (n,), by a Gauss-Newton step, and cross-validated.

    What was fitted to samples that are not counted is not held against a model.
    """
    problem = hypothesis.problem
    part = replace(problem, block=problem.block._replace(weight=weight))
    _, missed = _one_step(part, slopes(hypothesis), hypothesis.residual)
    return replace(hypothesis, problem=part, cross_validated=missed)


def with_columns(hypothesis: Hypothesis, columns: Array) -> Hypothesis:
    """The same with forces (k, n) of free sizes beside its own, by a Gauss-Newton step.

    Its `fitted` has the values from before the step, and the residual behind it.
    """
    rows = np.vstack([slopes(hypothesis), columns])
    left, missed = _one_step(hypothesis.problem, rows, hypothesis.residual)
    fitted = replace(hypothesis.fitted, residual=left)
    return replace(hypothesis, fitted=fitted, cross_validated=missed)


def _one_step(problem: Problem, J: Array, residual: Array) -> tuple[Array, Array]:
    """Residuals (n,) after a Gauss-Newton step along rows (k, n), and cross-validated."""
    weight = problem.block.weight
    root, scale = np.sqrt(weight), np.sqrt(np.einsum("ij,ij,j->i", J, J, weight))
    J = J[scale > 0.0] / scale[scale > 0.0, None]
    step = np.linalg.lstsq((J * root).T, residual * root, rcond=thresholds.CV_SINGULAR)[0]
    left = residual - step @ J
    return left, left_out(problem, J, left)


def _cross_validated(fitted: Hypothesis) -> Array:
    """(n,) error on each group by a fit without it [N]."""
    return left_out(fitted.problem, slopes(fitted), fitted.residual)


def slopes(fitted: Hypothesis) -> Array:
    """(p, n) derivative of the force by each parameter that the data determine."""
    J = jacobian(fitted.model, fitted.problem.block.signals, fitted.values, fitted.free)
    if fitted.record_effects is not None:
        J = J * fitted.record_effects.along(fitted.problem.block.signals.starts)[0]
    return J


def left_out(problem: Problem, J: Array, residual: Array) -> Array:
    """(..., n) what residuals (..., n) of fits become on each group by a fit without it [N].

        d = (N - N_g)^-1 J_g' W r_g,   theta without g = theta - d,   r_g without = r_g + J_g d

    N = J' W J: exact for a linear model, the first Gauss-Newton step for others, so that leaving
    every group out costs one Jacobian. A parameter at a bound is kept there.
    J : (p, n) see `slopes`;  residual : of the best fit, J' W r = 0
    """
    scale = np.sqrt(np.einsum("ij,ij,j->i", J, J, problem.block.weight))
    scale[scale == 0.0] = 1.0
    J = J / scale[:, None]
    weighted = J * problem.block.weight
    whole = (1.0 + thresholds.CV_RIDGE) * (weighted @ J.T)
    out = np.empty_like(residual)
    order = np.argsort(problem.group, kind="stable")
    bounds = np.searchsorted(problem.group[order], np.arange(problem.count + 1))
    for g in range(problem.count):
        rows = order[bounds[g] : bounds[g + 1]]
        part, r = J[:, rows], residual[..., rows]
        own = weighted[:, rows] @ part.T
        pull = weighted[:, rows] @ r.T
        step = np.linalg.lstsq(whole - own, pull, rcond=thresholds.CV_SINGULAR)[0]
        out[..., rows] = r + step.T @ part
    return out
