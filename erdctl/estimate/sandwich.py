"""What each record adds to the normal equations, the score and the meat of the sandwich."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import Array
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.finer import Finer
from erdctl.estimate.least_squares import huber_weight
from erdctl.estimate.linearisation import linearised
from erdctl.estimate.noise_size import innovation_size, within_records
from erdctl.estimate.record_scatter import RecordSums
from erdctl.model.composed import Model
from erdctl.model.slots import Values


@dataclass(frozen=True, eq=False)
class Sums:
    """What one block contributes, by number of record; the meat only where it was asked for."""

    normal: dict[int, Array]
    score: dict[int, Array]
    meat: dict[int, Array]
    rough: Array | None


def weighed(
    model: Model, block: Block, finer: Finer, values: Values, *, robust: bool
) -> tuple[Block, float, ColouredNoise]:
    """The block with the weights of a fit at given values, its cost, and the noise in it."""
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


def sum_up(
    model: Model,
    block: Block,
    finer: Finer,
    values: Values,
    free: Sequence[str],
    noise: ColouredNoise | None,
) -> Sums:
    force, J = linearised(model, finer, values, free, wide=True)
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
    return Sums(normal, score, meat, rough)


def by_record(parts: Sequence[Sums]) -> list[RecordSums]:
    """The sums of each record; where no meat was made, as large as elsewhere for its normal."""
    normal: dict[int, Array] = {}
    score: dict[int, Array] = {}
    meat: dict[int, Array] = {}
    seen: dict[int, Array] = {}
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


def roughness(parts: Sequence[Sums], inverse: Array) -> Array:
    """(p,) factors of the errors by noise, no less than 1, which the innovations found ask for.

    What a model misses in few samples, where a parameter is told from (contacts, jumps, turns), is
    no part of a smooth size of the noise, but stands in the products of rows and innovations
    themselves (White 1980). They scatter more, and decide only where they say more.
    """
    p, found = len(inverse), [part for part in parts if part.meat]
    smooth = np.sum([m[:p, :p] for part in found for m in part.meat.values()], axis=0)
    uneven = np.sum([part.rough for part in found if part.rough is not None], axis=0)
    a, b = (np.diag(inverse @ m @ inverse) for m in (uneven, smooth))
    return np.sqrt(np.maximum(a / np.where(b > 0.0, b, np.inf), 1.0))
