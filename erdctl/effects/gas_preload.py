"""Constant force of the gas at mid-stroke, which Eq. 14 leaves out.

    F = F_0 = P_0 A_s

F_0 : [N], F_0 >= 0, off at 0;  P_0 : filling pressure [Pa];  A_s : area of the rod [m^2]
Valid at any stroke. On force data alone it is the same as a force_offset, a zero error of the force
channel: above 0 it has the name by convention, as every damper with a gas chamber has a preload;
below 0 it must be that, as gas does not pull.
Check: P_0 = 500 kPa, A_s = 50 mm^2 = 5e-5 m^2 gives 25 N at every stroke.
>>> s = signals([0.0, 0.0], x=[-0.01, 0.01])
>>> (500e3 * 5e-5 * gas_preload(s, {})[0]).round(9).tolist()
[25.0, 25.0]

Source: the ER damper paper, Eq. 3 at x = 0, in Eq. 4.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def gas_preload(s: Signals, p: Values) -> Array:
    """(1, n) force for F_0 = 1 N [1]."""
    return np.ones((1, len(s)))


EFFECT = Effect(
    name="gas_preload",
    stage=Stage.GAS,
    slot=TermSlot(),
    title="constant static gas force",
    equation="F = F_0",
    said="{F_0} of static force",
    source="the ER damper paper, Eqs. 3 and 4",
    validity="on force data alone the same as force_offset, a zero error of the channel",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="F_0", unit="N", title="static force",
            low=0.0, high=1e9, start=1.0, linear=True, read_low=-1e9,
        ),
    ),
    columns=gas_preload,
    equivalents=("force_offset",),
    c=CLaw(
        force="return p->F_0;",
    ),
)  # fmt: skip
