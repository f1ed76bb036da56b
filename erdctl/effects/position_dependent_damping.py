"""Damping that varies along the stroke.

    F_viscous, F_yield -> max(1 + b_1 x + b_2 x^2, 0) of them

x : (n,) piston stroke [m];  b_1 [1/m], b_2 [1/m^2] : slope and curvature, off at 0
Valid for tapered or eccentric ducts and for bypasses, with the force at x = 0 as reference.
Check: b_1 = 10 /m, b_2 = 100 /m^2, x = 20, -20, 0 mm gives 1.24, 0.84, 1.
Source: J. C. Dixon, The Shock Absorber Handbook, 2nd ed. (2007), position-dependent dampers.
"""

from __future__ import annotations

import numpy as np

from erdctl.effect import Effect, Requirement, Slot, Stage, Values, Variable
from erdctl.quantity import Quantity
from erdctl.recording import Array
from erdctl.signals import Signals


def position_dependent_damping(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the viscous and the yield force, (n,) each [1]."""
    factor = np.maximum(1.0 + (p["b_1"] + p["b_2"] * s.x) * s.x, 0.0)
    return {"viscous": factor, "yield": factor}


EFFECT = Effect(
    name="position_dependent_damping",
    stage=Stage.POSITION,
    slot=Slot.SCALE,
    title="damping varies along the stroke",
    equation="F_viscous, F_yield -> max(1 + b_1 x + b_2 x^2, 0) of them",
    source="Dixon, The Shock Absorber Handbook (2007)",
    validity="the force at x = 0 as reference",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="b_1", unit="1/m", title="slope of the damping over the stroke",
            low=-1e4, high=1e4, start=1.0,
        ),
        Quantity(
            symbol="b_2", unit="1/m^2", title="curvature of the damping over the stroke",
            low=-1e7, high=1e7, start=100.0,
        ),
    ),
    apply=position_dependent_damping,
)  # fmt: skip
