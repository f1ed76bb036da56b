"""No yield stress below a critical duty.

    F_ER -> sigma max(v - v_c, 0)^beta

v : (n,) duty cycle [1];  v_c : critical duty [1], 0 <= v_c < 1, off at 0
Valid for fluids whose particles need a critical field to form chains, and for amplifiers that
give no voltage at small duty.
Check: v_c = 0.05, beta = 0.5, v = 0.03, 0.05, 0.30 gives 0, 0, 0.5 of sigma.
>>> s = signals([0.1, 0.1, 0.1], duty=[0.03, 0.05, 0.30])
>>> (field_threshold(s, {"v_c": 0.05}) ** 0.5).round(4).tolist()
[0.0, 0.0, 0.5]

Source: H. Block, J. P. Kelly, Electro-rheology, J. Phys. D 21 (1988) 1661-1677 (threshold field).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ControlSlot, Values


def field_threshold(s: Signals, p: Values) -> Array:
    """(n,) duty beyond the threshold [1]."""
    excess: Array = np.maximum(s.duty - p["v_c"], 0.0)
    return excess


EFFECT = Effect(
    name="field_threshold",
    stage=Stage.FIELD,
    slot=ControlSlot(field_threshold),
    title="no yield stress below a critical duty",
    equation="F_ER -> sigma max(v - v_c, 0)^beta",
    said="no yield below {v_c:%} of duty",
    alters=(("v", "max(v - v_c, 0)"),),
    source="Block and Kelly, J. Phys. D 21 (1988) 1661-1677",
    validity="levels on both sides of v_c, or at least three above it",
    requires=(Requirement.FIELD, Requirement.LEVELS),
    shows=Variable.DUTY,
    quantities=(
        Quantity(
            symbol="v_c", unit="1", title="critical duty",
            low=0.0, high=0.95, start=0.05,
        ),
    ),
    order=20,  # the fluid comes after the amplifier
    c=CLaw(
        code="return FMAX(duty - p->v_c, K(0.0));",
    ),
)  # fmt: skip
