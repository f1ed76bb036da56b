"""One hypothesis: the paper's model with some effects, judged on what its fit has not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.diagnose.problem import Study, sure
from erdctl.diagnose.record_effects import Scatter, estimate
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
class Trial:
    """A fitted model.

    study : what it was fitted to, but for samples of which its channel makes nothing certain
    residual : (n,) [N];  unseen : (n,) the same, by a fit that leaves out the sample's group
    scatter : of the records, where the study leaves it free; residuals are then beyond that
    """

    study: Study
    model: Model
    values: dict[str, float]
    residual: Array
    unseen: Array
    evaluations: int
    scatter: Scatter | None = None

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects beyond the paper's model."""
        return self.model.effects

    @property
    def score(self) -> float:
        """Mean square over what was not seen [N^2]."""
        return float(np.average(self.unseen**2, weights=self.study.block.weight))


def attempt(
    study: Study,
    effects: Sequence[Effect],
    starts: Sequence[Mapping[str, float]],
    max_evaluations: int = 40,
    scatter: Scatter | None = None,
) -> Trial:
    """Fit from every start and judge the best by leaving groups out.

    scatter : of the records to begin with
    """
    model = Model(tuple(effects))
    if study.free and scatter is None:
        scatter = Scatter.none(len(study.recording.names))
    found = [_fitted(study, model, start, max_evaluations, scatter) for start in starts]
    values, residual, _ = min(found, key=lambda f: _cost(study, f[1]))
    evaluations = sum(count for _, _, count in found)
    part = sure(study, model, values)
    if part is not study:
        values, residual, count = _fitted(part, model, values, max_evaluations, scatter)
        part = sure(study, model, values)
        evaluations += count
    for _ in range(ROUNDS if scatter is not None else 0):
        assert scatter is not None
        modelled = model.force(part.block.signals, values)
        last, scatter = scatter, estimate(study.free, part.block, modelled, scatter)
        values, residual, count = _fitted(part, model, values, max_evaluations, scatter)
        evaluations += count
        if scatter.settled(last):
            break
    unseen = leave_out(part, model, values, residual, scatter)
    return Trial(part, model, values, residual, unseen, evaluations, scatter)


def ranked(
    study: Study,
    effects: Sequence[Effect],
    points: Sequence[Mapping[str, float]],
    scatter: Scatter | None = None,
) -> list[dict[str, float]]:
    """Starts after a short search from each, the most promising first."""
    model = Model(tuple(effects))
    found = [_fitted(study, model, point, GLANCE, scatter) for point in points]
    found.sort(key=lambda f: _cost(study, f[1]))
    return [values for values, _, _ in found]


def _fitted(
    study: Study,
    model: Model,
    start: Mapping[str, float],
    max_evaluations: int,
    scatter: Scatter | None = None,
) -> tuple[dict[str, float], Array, int]:
    given = {**start, **study.held}  # perhaps of a larger model
    full = {n: given.get(n, q.start) for n, q in model.quantities.items()}
    block = study.block if scatter is None else scatter.shared(study.block)
    values, count, _ = fit(
        model, block, start=full, fixed=study.held, max_evaluations=max_evaluations
    )
    residual = block.force - model.force(block.signals, values)
    if scatter is not None:
        residual = residual * scatter.along(block.signals.starts)[0]
    return values, residual, count


def _cost(study: Study, residual: Array) -> float:
    cost = float(np.dot(study.block.weight, residual * residual))
    return cost if np.isfinite(cost) else np.inf


def leave_out(
    study: Study,
    model: Model,
    values: Mapping[str, float],
    residual: Array,
    scatter: Scatter | None = None,
) -> Array:
    """(n,) error on each group by a fit without it [N].

        d = (N - N_g)^-1 J_g' W r_g,   theta without g = theta - d,   r_g without = r_g + J_g d

    N = J' W J: exact for a linear model, the first Gauss-Newton step for others, so that leaving
    every group out costs one Jacobian. A parameter at a bound is kept there.
    """
    free = []
    for name, q in model.quantities.items():
        if name in study.held:
            continue
        v = values[name]
        if q.low < v < q.high:
            free.append(name)
    J = jacobian(model, study.block.signals, values, free)
    if scatter is not None:
        J = J * scatter.along(study.block.signals.starts)[0]
    scale = np.sqrt(np.einsum("ij,ij,j->i", J, J, study.block.weight))
    scale[scale == 0.0] = 1.0
    J = J / scale[:, None]
    weighted = J * study.block.weight
    whole = (1.0 + KEPT) * (weighted @ J.T)
    out = np.empty_like(residual)
    order = np.argsort(study.group, kind="stable")
    bounds = np.searchsorted(study.group[order], np.arange(study.count + 1))
    for g in range(study.count):
        rows = order[bounds[g] : bounds[g + 1]]
        part, r = J[:, rows], residual[rows]
        weight = study.block.weight[rows]
        own = (part * weight) @ part.T
        step = np.linalg.lstsq(whole - own, (part * weight) @ r, rcond=1e-10)[0]
        out[rows] = r + step @ part
    return out


def fresh_start(T_d: float, beta: float) -> dict[str, float]:
    """Shape parameters of the paper's model to begin with, whatever a fit has found before."""
    return {f"{d}.T_d": T_d for d in DIRECTIONS} | {f"{d}.beta": beta for d in DIRECTIONS}
