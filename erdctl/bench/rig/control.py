"""A duty that was read back with noise, held against levels that it could hold."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.held_duty import held_duty
from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece
from erdctl.core.messages import counted


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Noise of the duty, which would count as a step of the control at every sample.

    The yield force follows a power of the duty below one, so that a thousandth of it is a tenth of
    the force at full field for some dampers: noise about zero is a field that was not there.
    """
    if not found:
        return []
    starts = np.cumsum([0, *(len(p) for p in found)])
    held = held_duty(np.concatenate([p.of("duty") for p in found]), starts)
    if held is None:
        return []
    return [
        RigFault(
            "duty_noise",
            None,
            f"the duty has noise of {held.noise:.2g} rms about levels that it holds:"
            f" {counted(held.before, 'step')} of it in place of {held.after}",
            "fits take the levels; log the command, or write them in its place",
        )
    ]
