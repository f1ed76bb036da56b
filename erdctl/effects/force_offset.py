"""Zero error of the force channel.

    F_rec = F + F_z

F, F_rec : (n,) force of the damper, and as recorded [N];  F_z : zero error [N], of either sign, off
at 0
Valid for a zero that was set wrongly once and stays. On force data alone it is the same as
gas_preload, the static force of the gas, which pushes outwards: above 0 it can be either, below 0
no gas does it. A zero set anew before each record is no matter of the damper or of one number, but
of each record.
Check: F_z = -0.5 N, F = 3, -3 N gives 2.5, -3.5 N.
>>> s, F = signals([0.1, -0.1]), np.array([3.0, -3.0])
>>> (F - 0.5 * force_offset(s, {})[0]).tolist()
[2.5, -3.5]

Source: VDI/VDE/DKD 2638, Characteristics for force transducers (2008), zero signal.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def force_offset(s: Signals, p: Values) -> Array:
    """(1, n) force for F_z = 1 N [1]."""
    return np.ones((1, len(s)))


EFFECT = Effect(
    name="force_offset",
    stage=Stage.SENSOR,
    slot=TermSlot(),
    title="constant zero error of the force channel",
    equation="F = F_z",
    said="{F_z} of zero error",
    source="VDI/VDE/DKD 2638 (2008)",
    validity="on force data alone the same as gas_preload, which cannot be below 0",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="F_z", unit="N", title="zero error",
            low=-1e9, high=1e9, start=1.0, linear=True,
        ),
    ),
    columns=force_offset,
    equivalents=("gas_preload",),
)  # fmt: skip
