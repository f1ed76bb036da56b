"""The last step of a fit, over all data, and the errors that hold for what it leaves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.progress import Progress
from erdctl.core.recording import Array
from erdctl.estimate import jumps, own_levels
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.covariance import Fit
from erdctl.estimate.finer import Finer
from erdctl.estimate.flat import flat_groups
from erdctl.estimate.intervals import with_intervals
from erdctl.estimate.normal_equations import Normal
from erdctl.estimate.own_levels import OwnLevels
from erdctl.estimate.record_scatter import covariance
from erdctl.estimate.sandwich import by_record, roughness, sum_up, weighed
from erdctl.model.composed import Model
from erdctl.model.slots import MotionSlot, Values

STEPS = 8  # of Gauss-Newton in a model with effects, from a fit in the log's own steps
SHORTER = (1.0, 0.5, 0.25, 0.125)  # of a step, where all of it goes too far
SETTLED = 1e-5  # part of the cost that a step must gain for another
COLOURED = 16  # blocks on which the effect of coloured noise is measured


def assess(
    model: Model,
    blocks: Sequence[Block],
    values: Values,
    *,
    fixed: Iterable[str] = (),
    bounded: Iterable[str] = (),
    evaluations: int = 0,
    converged: bool = True,
    robust: bool = False,
    levels: OwnLevels | None = None,
    threads: int = 2,
    progress: Progress = lambda stage, what: None,
) -> Fit:
    """One Gauss-Newton step over all data from a good start, then errors of the estimates.

    fixed : parameters that keep their value;  bounded : the same, as they lie at a bound, so that
        one side is left to say something of
    levels : what each record has of its own, which the blocks are already without
    threads : at a time, each with some of the blocks, or of the profiles
    progress : called with the parameter whose interval is looked for

    The start may come from a part of the data: one step from there is as good as the full search
    to the order of the standard errors (one-step estimator, Le Cam). The covariance is the
    sandwich (J'J)^-1 (J' C J) (J'J)^-1. C is that of an autoregressive model of the residual whose
    innovations grow as those found do with the force and from record to record, so that neither
    correlated nor uneven residuals make errors look small; to it comes what scatters from record to
    record (`erdctl.estimate.record_scatter`).
    """
    ends = tuple(bounded)
    held = {*fixed, *ends}
    free = tuple(n for n in model.quantities if n not in held)
    p, has_effects = len(free), bool(model.effects)
    # The paper's model alone is exact but for turns, and its logs may be long.
    between = has_effects and not any(slot.of_samples for _, slot in model.of(MotionSlot))
    finer = [Finer.of(b.signals) if between else Finer.none(b.signals) for b in blocks]
    with ThreadPoolExecutor(threads) as pool:

        def residuals(at: Values) -> tuple[list[Block], float, ColouredNoise]:
            """The blocks with robust weights, their weighted square, and the noise in them."""
            found = list(
                pool.map(
                    lambda b, f: weighed(model, b, f, at, robust=robust),
                    blocks, finer,
                )
            )  # fmt: skip
            noise = ColouredNoise.pooled([n for _, _, n in found])
            return [b for b, _, _ in found], sum(s for _, s, _ in found), noise

        weighted, before, noise = residuals(values)
        # Colouring is the dearest part, and a share of a long log gives the noise's effect as well.
        every = -(-len(weighted) // COLOURED)
        for _ in range(STEPS if has_effects else 1):
            colours = [noise if i % every == 0 else None for i in range(len(weighted))]
            parts = list(
                pool.map(
                    lambda b, f, c, at=values: sum_up(model, b, f, at, free, c),
                    weighted, finer, colours,
                )
            )  # fmt: skip
            records = by_record(parts)
            normal = Normal.of(np.sum([r.normal for r in records], axis=0)[:p, :p])
            inverse = normal.pseudo_inverse()
            step = inverse @ np.sum([r.score for r in records], axis=0)[:p]
            for part in SHORTER:
                moved = _moved(model, values, free, part * step)
                again, after, noise_after = residuals(moved)
                if after <= before:
                    break
            else:
                break
            values, weighted, noise = moved, again, noise_after
            gained, before = before - after, after
            if gained <= SETTLED * after:
                break
    after = before
    samples = sum(int(np.count_nonzero(b.weight)) for b in blocks)
    rough = roughness(parts, inverse)
    if levels is None:
        errors, own = covariance(records, inverse, rough), None
    else:
        errors, own = own_levels.covariance(records, levels, rough)
    # What is at a bound may go back from it where others make up for it.
    wide = normal
    if ends:
        sums = [
            sum_up(model, b, f, values, (*free, *ends), None)
            for b, f in zip(weighted, finer, strict=True)
        ]
        count = p + len(ends)
        whole = np.sum([n for s in sums for n in s.normal.values()], axis=0)
        wide = Normal.of(whole[:count, :count])
    rms = float(np.sqrt(after / max(samples - len(free), 1)))
    squares = np.diag(np.sum([r.normal for r in records], axis=0))[:p]
    alone = rms / np.sqrt(np.where(squares > 0.0, squares, np.nan))
    known = dict(zip(free, np.sqrt(np.maximum(np.diag(errors), 0.0)).tolist(), strict=True))
    found = Fit(
        model=model,
        values=dict(values),
        free=free,
        covariance=errors,
        level_errors=own,
        rms=rms,
        noise=noise,
        samples=samples,
        evaluations=evaluations,
        converged=converged,
        alone=dict(zip(free, np.nan_to_num(alone, nan=np.inf).tolist(), strict=True)),
        flat=flat_groups(model, wide, (*free, *ends), values, known),
        jumps=jumps.REASON if jumps.slips(model, blocks, finer, values, free) else None,
    )
    if not has_effects or found.jumps is not None:
        return found
    plain = np.diag(inverse) * rough**2
    return with_intervals(found, blocks, finer, plain, ends, held, progress, threads)


def _moved(model: Model, values: Values, free: Sequence[str], step: Array) -> dict[str, float]:
    out = dict(values)
    for name, move in zip(free, step.tolist(), strict=True):
        q = model.quantities[name]
        out[name] = float(np.clip(values[name] + move, q.low, q.high))
    return out
