"""Time constant that differs between rising and falling yield force.

    T dF_ER/dt + F_ER = u,   T = T_d while |u| >= |F_ER|,   T = r T_d while |u| < |F_ER|

r : ratio [1], r > 0, off at 1
Valid where one ratio holds for both directions of motion.
Chains form at one rate and dissolve at another, whatever makes the yield force rise or fall: a step
of the duty, or a reversal towards the direction with the smaller steady force.
Check: r = 2, T_d = 43 ms: 86 ms after a step from 0.3 to 0, F_ER has fallen to exp(-1) = 0.3679.
>>> s = signals([0.1, 0.1, 0.1], duty=[0.3, 0.0, 0.0], step=0.086)
>>> force = force_with(EFFECT, s, {"r": 2.0}, sigma=1.0, T_d=0.043)
>>> (force / force[1]).round(4).tolist()
[1.0, 1.0, 0.3679]

Source: J.-H. Koo, F. D. Goncalves, M. Ahmadian, A comprehensive analysis of the response time of MR
dampers, Smart Mater. Struct. 15 (2006) 351-358.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import LagSlot, Values


def rise_decay_asymmetry(s: Signals, p: Values) -> Array:
    """(n,) factor of T_d while the yield force falls [1]."""
    return np.full(len(s), p["r"])


EFFECT = Effect(
    name="rise_decay_asymmetry",
    stage=Stage.FIELD,
    slot=LagSlot(rise_decay_asymmetry),
    title="T_d differs between rising and falling yield force",
    equation="T_d -> r T_d while |F_ER| > |u|",
    said="decay slower than rise by a factor of {r}",
    source="Koo, Goncalves and Ahmadian, Smart Mater. Struct. 15 (2006) 351-358",
    validity="one ratio for both directions of motion",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="r", unit="1", title="time constant of decay over that of rise",
            low=0.02, high=50.0, start=2.0, off=1.0, scale=Scale.LOG,
        ),
    ),
    c=CLaw(
        code="return p->r;",
    ),
)  # fmt: skip
