"""Time constant that differs between rising and falling field.

    T_d -> r T_d after a downward step of the duty, T_d after an upward one

r : ratio [1], r > 0, off at 1;  before the first step of a record it counts as rising
Valid for a duty logged as commanded, held between its steps: noise on it would count as steps.
Check: r = 2, T_d = 43 ms: 86 ms after a step from 0.3 to 0, F_ER has fallen to exp(-1) = 0.3679.
Source: J.-H. Koo, F. D. Goncalves, M. Ahmadian, A comprehensive analysis of the response time of MR
dampers, Smart Mater. Struct. 15 (2006) 351-358.
"""

from __future__ import annotations

import numpy as np

from erdctl.effect import Effect, Requirement, Slot, Stage, Values, Variable
from erdctl.quantity import Quantity, Scale
from erdctl.recording import Array
from erdctl.signals import Signals


def rise_decay_asymmetry(s: Signals, p: Values) -> Array:
    """(n,) factor of T_d [1]."""
    change = np.diff(s.duty, prepend=s.duty[:1])
    change[s.starts[:-1]] = 0.0
    mark = np.where(change != 0.0, np.arange(len(s)), 0)
    mark[s.starts[:-1]] = s.starts[:-1]
    falling = change[np.maximum.accumulate(mark)] < 0.0
    return np.where(falling, p["r"], 1.0)


EFFECT = Effect(
    name="rise_decay_asymmetry",
    stage=Stage.FIELD,
    slot=Slot.LAG,
    title="T_d differs between rising and falling field",
    equation="T_d -> r T_d while the field decays",
    source="Koo, Goncalves and Ahmadian, Smart Mater. Struct. 15 (2006) 351-358",
    validity="a duty that is logged as commanded and held between its steps",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="r", unit="1", title="time constant of decay over that of rise",
            low=0.02, high=50.0, start=2.0, off=1.0, scale=Scale.LOG,
        ),
    ),
    apply=rise_decay_asymmetry,
)  # fmt: skip
