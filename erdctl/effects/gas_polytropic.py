"""Pressure of the enclosed gas, in place of the linear spring of Eq. 14.

    k_nom x -> F_0 + k_nom ((1 - a x)^-gamma - 1) / (gamma a),   a = A_s / V_0

x : (n,) stroke [m];  a : area of the rod over the volume of the gas [1/m], a >= 0, off at 0
gamma : polytropic exponent [1], 1 (slow) to 1.67 (fast, monatomic)
F_0 = P_0 A_s : preload [N], F_0 >= 0, off at 0;  k_nom is the stiffness at x = 0, F_0 gamma a in
Eq. 3
Valid while gas is left: from a x = 0.95 on, the tangent goes on.
Check: a = 10 /m, gamma = 1, x = 50 mm: (1 / 0.5 - 1) / 10 = 0.1 m, twice x; x = -100 mm:
(1 / 2 - 1) / 10 = -0.05 m.
>>> s = signals([0.0, 0.0], x=[0.05, -0.1])
>>> gas_polytropic(s, {"a": 10.0, "gamma": 1.0}).round(9).tolist()
[0.1, -0.05]

Source: the ER damper paper, Eq. 3.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import GasSlot, Values

FULL = 0.95  # of the gas volume displaced; no damper is built to go beyond


def gas_polytropic(s: Signals, p: Values) -> Array:
    """(n,) in place of x [m]."""
    a, gamma = p["a"], p["gamma"]
    if a == 0.0:
        return s.x
    part = np.minimum(a * s.x, FULL)
    beyond = (a * s.x - part) * (1.0 - FULL) ** (-gamma - 1.0)
    # expm1 and log1p keep the digits that 1 - a x loses as a goes to 0.
    law: Array = (np.expm1(-gamma * np.log1p(-part)) / gamma + beyond) / a
    return law


def preload(s: Signals, p: Values) -> Array:
    """(1, n) force for F_0 = 1 N [1]."""
    return np.ones((1, len(s)))


EFFECT = Effect(
    name="gas_polytropic",
    stage=Stage.GAS,
    slot=GasSlot(gas_polytropic),
    title="Eq. 3 in place of the linear spring of Eq. 14",
    equation="k_nom x -> F_0 + k_nom ((1 - a x)^-gamma - 1) / (gamma a), a = A_s / V_0",
    said="gas of {a} of rod area over volume, preloaded by {F_0}",
    alters=(("gas", "F_0 + k_nom ((1 - a x)^-gamma - 1) / (gamma a)"),),
    source="the ER damper paper, Eq. 3",
    validity="a x < 0.95, the gas at one temperature or without exchange of heat",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    includes=("gas_preload",),
    quantities=(
        Quantity(
            symbol="F_0", unit="N", title="preload P_0 A_s",
            low=0.0, high=1e9, start=1.0, linear=True,
        ),
        Quantity(
            symbol="a", unit="1/m", title="rod area over gas volume, A_s / V_0",
            low=1e-2, high=1e3, start=5.0, scale=Scale.LOG,
        ),
        Quantity(
            symbol="gamma", unit="1", title="polytropic exponent",
            low=1.0, high=1.67, start=1.4, off=1.4,
        ),
    ),
    columns=preload,
    c=CLaw(
        code="""
        const real full = K(0.95);  /* of the gas volume; from there on the tangent goes on */
        real part, beyond;

        if (!(p->a > K(0.0)))
            return s->x;
        part = FMIN(p->a * s->x, full);
        beyond = (p->a * s->x - part) * POW(K(1.0) - full, -p->gamma - K(1.0));
        return (EXPM1(-p->gamma * LOG1P(-part)) / p->gamma + beyond) / p->a;
        """,
        force="return p->F_0;",
    ),
)  # fmt: skip
