"""Turbulent loss in ducts and orifices.

    F = c_2 xdot |xdot|

xdot : (n,) piston speed [m/s];  c_2 : [N s^2/m^2], c_2 >= 0, off at 0
Valid for flow well above the laminar one, and for losses at the ends of a duct.
Check: c_2 = 200 N s^2/m^2, xdot = 0.1, -0.3 m/s gives 2, -18 N.
>>> (200.0 * quadratic_damping(signals([0.1, -0.3]), {})[0]).round(9).tolist()
[2.0, -18.0]

Source: J. C. Dixon, The Shock Absorber Handbook, 2nd ed. (2007), orifice flow.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def quadratic_damping(s: Signals, p: Values) -> Array:
    """(1, n) force for c_2 = 1 N s^2/m^2 [m^2/s^2]."""
    return np.array([s.xdot * np.abs(s.xdot)])


EFFECT = Effect(
    name="quadratic_damping",
    stage=Stage.FLUID,
    slot=TermSlot(),
    title="turbulent loss",
    equation="F = c_2 xdot |xdot|",
    said="{c_2} of turbulent loss",
    source="Dixon, The Shock Absorber Handbook (2007)",
    validity="turbulent flow, or losses at the ends of a duct",
    requires=(Requirement.SPEEDS,),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="c_2", unit="N s^2/m^2", title="loss coefficient",
            low=0.0, high=1e12, start=100.0, linear=True,
        ),
    ),
    columns=quadratic_damping,
    of_speed=True,
    c=CLaw(
        force="return p->c_2 * s->xdot * FABS(s->xdot);",
    ),
)  # fmt: skip
