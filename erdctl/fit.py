"""Separable least squares over any composed model, with errors that hold for coloured residuals.

    min over shape parameters s of  min over amplitudes a of  sum w (F - a . columns(s))^2

The inner problem is solved by linear algebra (variable projection, Golub and Pereyra 1973), so
the search runs over the few shape parameters only. Nothing here names an effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from erdctl.blocks import Block
from erdctl.effect import Values
from erdctl.model import Model
from erdctl.noise import ColouredNoise
from erdctl.recording import Array
from erdctl.signals import Signals

DIFFERENCE = 1e-6  # relative step of a one-sided difference
COLOURED = 16  # blocks on which the effect of coloured noise is measured
HUBER = 1.345  # tuning constant for 95 % efficiency under normal noise
SINGULAR = 1e-10  # relative eigenvalue of the scaled normal matrix below which a direction is flat


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """Parameter estimates and what is known about them.

    values : every parameter of the model;  free : names of the estimated ones
    covariance : (p, p) of the free ones, valid under correlated residuals
    rms : weighted residual [N];  samples : number of samples with weight
    flat : groups of free parameters along which the data do not change the cost at all
    """

    model: Model
    values: dict[str, float]
    free: tuple[str, ...]
    covariance: Array
    rms: float
    noise: ColouredNoise
    samples: int
    evaluations: int
    converged: bool
    flat: tuple[tuple[str, ...], ...] = ()

    @property
    def stderr(self) -> dict[str, float]:
        """Standard error of every free parameter."""
        return dict(zip(self.free, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    def correlation(self) -> Array:
        """(p, p) correlation of the free parameters."""
        scale = np.sqrt(np.diag(self.covariance))
        scale = np.where(scale > 0, scale, 1.0)
        return np.asarray(self.covariance / np.outer(scale, scale))


def fit(
    model: Model,
    block: Block,
    *,
    start: Values,
    fixed: Iterable[str] = (),
    robust: bool = False,
    max_evaluations: int = 200,
) -> tuple[dict[str, float], int, bool]:
    """Search from one start.

    start : a value for every parameter;  fixed : names that keep it
    Returns the values found, the number of model evaluations, and whether the search converged.
    """
    held = set(fixed)
    shape = [n for n in model.shape if n not in held]
    values = dict(start)
    weight = block.weight
    evaluations, converged = 0, True
    for _ in range(6 if robust else 1):
        problem = _Projected(model, block._replace(weight=weight), values, held, shape)
        values, converged = problem.search(max_evaluations)
        evaluations += problem.evaluations
        if not robust:
            break
        updated = block.weight * huber_weight(problem.residual(values), block.weight)
        if np.max(np.abs(updated - weight), initial=0.0) < 1e-2:
            break
        weight = updated
    return values, evaluations, converged


def huber_weight(residual: Array, weight: Array) -> Array:
    """Weights of Huber's M-estimator at the scale of the median absolute residual."""
    scale = 1.4826 * float(np.median(np.abs(residual[weight > 0]))) or 1.0
    return 1.0 / np.maximum(np.abs(residual) / (HUBER * scale), 1.0)


def solve_linear(
    columns: Array, force: Array, weight: Array, low: Array, high: Array
) -> tuple[Array, float]:
    """Weighted least squares of `force` on the rows of `columns`, within bounds.

    columns : (k, n);  force, weight : (n,);  low, high : (k,)
    Returns (k,) amplitudes and the weighted sum of squares. Solved on the scaled normal matrix:
    after scaling, its condition is that of the physics (below 1e6), not that of the units.
    """
    if columns.shape[0] == 0:
        return np.empty(0), float(np.dot(weight, force * force))
    weighted = columns * weight
    normal, right = weighted @ columns.T, weighted @ force
    scale = np.sqrt(np.diag(normal))
    scale[scale == 0.0] = 1.0
    scaled = normal / np.outer(scale, scale)
    w, v = np.linalg.eigh(scaled)
    keep = w > SINGULAR * w[-1]
    amplitude = v[:, keep] @ ((v[:, keep].T @ (right / scale)) / w[keep]) / scale
    if (amplitude < low).any() or (amplitude > high).any():
        from scipy.optimize import lsq_linear

        root = (v[:, keep] * np.sqrt(w[keep])).T
        target = (v[:, keep].T @ (right / scale)) / np.sqrt(w[keep])
        amplitude = lsq_linear(root, target, bounds=(low * scale, high * scale)).x / scale
    residual = force - amplitude @ columns
    return amplitude, float(np.dot(weight, residual * residual))


class _Projected:
    """The cost as a function of the free shape parameters, amplitudes solved inside."""

    def __init__(
        self, model: Model, block: Block, values: Values, held: set[str], shape: Sequence[str]
    ) -> None:
        self.model, self.block, self.shape = model, block, list(shape)
        self.base = dict(values)
        self.linear = [n for n in model.linear if n not in held]
        self.open = np.array([n not in held for n in model.linear])
        quantities = [model.quantities[n] for n in self.linear]
        self.low = np.array([q.low for q in quantities])
        self.high = np.array([q.high for q in quantities])
        self.root = np.sqrt(block.weight)
        self.evaluations = 0

    def solve(self, point: Array) -> tuple[dict[str, float], Array]:
        """All values and the (n,) residual at given shape parameters."""
        self.evaluations += 1
        values = {**self.base, **dict(zip(self.shape, point.tolist(), strict=True))}
        columns = self.model.columns(self.block.signals, values)
        force = self.block.force
        if not self.open.all():
            given = np.array([values[n] for n in self.model.linear])[~self.open]
            force = force - given @ columns[~self.open]
            columns = columns[self.open]
        amplitude, _ = solve_linear(columns, force, self.block.weight, self.low, self.high)
        values.update(zip(self.linear, amplitude.tolist(), strict=True))
        return values, force - amplitude @ columns

    def residual(self, values: Values) -> Array:
        return self.solve(np.array([values[n] for n in self.shape]))[1]

    def search(self, max_evaluations: int) -> tuple[dict[str, float], bool]:
        point = np.array([self.base[n] for n in self.shape])
        if not self.shape:
            return self.solve(point)[0], True
        from scipy.optimize import least_squares

        quantities = [self.model.quantities[n] for n in self.shape]
        # A time constant of exactly 0 removes the lag and its derivative: a search stays above.
        low = np.array([max(q.low, 1e-5) if q.low == 0 else q.low for q in quantities])
        high = np.array([q.high for q in quantities])
        point = np.clip(point, low + 1e-9, high - 1e-9)
        found = least_squares(
            lambda p: self.root * self.solve(p)[1],
            point,
            bounds=(low, high),
            x_scale=np.maximum(np.abs(point), 1e-3),
            ftol=1e-10,
            xtol=1e-9,
            gtol=1e-12,
            max_nfev=max_evaluations,
        )
        return self.solve(found.x)[0], bool(found.status > 0)


@dataclass(frozen=True)
class _Sums:
    """What one block contributes: J'WJ, J'Wr, J'WCWJ (where it is asked for), its samples."""

    normal: Array
    gradient: Array
    meat: Array | None
    samples: int


def assess(
    model: Model,
    blocks: Sequence[Block],
    values: Values,
    *,
    fixed: Iterable[str] = (),
    evaluations: int = 0,
    converged: bool = True,
    robust: bool = False,
    threads: int = 2,
) -> Fit:
    """One Gauss-Newton step over all data from a good start, then errors of the estimates.

    The start may come from a part of the data: one step from there is as good as the full search
    to the order of the standard errors (one-step estimator, Le Cam). The covariance is the
    sandwich (J'J)^-1 (J' C J) (J'J)^-1 with C the noise covariance of an autoregressive model of
    the residual, so that correlated residuals do not make errors look small.
    """
    held = set(fixed)
    free = tuple(n for n in model.quantities if n not in held)
    with ThreadPoolExecutor(threads) as pool:

        def residuals(at: Values) -> tuple[list[Block], float, ColouredNoise]:
            """The blocks with robust weights, their weighted square, and the noise in them."""
            found = list(pool.map(lambda b: _residual(model, b, at, robust), blocks))
            noise = ColouredNoise.pooled([n for _, _, n in found])
            return [b for b, _, _ in found], sum(s for _, s, _ in found), noise

        weighted, before, noise = residuals(values)
        # Colouring is the dearest part, and a share of a long log gives the noise's effect as well.
        every = -(-len(weighted) // COLOURED)
        parts = list(
            pool.map(
                lambda i: _sum_up(
                    model, weighted[i], values, free, noise if i % every == 0 else None
                ),
                range(len(weighted)),
            )
        )
        inverse, flat = _inverse(np.sum([p.normal for p in parts], axis=0), free)
        coloured = [p for p in parts if p.meat is not None]
        share = sum(p.samples for p in parts) / max(sum(p.samples for p in coloured), 1)
        meat = share * np.sum([p.meat for p in coloured], axis=0)
        step = inverse @ np.sum([p.gradient for p in parts], axis=0)
        moved = dict(values)
        for name, move in zip(free, step.tolist(), strict=True):
            q = model.quantities[name]
            moved[name] = float(np.clip(values[name] + move, q.low, q.high))
        _, after, noise_after = residuals(moved)
        if not after <= before:
            moved, after, noise_after = dict(values), before, noise
    samples = sum(int(np.count_nonzero(b.weight)) for b in blocks)
    return Fit(
        model=model,
        values=moved,
        free=free,
        covariance=inverse @ meat @ inverse,
        rms=float(np.sqrt(after / max(samples - len(free), 1))),
        noise=noise_after,
        samples=samples,
        evaluations=evaluations,
        converged=converged,
        flat=flat,
    )


def jacobian(model: Model, signals: Signals, values: Values, free: Sequence[str]) -> Array:
    """(p, n) derivative of the force by every free parameter."""
    prepared = model.prepare(signals, values)
    linear = dict(zip(model.linear, prepared.columns(), strict=True))
    force = prepared.force(values)
    rows = []
    for name in free:
        if name in linear:
            rows.append(linear[name])
            continue
        q = model.quantities[name]
        step = DIFFERENCE * max(abs(values[name]), 1e-3 * max(abs(q.start), 1e-3))
        step = -step if values[name] + step > q.high else step
        shifted = model.force(signals, {**values, name: values[name] + step})
        rows.append((shifted - force) / step)
    return np.array(rows)


def _residual(
    model: Model, block: Block, values: Values, robust: bool
) -> tuple[Block, float, ColouredNoise]:
    residual = block.force - model.force(block.signals, values)
    if robust:
        block = block._replace(weight=block.weight * huber_weight(residual, block.weight))
    square = float(np.dot(block.weight, residual * residual))
    noise = ColouredNoise.of(residual * np.sqrt(block.weight), block.signals.starts)
    return block, square, noise


def _sum_up(
    model: Model,
    block: Block,
    values: Values,
    free: Sequence[str],
    noise: ColouredNoise | None,
) -> _Sums:
    J = jacobian(model, block.signals, values, free)
    residual = block.force - model.force(block.signals, values)
    weighted = J * block.weight
    meat = None
    if noise is not None:
        coloured = noise.colour(weighted, block.signals.starts)
        meat = coloured @ coloured.T
    return _Sums(
        normal=weighted @ J.T,
        gradient=weighted @ residual,
        meat=meat,
        samples=int(np.count_nonzero(block.weight)),
    )


def _inverse(normal: Array, free: Sequence[str]) -> tuple[Array, tuple[tuple[str, ...], ...]]:
    """Inverse of the normal matrix, and the parameters along each direction that is flat."""
    scale = np.sqrt(np.diag(normal))
    scale[scale == 0.0] = 1.0
    w, v = np.linalg.eigh(normal / np.outer(scale, scale))
    keep = w > SINGULAR * w[-1]
    inverse = (v[:, keep] / w[keep]) @ v[:, keep].T / np.outer(scale, scale)
    names = np.array(free)
    flat = [tuple(names[np.abs(v[:, j]) > 0.1].tolist()) for j in np.flatnonzero(~keep)]
    return inverse, tuple(flat)
