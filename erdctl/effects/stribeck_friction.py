"""Seal friction that falls from a static to a kinetic value with speed.

    F = [F_k + F_sk exp(-(xdot / v_s)^2)] sign(xdot),   F_sk = F_s - F_k

xdot : (n,) piston speed [m/s];  F_k : kinetic friction [N];  F_s : static friction [N];  both
F_k and F_sk >= 0, off at 0;  v_s : Stribeck speed [m/s], > 0;  sign(0) = 0
Valid for lubricated seals, beyond their pre-sliding.
Check: F_k = 2 N, F_sk = 1 N, v_s = 10 mm/s, xdot = 10, -1000 mm/s gives 2 + exp(-1) = 2.3679, -2 N.
>>> unit = stribeck_friction(signals([0.010, -1.0]), {"v_s": 0.010})
>>> ([2.0, 1.0] @ unit).round(4).tolist()
[2.3679, -2.0]

Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083-1138, after
R. Stribeck (1902).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def stribeck_friction(s: Signals, p: Values) -> Array:
    """(2, n) forces for F_k = 1 N and for F_sk = 1 N [1]."""
    return np.array([s.sign, s.sign * np.exp(-((s.xdot / p["v_s"]) ** 2))])


EFFECT = Effect(
    name="stribeck_friction",
    stage=Stage.FRICTION,
    slot=TermSlot(),
    title="friction that falls from static to kinetic with speed",
    equation="F = [F_k + F_sk exp(-(xdot / v_s)^2)] sign(xdot), F_sk = F_s - F_k",
    said="{F_k} of kinetic friction and {F_sk} more at rest",
    source="Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994) 1083-1138",
    validity="lubricated seals, beyond their pre-sliding",
    requires=(Requirement.REVERSALS, Requirement.SPEEDS),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="F_k", unit="N", title="kinetic friction",
            low=0.0, high=1e9, start=1.0, linear=True,
        ),
        Quantity(
            symbol="F_sk", unit="N", title="static less kinetic friction",
            low=0.0, high=1e9, start=1.0, linear=True,
        ),
        Quantity(
            symbol="v_s", unit="m/s", title="Stribeck speed",
            low=1e-5, high=10.0, start=0.01, off=0.01, scale=Scale.LOG,
        ),
    ),
    columns=stribeck_friction,
    of_speed=True,
    c=CLaw(
        force="""
        real v = s->xdot / p->v_s;

        return s->sign * (p->F_k + p->F_sk * EXP(-v * v));
        """,
    ),
)  # fmt: skip
