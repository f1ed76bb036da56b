"""Whether the force of a model follows its parameters, or jumps with them.

Behind a spring a piston whose friction falls with speed, faster than the other forces rise, sticks
and slips: a change of any parameter by a millionth puts a slip a sample earlier, and by a
thousandth each of them elsewhere. A slope, and so an error, is then that of the step over which it
was taken; and a fit in the log's own steps ends where no finer simulation does. What such a fit
finds is what simulates best, and no measure of the damper. (Found on a friction damper whose
kinetic friction was told to 0.02 %, on 10 % of a misfit.)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.blocks import Block
from erdctl.estimate.finer import Finer
from erdctl.estimate.linearisation import LEAST
from erdctl.model.composed import Model
from erdctl.model.slots import SeriesSlot, Values

NEAR, FAR = 1e-3, 1e-2  # of a value: two steps, over which a slope is one where there is a slope
APART = 2.0  # ratio of the two slopes' sizes, or its inverse, beyond which there is none
# Part of the samples that may jump: a turn or a contact that passes to the next one is no slip.
SINGLE = 0.01
FELT = 1e-6  # of the force, a change by the farther step below which nothing is told
REASON = (
    "the simulated piston sticks and slips behind the spring, so that the force jumps as this"
    " changes: what fits best is no measure of it"
)


def slips(
    model: Model,
    blocks: Sequence[Block],
    finer: Sequence[Finer],
    values: Values,
    free: Sequence[str],
) -> bool:
    """Whether the force jumps with some of the free parameters that it is smooth in by its law.

    These are the paper's and the sizes of effects; a play or a delay, with which contacts and steps
    pass from sample to sample on any log, have intervals by profile.
    """
    if not model.of(SeriesSlot):
        return False
    smooth = set(model.linear)
    return any(_jumps(model, blocks, finer, values, name) for name in free if name in smooth)


def _jumps(
    model: Model, blocks: Sequence[Block], finer: Sequence[Finer], values: Values, name: str
) -> bool:
    q, value = model.quantities[name], values[name]
    size = max(abs(value), 0.1 * max(abs(q.start), LEAST))
    sizes, felt = [], 0.0
    for part in (NEAR, FAR):
        low, high = max(value - part * size, q.low), min(value + part * size, q.high)
        squares, whole = [], 0.0
        for block, signals in zip(blocks, finer, strict=True):
            ends = [signals.force(model, {**values, name: v}) for v in (low, high)]
            squares.append(block.weight * (ends[1] - ends[0]) ** 2)
            whole += float(np.dot(block.weight, ends[0] ** 2))
        each = np.sort(np.concatenate(squares))
        square = float(each[: len(each) - round(SINGLE * len(each))].sum())
        sizes.append(np.sqrt(square) / (high - low))
        felt = np.sqrt(square / max(whole, 1e-300))
    if felt < FELT:
        return False
    near, far = sizes
    return not far / APART < near < APART * far
