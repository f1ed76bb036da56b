"""Bi-viscous flow whose pre-yield slope depends on the field in its own way.

    F_ER sign(xdot) -> F_ER tanh(xdot / (v_y v^q))

xdot : (n,) piston speed [m/s];  v : (n,) duty cycle until a sample [1], at least 0.01 here
v_y : speed of yielding at full duty [m/s], v_y >= 0, off at 0 (sign)
q : how it goes with the duty [1]: 0 the same at every field, as preyield_viscosity has it, beta for
a viscosity before yield that no field changes, below 0 for one that rises faster than the yield
force
Valid below and above yield; the viscosity before yield is F_ER / (v_y v^q).
Check: v_y = 40 mm/s, q = 1, duty 0.25: yielding at 10 mm/s, xdot = 5, -20 mm/s gives tanh 0.5 =
0.4621, -tanh 2 = -0.9640 of F_ER.
>>> s = signals([0.005, -0.020], duty=0.25)
>>> preyield_field_dependence(s, {"v_y": 0.04, "q": 1.0}).round(4).tolist()
[0.4621, -0.964]

Source: G. M. Kamath, N. M. Wereley, A nonlinear viscoelastic-plastic model for electrorheological
fluids, Smart Mater. Struct. 6 (1997) 351-359 (pre-yield parameters as functions of the field).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SignSlot, Values

FAINT = 0.01  # duty, below which there is hardly a yield force whose slope could be seen


def preyield_field_dependence(s: Signals, p: Values) -> Array:
    """(n,) in place of sign(xdot) [1]."""
    if p["v_y"] == 0.0:
        return s.sign
    smooth: Array = np.tanh(np.abs(s.xdot) / (p["v_y"] * slower(s, p))) * s.sign
    return smooth


def slower(s: Signals, p: Values) -> Array:
    """(n,) v^q [1], by which the speed of yielding is that at full duty."""
    # The duty of a sample acts from then on: what is measured there is of the one before.
    duty = np.concatenate([s.duty[:1], s.duty[:-1]])
    duty[s.starts[:-1]] = s.duty[s.starts[:-1]]
    return np.asarray(np.maximum(duty, FAINT) ** p["q"])


def speeds(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: yielding at a part of the highest speed, at the highest duty."""
    top, fastest = max(float(s.duty.max()), FAINT), max(float(np.abs(s.xdot).max()), 1e-4)
    return [
        {"v_y": min(part * fastest * top**-q, 10.0), "q": q}
        for part in (0.01, 0.05, 0.25)
        for q in (-0.5, 0.5, 1.0)
    ]


EFFECT = Effect(
    name="preyield_field_dependence",
    stage=Stage.FLUID,
    slot=SignSlot(preyield_field_dependence, by=slower),
    title="bi-viscous flow with a pre-yield slope that depends on the field: tanh(xdot / v_y v^q)",
    equation="F_ER sign(xdot) -> F_ER tanh(xdot / (v_y v^q))",
    said="yielding at {v_y} at full duty, and as v^{q} below",
    alters=(("sign", "tanh(xdot / (v_y v^q))"),),
    source="Kamath and Wereley, Smart Mater. Struct. 6 (1997) 351-359",
    validity="speeds below and above that of yielding at several duty levels",
    requires=(Requirement.FIELD, Requirement.LEVELS, Requirement.REVERSALS),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="v_y", unit="m/s", title="speed of yielding at full duty",
            low=1e-6, high=10.0, start=0.05, scale=Scale.LOG,
        ),
        Quantity(
            symbol="q", unit="1", title="exponent of the duty",
            low=-3.0, high=3.0, start=0.5,
        ),
    ),
    guesses=speeds,
    c=CLaw(
        code="""
        /* s->duty0 acted until this sample, and below 0.01 there is hardly a yield force. */
        if (!(p->v_y > K(0.0)))
            return s->sign;
        return TANH(FABS(s->xdot) / (p->v_y * POW(FMAX(s->duty0, K(0.01)), p->q))) * s->sign;
        """,
        by="return POW(FMAX(s->duty0, K(0.01)), p->q);",
    ),
)  # fmt: skip
