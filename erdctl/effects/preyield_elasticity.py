"""Pre-yield elasticity: the yield force rebuilds over a distance after every reversal (Bouc-Wen).

    x_d dF_y/d|x| + F_y = F_ER sign(xdot)

F_ER : (n,) yield force of Eq. 12 [N];  F_y : (n,) what acts [N];  x_d : [m] >= 0, off at 0
Valid where chains stretch before they break, so that F_y is a matter of travel, where a lag is one
of time: the Bouc-Wen loop with n = 1 and beta = 0, its height the yield force. Solved exactly
along |x| for an input that is a straight line between samples, or, in a step in which the piston
turns, jumps where it does. A record begins with F_y steady.
Check: F_ER = 10 N, x_d = 0.1 mm: 0.1 mm after a reversal F_y = 10 - 20 exp(-1) = 2.6424 N.
>>> s = signals([-0.1, 0.0, 0.1], step=2e-3)  # the reversal at the second sample
>>> preyield_elasticity(np.array([-10.0, -10.0, 10.0]), s, {"x_d": 1e-4}).round(4).tolist()
[-10.0, -10.0, 2.6424]

Source: B. F. Spencer, S. J. Dyke, M. K. Sain, J. D. Carlson, Phenomenological model for
magnetorheological dampers, J. Engineering Mechanics 123 (1997) 230-238 (Eqs. 3, 4).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.kernels import follow
from erdctl.model.slots import Values, YieldSlot


def preyield_elasticity(force: Array, s: Signals, p: Values) -> Array:
    """(n,) yield force that has rebuilt over the travel, in the unit of the signed yield force."""
    x_d = p["x_d"]
    if x_d == 0.0:
        return force
    path, after = (distance / x_d for distance in s.path)
    i, _ = s.turns
    before = np.maximum(path[i] - after, 0.0)
    return follow(force, path, i, before, after, force[s.starts[:-1]], s.starts)


EFFECT = Effect(
    name="preyield_elasticity",
    stage=Stage.FLUID,
    slot=YieldSlot(preyield_elasticity, travel="x_d"),
    title="the yield force rebuilds over a distance after every reversal (Bouc-Wen)",
    equation="x_d dF_y/d|x| + F_y = F_ER sign(xdot)",
    said="{x_d} of travel until the yield force is back",
    alters=(("yield", "F_y"),),
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
    c=CLaw(
        state=("force", "past"),
        code="""
        real past = z->past;

        z->past = force;
        if (!(p->x_d > K(0.0)))
            return force;
        z->force = s->first ? force : follow(z->force, past, force, s->path / p->x_d, s->turned,
                                             FMAX(s->path - s->after, K(0.0)) / p->x_d,
                                             s->after / p->x_d);
        return z->force;
        """,
    ),
)  # fmt: skip
