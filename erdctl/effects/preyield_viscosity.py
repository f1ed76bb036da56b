"""Bi-viscous flow: below a speed of yielding the fluid is very viscous, not rigid.

    F_ER sign(xdot) -> F_ER tanh(xdot / v_y)

xdot : (n,) piston speed [m/s];  v_y : speed of yielding [m/s], v_y >= 0, off at 0 (sign)
Valid below and above yield; the viscosity before yield is F_ER / v_y.
Check: v_y = 10 mm/s, xdot = 5, -20, 0 mm/s gives tanh 0.5 = 0.4621, -tanh 2 = -0.9640, 0 of F_ER.
>>> s = signals([0.005, -0.020, 0.0])
>>> preyield_viscosity(s, {"v_y": 0.01}).round(4).tolist()
[0.4621, -0.964, 0.0]

Source: R. Stanway, J. L. Sproston, A. K. El-Wahed, Applications of electro-rheological fluids in
vibration control: a survey, Smart Mater. Struct. 5 (1996) 464-482.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SignSlot, Values


def preyield_viscosity(s: Signals, p: Values) -> Array:
    """(n,) in place of sign(xdot) [1]."""
    if p["v_y"] == 0.0:
        return s.sign
    smooth: Array = np.tanh(np.abs(s.xdot) / p["v_y"]) * s.sign
    return smooth


EFFECT = Effect(
    name="preyield_viscosity",
    stage=Stage.FLUID,
    slot=SignSlot(preyield_viscosity),
    title="bi-viscous flow: tanh(xdot / v_y) in place of sign(xdot)",
    equation="F_ER sign(xdot) -> F_ER tanh(xdot / v_y)",
    said="yielding at {v_y}",
    alters=(("sign", "tanh(xdot / v_y)"),),
    source="Stanway, Sproston and El-Wahed, Smart Mater. Struct. 5 (1996) 464-482",
    validity="speeds below and above v_y",
    requires=(Requirement.FIELD, Requirement.REVERSALS),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="v_y", unit="m/s", title="speed of yielding",
            low=1e-6, high=10.0, start=0.01, scale=Scale.LOG,
        ),
    ),
    companions=("mount_compliance",),
    of_speed=True,
    c=CLaw(
        code="""
        if (!(p->v_y > K(0.0)))
            return s->sign;
        return TANH(FABS(s->xdot) / p->v_y) * s->sign;
        """,
    ),
)  # fmt: skip
