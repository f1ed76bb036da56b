"""Loop of the yield force over speed, after Guo.

    F_ER sign(xdot) -> F_ER tanh((xdot + kappa x) / v_y)

which is Guo's tanh(k_1 x + c_1 xdot) with c_1 = 1 / v_y and k_1 = kappa / v_y.
xdot, x : (n,) piston speed [m/s] and stroke about the centre of the motion [m]
v_y : speed of yielding [m/s], v_y >= 0, off at 0;  kappa : slope of the line x over xdot on which
the force changes sign [1/s], kappa >= 0 (the force outlasts the motion), off at 0
Valid for steady cycles about x = 0: the loop is tied to the stroke, not to the last reversal.
Check: v_y = 10 mm/s, kappa = 2 /s: at rest at x = 5 mm tanh(10 / 10) = 0.7616 of F_ER; at
xdot = -10 mm/s and x = 5 mm 0.
>>> s = signals([0.0, -0.010], x=[0.005, 0.005])
>>> yield_hysteresis(s, {"v_y": 0.010, "kappa": 2.0}).round(4).tolist()
[0.7616, 0.0]

Source: S. Guo, S. Yang, C. Pan, Dynamic modeling of magnetorheological damper behaviors, J. Intell.
Mater. Syst. Struct. 17 (2006) 3-14.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SignSlot, Values


def yield_hysteresis(s: Signals, p: Values) -> Array:
    """(n,) in place of sign(xdot) [1]."""
    if p["v_y"] == 0.0 and p["kappa"] == 0.0:
        return s.sign
    shifted = s.xdot + p["kappa"] * s.x
    law: Array = np.tanh(shifted / p["v_y"]) if p["v_y"] > 0.0 else np.sign(shifted)
    return law


EFFECT = Effect(
    name="yield_hysteresis",
    stage=Stage.FLUID,
    slot=SignSlot(yield_hysteresis, lead="kappa"),
    title="loop of the yield force: tanh(k_1 x + c_1 xdot), c_1 = 1 / v_y, k_1 = kappa / v_y",
    equation="F_ER sign(xdot) -> F_ER tanh((xdot + kappa x) / v_y)",
    said="yielding at {v_y}, with a loop {kappa} wide",
    alters=(("sign", "tanh((xdot + kappa x) / v_y)"),),
    source="Guo, Yang and Pan, J. Intell. Mater. Syst. Struct. 17 (2006) 3-14",
    validity="cycles about x = 0",
    requires=(Requirement.FIELD, Requirement.REVERSALS, Requirement.STROKE),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="v_y", unit="m/s", title="speed of yielding, 1 / c_1",
            low=1e-6, high=10.0, start=0.01, scale=Scale.LOG,
        ),
        Quantity(
            symbol="kappa", unit="1/s", title="width of the loop over the stroke, k_1 / c_1",
            low=0.0, high=1e4, start=1.0,
        ),
    ),
    c=CLaw(
        code="""
        real shifted = s->xdot + p->kappa * s->x;

        if (!(p->v_y > K(0.0)) && !(p->kappa > K(0.0)))
            return s->sign;
        if (p->v_y > K(0.0))
            return TANH(shifted / p->v_y);
        return shifted > K(0.0) ? K(1.0) : shifted < K(0.0) ? K(-1.0) : K(0.0);
        """,
    ),
)  # fmt: skip
