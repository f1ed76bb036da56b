"""Separable least squares over any composed model.

    min over shape parameters s of  min over amplitudes a of  sum w (F - a . columns(s))^2

The inner problem is solved by linear algebra (variable projection, Golub and Pereyra 1973), so
the search runs over the few shape parameters only. Where the force feeds back on itself it is not
linear in the amplitudes, and all parameters are searched. Nothing here names an effect.

The Jacobian of the projected residual is that of Kaufman (1975): differences of the force at the
amplitudes of the point, less what a change of these makes up for. Its gradient is exact, and it
asks for one force a parameter (`model.shifts`) in place of all columns and their solution.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.estimate.normal_equations import Normal
from erdctl.estimate.onsets import place, placed
from erdctl.model.composed import Model
from erdctl.model.response import Prepared
from erdctl.model.shifts import Shifts
from erdctl.model.slots import Values

STEP = 1e-5  # of a one-sided difference, in units of the search
HUBER = 1.345  # tuning constant for 95 % efficiency under normal noise
FINISH = 8  # steps of a search that is to end where the best is
NEAR = 1e-4  # of the range of a search, from a bound that it was driven to
FAILED = 1e100  # N, in place of the residual of a simulation that gave no finite force
PLACED = 4  # times that an onset is looked for again after a search of the others
ANCHOR = 0.05  # of what all samples say, see `fit`
SHORTEST = 1e-5  # s; a time constant of exactly 0 has no derivative, a search stays above


@dataclass(frozen=True, eq=False)
class Fitted:
    """Where one search ended.

    values : every parameter of the model;  residual : (n,) measured less modelled force [N]
    cost : weighted sum of its squares [N^2], infinite if the model gave no finite force
    evaluations : of the model;  converged : whether the search ended by itself
    """

    model: Model
    values: dict[str, float]
    residual: Array
    cost: float
    evaluations: int
    converged: bool


def fit(
    model: Model,
    block: Block,
    *,
    start: Values,
    fixed: Iterable[str] = (),
    robust: bool = False,
    max_evaluations: int = 200,
    tolerance: float = 1e-8,
    anchor: Array | None = None,
) -> Fitted:
    """Search from one start.

    start : a value for every parameter;  fixed : names that keep it
    anchor : (n,) weights of more samples than those of the block: amplitudes of smooth effects
        stay near their start by a part of what these say, so that what only those tell stays there
    tolerance : part of the cost by which a step has to lower it, or the search has converged
    """
    held = set(fixed)
    onsets = set(placed(model)) - held
    shape = [n for n in model.shape if n not in held | onsets]
    values, weight = dict(start), block.weight
    evaluations = 0

    def search(begin: Values) -> tuple[dict[str, float], bool, float]:
        """Values at the end, whether the search converged, and the cost there."""
        nonlocal evaluations
        problem = _Projected(model, block._replace(weight=weight), begin, held, shape, anchor)
        ended, converged = problem.search(max_evaluations, tolerance)
        cost = problem.cost(ended) if onsets else np.nan
        evaluations += problem.evaluations
        return ended, converged, cost

    for _ in range(6 if robust else 1):
        values, converged, cost = search(values)
        for _ in range(PLACED if onsets else 0):
            # The others move to first order there: where that goes far it can do harm.
            moved = place(model, block._replace(weight=weight), values, held)
            if all(moved[n] == values[n] for n in onsets):
                break
            again = search(moved)
            if not again[2] < (1.0 - tolerance) * cost:
                break
            values, converged, cost = again
        if not robust:
            break
        left = block.force - model.force(block.signals, values)
        updated = block.weight * huber_weight(left, block.weight)
        if np.max(np.abs(updated - weight), initial=0.0) < 1e-2:
            break
        weight = updated
    residual = block.force - model.force(block.signals, values)
    cost = float(np.dot(block.weight, residual * residual))
    cost = cost if np.isfinite(cost) else np.inf
    return Fitted(model, values, residual, cost, evaluations, converged)


def huber_weight(residual: Array, weight: Array) -> Array:
    """Weights of Huber's M-estimator at the scale of the median absolute residual."""
    scale = 1.4826 * float(np.median(np.abs(residual[weight > 0]))) or 1.0
    return 1.0 / np.maximum(np.abs(residual) / (HUBER * scale), 1.0)


def solve_linear(columns: Array, force: Array, weight: Array, low: Array, high: Array) -> Array:
    """Weighted least squares of `force` on the rows of `columns`, within bounds.

    columns : (k, n);  force, weight : (n,);  low, high : (k,)
    Returns (k,) amplitudes.
    """
    if columns.shape[0] == 0:
        return np.empty(0)
    weighted = columns * weight
    normal, right = Normal.of(weighted @ columns.T), weighted @ force
    amplitude = normal.solve(right)
    if (amplitude < low).any() or (amplitude > high).any():
        amplitude = normal.bounded(right, low, high)
    return amplitude


class _Projected:
    """The cost as a function of the searched parameters, all others solved inside."""

    def __init__(
        self,
        model: Model,
        block: Block,
        values: Values,
        held: set[str],
        shape: Sequence[str],
        anchor: Array | None = None,
    ) -> None:
        self.model, self.block = model, block
        self.anchor = anchor if any(e.smooth for e in model.effects) else None
        linear = [n for n in model.linear if n not in held]
        self.linear = linear if model.separable else []
        self.names = list(shape) if model.separable else [*shape, *linear]
        self.axes = [_Axis.of(model.quantities[n], values[n]) for n in self.names]
        self.base = {**values, **{n: a.value for n, a in zip(self.names, self.axes, strict=True)}}
        self.open = np.array([n not in held for n in model.linear])
        quantities = [model.quantities[n] for n in self.linear]
        self.low = np.array([q.low for q in quantities])
        self.high = np.array([q.high for q in quantities])
        self.root = np.sqrt(block.weight)
        self.evaluations = 0
        self.at: _Solved | None = None  # where the model was last computed

    def solve(self, point: Array) -> tuple[dict[str, float], Array]:
        """All values and the (n,) residual at given searched parameters."""
        self.evaluations += 1
        values = dict(self.base)
        for name, axis, u in zip(self.names, self.axes, point.tolist(), strict=True):
            values[name] = axis.back(u)
        force = self.block.force
        prepared = self.model.prepare(self.block.signals, values)
        self.at = _Solved(point.copy(), values, prepared, np.empty((0, len(force))))
        if not self.model.separable:
            residual = force - prepared.force(values)
            return values, residual if np.isfinite(residual).all() else np.full_like(force, FAILED)
        columns = prepared.columns()
        if not self.open.all():
            given = np.array([values[n] for n in self.model.linear])[~self.open]
            force = force - given @ columns[~self.open]
            columns = columns[self.open]
        rows, right, weight = columns, force, self.block.weight
        if self.anchor is not None:
            rows, right, weight = self._anchored(columns, force, self.anchor)
        amplitude = solve_linear(rows, right, weight, self.low, self.high)
        values.update(zip(self.linear, amplitude.tolist(), strict=True))
        inside = (amplitude > self.low) & (amplitude < self.high)
        self.at = _Solved(point.copy(), values, prepared, columns[inside])
        return values, force - amplitude @ columns

    def _anchored(self, columns: Array, force: Array, anchor: Array) -> tuple[Array, Array, Array]:
        """Columns (k, n + k), force and weights (n + k,) with a sample for each amplitude."""
        smooth = {e.key(q.symbol) for e in self.model.effects if e.smooth for q in e.sizes}
        held = ANCHOR * np.array([n in smooth for n in self.linear])
        weight = held * np.einsum("ij,ij,j->i", columns, columns, anchor)
        start = np.array([self.base[n] for n in self.linear])
        rows = np.hstack([columns, np.eye(len(start))])
        return rows, np.append(force, start), np.append(self.block.weight, weight)

    def jacobian(self, point: Array) -> Array:
        """(n, p) derivative of the weighted residual by the searched parameters."""
        if self.at is None or not np.array_equal(self.at.point, point):
            self.solve(point)
        assert self.at is not None
        values, columns = self.at.values, self.at.columns * self.root
        near = Shifts(self.model, self.block.signals, values, self.at.prepared)
        rows = np.zeros((len(point), len(self.root)))
        for row, name, axis, u in zip(rows, self.names, self.axes, point.tolist(), strict=True):
            self.evaluations += 1
            step = STEP * max(abs(u), axis.least)
            step = -step if u + step > axis.high else step
            moved = near.at(name, axis.back(u + step))
            # Where a simulation gives no finite force there is no slope to follow.
            if np.isfinite(moved).all():
                row[:] = (near.force - moved) * (self.root / step)
        if len(columns):
            rows -= Normal.of(columns @ columns.T).solve(columns @ rows.T).T @ columns
        return rows.T

    def cost(self, values: Values) -> float:
        """Weighted sum of squares at given values of the searched parameters [N^2]."""
        point = [a.forth(values[n]) for n, a in zip(self.names, self.axes, strict=True)]
        weighted = self.root * self.solve(np.array(point))[1]
        return float(weighted @ weighted)

    def search(self, max_evaluations: int, tolerance: float) -> tuple[dict[str, float], bool]:
        """The best values from the start, and whether the search converged."""
        if not self.names:
            return self.solve(np.empty(0))[0], True
        from scipy.optimize import least_squares

        low = np.array([a.low for a in self.axes])
        high = np.array([a.high for a in self.axes])
        start = np.array([a.forth(a.value) for a in self.axes])
        start = np.clip(start, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
        search = partial(
            least_squares,
            lambda p: self.root * self.solve(p)[1],
            jac=self.jacobian,
            bounds=(low, high),
            x_scale="jac",
            ftol=tolerance,
            xtol=1e-7,
            gtol=1e-12,
        )
        found = search(start, max_nfev=max_evaluations)
        if found.status == 0 and max_evaluations >= FINISH:
            # This search keeps off the bounds, and creeps where the best lies on one; the other
            # goes along them, but from far away is caught there.
            end = search(found.x, method="dogbox", max_nfev=max_evaluations // 4)
            found = min(found, end, key=lambda f: f.cost)
        return self.solve(found.x)[0], bool(found.status > 0)


def at_bound(q: Quantity, value: float, *, near: float = 0.0) -> bool:
    """Whether a parameter has come to one of its bounds.

    near : part of the range of a search within which it counts. A search keeps off the bounds and
        creeps towards one that it is driven to (NEAR); what lies on one exactly has no standard
        error, and the others are given for it as it is (0).
    """
    if near == 0.0 or not q.low < value < q.high:
        return not q.low < value < q.high
    axis = _Axis.of(q, value)
    margin = near * (axis.high - axis.low)
    return not axis.low + margin < axis.forth(value) < axis.high - margin


class _Solved(NamedTuple):
    """A point of the search, all values there, the model, and the columns that are free to move."""

    point: Array
    values: dict[str, float]
    prepared: Prepared
    columns: Array


class _Axis(NamedTuple):
    """One searched parameter: its start, and the search's own coordinate.

    least : size of a value from which on a step is a part of it
    """

    value: float
    low: float
    high: float
    log: bool
    least: float
    quantity: Quantity

    @classmethod
    def of(cls, q: Quantity, value: float) -> _Axis:
        """The search begins at the parameter's own start where an off value is out of bounds."""
        low = SHORTEST if q.unit == "s" and q.low == 0 else q.low
        if not low <= value <= q.high:
            value = q.start
        if q.scale is Scale.LOG:
            bounds = float(np.log(low)), float(np.log(q.high))
            return cls(value, *bounds, log=True, least=1.0, quantity=q)
        least = 1e-3 * max(abs(q.start), 1e-3)
        return cls(value, low, q.high, log=False, least=least, quantity=q)

    def forth(self, value: float) -> float:
        return float(np.log(value)) if self.log else value

    def back(self, u: float) -> float:
        """Within the bounds: exp(log(high)) can be an ulp above, which no file may hold."""
        value = float(np.exp(u)) if self.log else u
        return min(max(value, self.quantity.low), self.quantity.high)
