"""What a fit is worth: one last step over all data, and errors that hold for coloured residuals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.finer import Finer
from erdctl.estimate.least_squares import huber_weight
from erdctl.estimate.noise_size import innovation_size, within_records
from erdctl.estimate.normal_equations import Normal
from erdctl.estimate.record_scatter import RecordSums, covariance
from erdctl.model.composed import Model
from erdctl.model.parameters import Estimate
from erdctl.model.slots import Values

DIFFERENCE = 1e-6  # relative step of a one-sided difference
WIDE = 1e-3  # relative step to either side of a parameter that the force may jump with
STEPS = 4  # of Gauss-Newton in a model with effects, from a fit in the log's own steps
SETTLED = 1e-6  # part of the cost that a step must gain for another
COLOURED = 16  # blocks on which the effect of coloured noise is measured


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


@dataclass(frozen=True, eq=False)
class _Sums:
    """What one block contributes, by number of record; the meat only where it was asked for."""

    normal: dict[int, Array]
    score: dict[int, Array]
    meat: dict[int, Array]
    rough: Array | None


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
    sandwich (J'J)^-1 (J' C J) (J'J)^-1. C is that of an autoregressive model of the residual whose
    innovations grow as those found do with the force and from record to record, so that neither
    correlated nor uneven residuals make errors look small; to it comes what scatters from record to
    record (`erdctl.estimate.record_scatter`).
    """
    held = set(fixed)
    free = tuple(n for n in model.quantities if n not in held)
    p = len(free)
    # The paper's model alone is exact but for turns, and its logs may be long.
    finer = [Finer.of(b.signals) if model.effects else Finer(b.signals, None) for b in blocks]
    with ThreadPoolExecutor(threads) as pool:

        def residuals(at: Values) -> tuple[list[Block], float, ColouredNoise]:
            """The blocks with robust weights, their weighted square, and the noise in them."""
            found = list(pool.map(lambda b, f: _residual(model, b, f, at, robust), blocks, finer))
            noise = ColouredNoise.pooled([n for _, _, n in found])
            return [b for b, _, _ in found], sum(s for _, s, _ in found), noise

        weighted, before, noise = residuals(values)
        # Colouring is the dearest part, and a share of a long log gives the noise's effect as well.
        every = -(-len(weighted) // COLOURED)
        for _ in range(STEPS if model.effects else 1):
            colours = [noise if i % every == 0 else None for i in range(len(weighted))]
            parts = list(
                pool.map(
                    lambda b, f, c, at=values: _sum_up(model, b, f, at, free, c),
                    weighted, finer, colours,
                )
            )  # fmt: skip
            records = _records(parts)
            normal = Normal.of(np.sum([r.normal for r in records], axis=0)[:p, :p])
            inverse = normal.pseudo_inverse()
            step = inverse @ np.sum([r.score for r in records], axis=0)[:p]
            moved = _moved(model, values, free, step)
            again, after, noise_after = residuals(moved)
            if not after <= before:
                break
            values, weighted, noise = moved, again, noise_after
            gained, before = before - after, after
            if gained <= SETTLED * after:
                break
    after = before
    samples = sum(int(np.count_nonzero(b.weight)) for b in blocks)
    return Fit(
        model=model,
        values=dict(values),
        free=free,
        covariance=covariance(records, inverse, _roughness(parts, inverse)),
        rms=float(np.sqrt(after / max(samples - len(free), 1))),
        noise=noise,
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
            out[name] = Estimate(value=value, unit=q.unit, stderr=error)
        else:
            out[name] = Estimate(value=None, unit=q.unit, assumed=value, reason=reason)
    return out


def _moved(model: Model, values: Values, free: Sequence[str], step: Array) -> dict[str, float]:
    out = dict(values)
    for name, move in zip(free, step.tolist(), strict=True):
        q = model.quantities[name]
        out[name] = float(np.clip(values[name] + move, q.low, q.high))
    return out


def jacobian(model: Model, signals: Signals, values: Values, free: Sequence[str]) -> Array:
    """(p, n) derivative of the force by every free parameter."""
    return _linearised(model, Finer(signals, None), values, free)[1]


def _linearised(
    model: Model, finer: Finer, values: Values, free: Sequence[str], *, wide: bool = False
) -> tuple[Array, Array]:
    """(n,) force and its (p, n) derivative by every free parameter.

    wide : the slope of an effect's parameter over a thousandth of it to either side. Where force
        jumps from sample to sample as the parameter grows (contacts, delays), the slope at a point
        is that of one sample
    """
    prepared = model.prepare(finer.signals, values)
    # Where the force feeds back on itself no column stands alone.
    columns = finer.picked(prepared.columns()) if model.separable else ()
    known = zip(model.linear, columns, strict=True) if model.separable else ()
    linear = dict(known)
    force = finer.picked(prepared.force(values))
    rows = []
    for name in free:
        if name in linear:
            rows.append(linear[name])
            continue
        q, value = model.quantities[name], values[name]
        if wide and name.split(".")[0] not in DIRECTIONS:
            step = WIDE * max(abs(value), 0.1 * abs(q.start))
            low, high = max(value - step, q.low), min(value + step, q.high)
            ends = [finer.force(model, {**values, name: v}) for v in (low, high)]
            rows.append((ends[1] - ends[0]) / (high - low))
            continue
        step = DIFFERENCE * max(abs(value), 1e-3 * max(abs(q.start), 1e-3))
        step = -step if value + step > q.high else step
        shifted = finer.force(model, {**values, name: value + step})
        rows.append((shifted - force) / step)
    return force, np.array(rows)


def _residual(
    model: Model, block: Block, finer: Finer, values: Values, robust: bool
) -> tuple[Block, float, ColouredNoise]:
    force = finer.force(model, values)
    residual = block.force - force
    if robust:
        block = block._replace(weight=block.weight * huber_weight(residual, block.weight))
    square = float(np.dot(block.weight, residual * residual))
    root, starts = np.sqrt(block.weight), block.signals.starts
    noise = ColouredNoise.of(
        within_records(residual * root, force * root, root, starts), starts, used=root > 0.0
    )
    return block, square, noise


def _sum_up(
    model: Model,
    block: Block,
    finer: Finer,
    values: Values,
    free: Sequence[str],
    noise: ColouredNoise | None,
) -> _Sums:
    force, J = _linearised(model, finer, values, free, wide=True)
    root, starts = np.sqrt(block.weight), block.signals.starts
    rows = np.concatenate([J, [force, np.ones_like(force)]]) * root
    residual = (block.force - force) * root
    normal, score, meat, rough = {}, {}, {}, None
    if noise is not None:
        rest = within_records(residual, rows[-2], root, starts)
        innovations = noise.innovations(rest, starts)
        size = innovation_size(innovations, np.abs(force), root > 0.0, starts)
        coloured = noise.colour(rows, starts)
        p = len(free)
        each = coloured[:p] * innovations
        rough = each @ each.T
        coloured *= size
    for r, (a, b) in enumerate(pairwise(starts.tolist()), start=block.first):
        part = rows[:, a:b]
        normal[r], score[r] = part @ part.T, part @ residual[a:b]
        if noise is not None:
            meat[r] = coloured[:, a:b] @ coloured[:, a:b].T
    return _Sums(normal, score, meat, rough)


def _records(parts: Sequence[_Sums]) -> list[RecordSums]:
    """The sums of each record; where no meat was made, as large as elsewhere for its normal."""
    normal, score, meat, seen = {}, {}, {}, {}
    for part in parts:
        for r, matrix in part.normal.items():
            normal[r] = normal.get(r, 0.0) + matrix
            score[r] = score.get(r, 0.0) + part.score[r]
            if r in part.meat:
                meat[r] = meat.get(r, 0.0) + part.meat[r]
                seen[r] = seen.get(r, 0.0) + matrix
    made, whole = (np.diag(np.sum(list(m.values()), axis=0)) for m in (meat, seen))
    root = np.sqrt(np.where(whole > 0.0, made / np.where(whole > 0.0, whole, 1.0), 0.0))
    return [
        RecordSums(n, score[r], meat.get(r, 0.0) + np.outer(root, root) * (n - seen.get(r, 0.0)))
        for r, n in sorted(normal.items())
    ]


def _flat(normal: Normal, free: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """The parameters along each direction in which the cost does not change."""
    names = np.array(free)
    return tuple(tuple(names[np.abs(along) > 0.1].tolist()) for along in normal.lost.T)


def _roughness(parts: Sequence[_Sums], inverse: Array) -> Array:
    """(p,) factors of the errors by noise, no less than 1, which the innovations found ask for.

    What a model misses in few samples, where a parameter is told from (contacts, jumps, turns), is
    no part of a smooth size of the noise, but stands in the products of rows and innovations
    themselves (White 1980). They scatter more, and decide only where they say more.
    """
    p, found = len(inverse), [part for part in parts if part.rough is not None]
    smooth = np.sum([m[:p, :p] for part in found for m in part.meat.values()], axis=0)
    uneven = np.sum([part.rough for part in found], axis=0)
    a, b = (np.diag(inverse @ m @ inverse) for m in (uneven, smooth))
    return np.sqrt(np.maximum(a / np.where(b > 0.0, b, np.inf), 1.0))
