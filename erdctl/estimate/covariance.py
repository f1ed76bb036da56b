"""What a fit is worth: one last step over all data, and errors that hold for coloured residuals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.least_squares import huber_weight
from erdctl.estimate.normal_equations import Normal
from erdctl.model.composed import Model
from erdctl.model.parameters import Estimate
from erdctl.model.slots import Values

DIFFERENCE = 1e-6  # relative step of a one-sided difference
COLOURED = 16  # blocks on which the effect of coloured noise is measured


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """Parameter estimates and what is known about them.

    values : every parameter of the model;  free : names of the estimated ones
    covariance : (p, p) of the free ones, valid under correlated residuals
    rms : weighted residual [N];  samples : number of samples with weight
    flat : groups of free parameters along which the data do not change the cost at all
    intervals : 95 % intervals of those that have no standard error, or for which it would not do
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
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def stderr(self) -> dict[str, float]:
        """Standard error of every free parameter."""
        return dict(zip(self.free, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    def correlation(self) -> Array:
        """(p, p) correlation of the free parameters."""
        scale = np.sqrt(np.diag(self.covariance))
        scale = np.where(scale > 0, scale, 1.0)
        return np.asarray(self.covariance / np.outer(scale, scale))


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
        normal = Normal.of(np.sum([p.normal for p in parts], axis=0))
        inverse = normal.pseudo_inverse()
        coloured = [(p.meat, p.samples) for p in parts if p.meat is not None]
        share = sum(p.samples for p in parts) / max(sum(n for _, n in coloured), 1)
        meat = share * np.sum([m for m, _ in coloured], axis=0)
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
        flat=_flat(normal, free),
    )


def estimates(found: Fit, reasons: Mapping[str, str]) -> dict[str, Estimate]:
    """Every parameter with its error; those that the data do not identify have a reason instead.

    reasons : why, by name
    """
    errors, out = found.stderr, {}
    for name, q in found.model.quantities.items():
        value, reason, error = found.values[name], reasons.get(name), errors.get(name)
        bound = q.bound_at(value, error) if name in errors else None
        if reason is None and bound is not None:
            # A fit that presses against a bound is no bell curve around it.
            out[name] = Estimate(value=bound, unit=q.unit, at_bound=True)
        elif reason is None:
            within = found.intervals.get(name)
            out[name] = Estimate(value=value, unit=q.unit, stderr=error, within=within)
        else:
            out[name] = Estimate(value=None, unit=q.unit, assumed=value, reason=reason)
    return out


def jacobian(model: Model, signals: Signals, values: Values, free: Sequence[str]) -> Array:
    """(p, n) derivative of the force by every free parameter."""
    prepared = model.prepare(signals, values)
    # Where the force feeds back on itself no column stands alone.
    known = zip(model.linear, prepared.columns(), strict=True) if model.separable else ()
    linear = dict(known)
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


def _flat(normal: Normal, free: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """The parameters along each direction in which the cost does not change."""
    names = np.array(free)
    return tuple(tuple(names[np.abs(along) > 0.1].tolist()) for along in normal.lost.T)
