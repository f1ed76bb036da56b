"""The yield force that a log shows at each PWM level, Eq. 17, to hold a law against (Fig. 10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.core.blocks import SETTLE, whole
from erdctl.core.recording import Array, Recording
from erdctl.model.parameters import Parameters
from erdctl.score.nrmse import duty_levels

FEWEST = 10  # samples that make a point


@dataclass(frozen=True, eq=False)
class YieldPoints:
    """The yield force of one direction by PWM level.

    duty : (k,) [1];  force, spread : (k,) mean and standard deviation [N];  samples : (k,)
    """

    duty: Array
    force: Array
    spread: Array
    samples: Array


def yield_points(recording: Recording, parameters: Parameters) -> tuple[YieldPoints, YieldPoints]:
    """What is left of the measured force, times the direction of motion, in either direction.

        F_YS = (F - k_nom x - c_vis xdot) sign(xdot)                                 (17)

    with whatever else the model holds but the yield force also taken away; over samples whose duty
    has been constant for SETTLE, and levels above zero.
    """
    block = whole(recording)
    s = block.signals
    parts = parameters.model.parts(s, parameters.values)
    rest = block.force - sum(
        (force for name, force in parts.items() if name != "yield"), start=np.zeros(len(s))
    )
    codes, levels = duty_levels(recording.duty)
    settled = (s.since_duty_step > SETTLE) & (block.weight > 0) & (s.duty > 0)
    out = []
    for way in (1.0, -1.0):
        at = np.flatnonzero(settled & (s.xdot * way > 0))
        which, force = codes[at], rest[at] * way
        count = np.bincount(which, minlength=len(levels))
        n = np.maximum(count, 1)
        mean = np.bincount(which, force, len(levels)) / n
        square = np.bincount(which, (force - mean[which]) ** 2, len(levels)) / n
        enough = count >= FEWEST
        out.append(
            YieldPoints(
                levels[enough],
                mean[enough],
                np.sqrt(square[enough]),
                count[enough].astype(np.float64),
            )
        )
    return out[0], out[1]
