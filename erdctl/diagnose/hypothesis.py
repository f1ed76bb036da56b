"""One hypothesis: the paper's model with some effects, judged on what its fit has not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.diagnose.problem import Problem, mask_doubtful
from erdctl.diagnose.record_effects import RecordEffects, estimate
from erdctl.estimate.covariance import jacobian
from erdctl.estimate.least_squares import fit
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

# A group is left out but for this part of the weight of all data. What only one group shows (a lag,
# if it alone has duty steps) is otherwise unknown without it, and the step goes to infinity.
KEPT = 0.05
ROUNDS = 12  # of alternating least squares between the model and the scatter of the records
GLANCE = 4  # steps of a search that only ranks its start


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A fitted model.

    problem : what it was fitted to, but for samples of which its channel makes nothing certain
    residual : (n,) [N];  unseen : (n,) the same, by a fit that leaves out the sample's group
    scatter : of the records, where the problem leaves it free; residuals are then beyond that
    """

    problem: Problem
    model: Model
    values: dict[str, float]
    residual: Array
    cross_validated: Array
    evaluations: int
    record_effects: RecordEffects | None = None

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects beyond the paper's model."""
        return self.model.effects

    @property
    def score(self) -> float:
        """Mean square over what was not seen [N^2]."""
        return float(np.average(self.cross_validated**2, weights=self.problem.block.weight))


def fit_hypothesis(
    problem: Problem,
    effects: Sequence[Effect],
    starts: Sequence[Mapping[str, float]],
    max_evaluations: int = 40,
    record_effects: RecordEffects | None = None,
) -> Hypothesis:
    """Fit from every start and judge the best by leaving groups out.

    scatter : of the records to begin with
    """
    model = Model(tuple(effects))
    if problem.free and record_effects is None:
        record_effects = RecordEffects.none(len(problem.recording.names))
    found = [_fitted(problem, model, start, max_evaluations, record_effects) for start in starts]
    values, residual, _ = min(found, key=lambda f: _cost(problem, f[1]))
    evaluations = sum(count for _, _, count in found)
    part = mask_doubtful(problem, model, values)
    if part is not problem:
        values, residual, count = _fitted(part, model, values, max_evaluations, record_effects)
        part = mask_doubtful(problem, model, values)
        evaluations += count
    for _ in range(ROUNDS if record_effects is not None else 0):
        assert record_effects is not None
        modelled = model.force(part.block.signals, values)
        last, record_effects = (
            record_effects,
            estimate(problem.free, part.block, modelled, record_effects),
        )
        values, residual, count = _fitted(part, model, values, max_evaluations, record_effects)
        evaluations += count
        if record_effects.settled(last):
            break
    cross_validated = cross_validated_residual(part, model, values, residual, record_effects)
    return Hypothesis(part, model, values, residual, cross_validated, evaluations, record_effects)


def rank_starts(
    problem: Problem,
    effects: Sequence[Effect],
    points: Sequence[Mapping[str, float]],
    record_effects: RecordEffects | None = None,
) -> list[dict[str, float]]:
    """Starts after a short search from each, the most promising first."""
    model = Model(tuple(effects))
    found = [_fitted(problem, model, point, GLANCE, record_effects) for point in points]
    found.sort(key=lambda f: _cost(problem, f[1]))
    return [values for values, _, _ in found]


def _fitted(
    problem: Problem,
    model: Model,
    start: Mapping[str, float],
    max_evaluations: int,
    record_effects: RecordEffects | None = None,
) -> tuple[dict[str, float], Array, int]:
    given = {**start, **problem.held}  # perhaps of a larger model
    full = {n: given.get(n, q.start) for n, q in model.quantities.items()}
    block = problem.block if record_effects is None else record_effects.shared(problem.block)
    values, count, _ = fit(
        model, block, start=full, fixed=problem.held, max_evaluations=max_evaluations
    )
    residual = block.force - model.force(block.signals, values)
    if record_effects is not None:
        residual = residual * record_effects.along(block.signals.starts)[0]
    return values, residual, count


def _cost(problem: Problem, residual: Array) -> float:
    cost = float(np.dot(problem.block.weight, residual * residual))
    return cost if np.isfinite(cost) else np.inf


def cross_validated_residual(
    problem: Problem,
    model: Model,
    values: Mapping[str, float],
    residual: Array,
    record_effects: RecordEffects | None = None,
) -> Array:
    """(n,) error on each group by a fit without it [N].

        d = (N - N_g)^-1 J_g' W r_g,   theta without g = theta - d,   r_g without = r_g + J_g d

    N = J' W J: exact for a linear model, the first Gauss-Newton step for others, so that leaving
    every group out costs one Jacobian. A parameter at a bound is kept there.
    """
    free = []
    for name, q in model.quantities.items():
        if name in problem.held:
            continue
        v = values[name]
        if q.low < v < q.high:
            free.append(name)
    J = jacobian(model, problem.block.signals, values, free)
    if record_effects is not None:
        J = J * record_effects.along(problem.block.signals.starts)[0]
    scale = np.sqrt(np.einsum("ij,ij,j->i", J, J, problem.block.weight))
    scale[scale == 0.0] = 1.0
    J = J / scale[:, None]
    weighted = J * problem.block.weight
    whole = (1.0 + KEPT) * (weighted @ J.T)
    out = np.empty_like(residual)
    order = np.argsort(problem.group, kind="stable")
    bounds = np.searchsorted(problem.group[order], np.arange(problem.count + 1))
    for g in range(problem.count):
        rows = order[bounds[g] : bounds[g + 1]]
        part, r = J[:, rows], residual[rows]
        weight = problem.block.weight[rows]
        own = (part * weight) @ part.T
        step = np.linalg.lstsq(whole - own, (part * weight) @ r, rcond=1e-10)[0]
        out[rows] = r + step @ part
    return out


def fresh_start(T_d: float, beta: float) -> dict[str, float]:
    """Shape parameters of the paper's model to begin with, whatever a fit has found before."""
    return {f"{d}.T_d": T_d for d in DIRECTIONS} | {f"{d}.beta": beta for d in DIRECTIONS}
