"""Seal friction of constant size.

    F = F_c sign(xdot)

xdot : (n,) piston speed [m/s];  F_c : [N], F_c >= 0, off at 0;  sign(0) = 0, as in Eq. 18
Valid beyond the elastic pre-sliding of the seal, some 10 to 100 um.
Check: F_c = 3 N, xdot = 0.1, 0, -0.2 m/s gives 3, 0, -3 N.
>>> (3.0 * coulomb_friction(signals([0.1, 0.0, -0.2]), {})[0]).tolist()
[3.0, 0.0, -3.0]

Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and
compensation methods for the control of machines with friction, Automatica 30 (1994) 1083-1138.
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def coulomb_friction(s: Signals, p: Values) -> Array:
    """(1, n) force for F_c = 1 N [1]."""
    return s.sign[None]


EFFECT = Effect(
    name="coulomb_friction",
    stage=Stage.FRICTION,
    slot=TermSlot(),
    title="constant seal friction",
    equation="F = F_c sign(xdot)",
    said="{F_c} of friction",
    source="Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994) 1083-1138",
    validity="beyond the pre-sliding of the seal",
    requires=(Requirement.REVERSALS, Requirement.SPEEDS),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="F_c", unit="N", title="friction force",
            low=0.0, high=1e9, start=1.0, linear=True,
        ),
    ),
    columns=coulomb_friction,
    of_speed=True,
    c=CLaw(
        force="return p->F_c * s->sign;",
    ),
)  # fmt: skip
