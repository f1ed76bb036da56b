"""Viscous force that grows less than in proportion to speed.

    c_vis xdot -> c_vis v_0 |xdot / v_0|^n sign(xdot),   v_0 = 0.1 m/s

xdot : (n,) piston speed [m/s];  n : flow index [1], 0 < n <= 1, off at 1
c_vis then is the viscosity at v_0. The Herschel-Bulkley law, with the yield force of Eq. 11.
Valid for shear rates of one or two decades; near rest the yield force covers the steep start.
Check: n = 0.5, xdot = 0.1, -0.4, 0 m/s gives 0.1, -0.1 sqrt(4) = -0.2, 0 m/s.
>>> shear_thinning(signals([0.1, -0.4, 0.0]), {"n": 0.5}).round(9).tolist()
[0.1, -0.2, 0.0]

Source: X. Wang, F. Gordaninejad, Flow analysis of field-controllable, electro- and magneto-
rheological fluids using Herschel-Bulkley model, J. Intell. Mater. Syst. Struct. 10 (1999) 601-608.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import Values, ViscousSlot

V_0 = 0.1  # m/s, the speed at which c_vis keeps its meaning


def shear_thinning(s: Signals, p: Values) -> Array:
    """(n,) in place of xdot [m/s]."""
    if p["n"] == 1.0:
        return s.xdot
    law: Array = np.copysign(V_0 * np.power(np.abs(s.xdot) / V_0, p["n"]), s.xdot)
    return law


EFFECT = Effect(
    name="shear_thinning",
    stage=Stage.FLUID,
    slot=ViscousSlot(shear_thinning),
    title="viscous force C |xdot|^n sign(xdot), n < 1",
    equation="c_vis xdot -> c_vis v_0 |xdot / v_0|^n sign(xdot), v_0 = 0.1 m/s",
    said="viscous force with a flow index of {n}",
    alters=(("viscous", "c_vis v_0 |xdot / v_0|^n sign(xdot)"),),
    source="Wang and Gordaninejad, J. Intell. Mater. Syst. Struct. 10 (1999) 601-608",
    validity="one or two decades of speed",
    requires=(Requirement.SPEEDS,),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="n", unit="1", title="flow index",
            low=0.05, high=1.0, start=0.7, off=1.0,
        ),
    ),
    of_speed=True,
    c=CLaw(
        code="""
        const real v_0 = K(0.1);  /* m/s, the speed at which c_vis keeps its meaning */

        if (p->n >= K(1.0))
            return s->xdot;
        return COPYSIGN(v_0 * POW(FABS(s->xdot) / v_0, p->n), s->xdot);
        """,
    ),
)  # fmt: skip
