"""Pre-yield elasticity: the yield force rebuilds over a distance after every reversal (Bouc-Wen).

    F_ER sign(xdot) -> F_ER z,   x_d dz/d|x| + z = sign(xdot)

sign(xdot), or the law in its place : (n,) [1];  z : (n,) hysteretic variable [1]
x_d : [m] >= 0, off at 0
Valid where chains stretch before they break, and modulus and yield stress follow the field alike:
z is a matter of travel, where a lag is one of time, and a step of the control acts on what is
stretched as on what yields. The Bouc-Wen loop with n = 1 and beta = 0, its height the yield force.
Solved exactly along |x| for an input that is a straight line between samples, or, in a step in
which the piston turns, jumps where it does. A record that begins in motion has the z with which
it comes by that place again, about as fast, or z steady where it never does; in `simulate` and C,
which know the past alone, steady.
Check: x_d = 0.1 mm: 0.1 mm after a reversal z = 1 - 2 exp(-1) = 0.2642.
>>> s = signals([-0.1, 0.0, 0.1], step=2e-3)  # the reversal at the second sample
>>> preyield_elasticity(np.array([-1.0, -1.0, 1.0]), s, {"x_d": 1e-4}).round(4).tolist()
[-1.0, -1.0, 0.2642]

Source: B. F. Spencer, S. J. Dyke, M. K. Sain, J. D. Carlson, Phenomenological model for
magnetorheological dampers, J. Engineering Mechanics 123 (1997) 230-238 (Eqs. 3, 4, and 15 to 18:
the control multiplies z); the same with n = 1 is Dahl's and LuGre's model of a damper: F. Ikhouane,
S. J. Dyke, Smart Mater. Struct. 16 (2007) 1407-1414.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.beginnings import as_before
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Causal, Effect, Requirement, Stage, Variable
from erdctl.model.kernels import follow
from erdctl.model.slots import HysteresisSlot, Values


def preyield_elasticity(sign: Array, s: Signals, p: Values) -> Array:
    """(n,) hysteretic variable z of a sign law (n,) [1]."""
    x_d = p["x_d"]
    if x_d == 0.0:
        return sign
    return as_before(lambda first: _stretched(sign, s, x_d, first), sign[s.starts[:-1]], s, x_d)


def steady_before(sign: Array, s: Signals, p: Values) -> Array:
    """(n,) z of records that all begin with it steady [1]."""
    x_d = p["x_d"]
    return sign if x_d == 0.0 else _stretched(sign, s, x_d, sign[s.starts[:-1]])


def _stretched(sign: Array, s: Signals, x_d: float, first: Array) -> Array:
    """(n,) z of records that begin with first (r,)."""
    path, after = (distance / x_d for distance in s.path)
    i, _ = s.turns
    before = np.maximum(path[i] - after, 0.0)
    return follow(sign, path, i, before, after, first, s.starts)


EFFECT = Effect(
    name="preyield_elasticity",
    stage=Stage.FLUID,
    slot=HysteresisSlot(preyield_elasticity, travel="x_d"),
    title="the yield force rebuilds over a distance after every reversal (Bouc-Wen)",
    equation="F_ER sign(xdot) -> F_ER z, x_d dz/d|x| + z = sign(xdot)",
    said="{x_d} of travel until the yield force is back",
    alters=(("sign", "z"),),
    source="Spencer et al., J. Engineering Mechanics 123 (1997) 230-238, Eqs. 3, 4",
    validity="Bouc-Wen with n = 1 and beta = 0; rate-independent",
    requires=(Requirement.FIELD, Requirement.REVERSALS),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="x_d", unit="m", title="travel over which the yield force rebuilds",
            low=1e-7, high=0.1, start=1e-4, scale=Scale.LOG,
        ),
    ),
    companions=("preyield_viscosity",),
    causal=Causal(slot=HysteresisSlot(steady_before, travel="x_d")),
    c=CLaw(
        state=("z", "past"),
        code="""
        real past = z->past;

        z->past = sign;
        if (!(p->x_d > K(0.0)))
            return sign;
        z->z = s->first ? sign : follow(z->z, past, sign, s->path / p->x_d, s->turned,
                                        FMAX(s->path - s->after, K(0.0)) / p->x_d,
                                        s->after / p->x_d);
        return z->z;
        """,
        note="begins steady; whether the motion comes by its first place again it cannot know",
    ),
)  # fmt: skip
