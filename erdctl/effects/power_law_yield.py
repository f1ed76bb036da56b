"""Yield force that rises with speed: a power-law fluid under the field, in place of Bingham's.

    F_ER -> F_ER (|xdot| / V)^n

xdot : (n,) piston speed [m/s];  V = 0.1 m/s : the speed at which sigma v^beta is the yield force
n : flow index [1], 0 <= n <= 1, off at 0
Valid where more field makes the flowing fluid thicker too, so that no plateau is reached as speed
grows; the viscosity with no field, c_vis, remains.
Check: n = 0.5, xdot = 0.1, -0.025, 0 m/s gives 1, 0.5, 0 of F_ER.
>>> power_law_yield(signals([0.1, -0.025, 0.0]), {"n": 0.5})["yield"].round(9).tolist()
[1.0, 0.5, 0.0]

Source: G. Yang, B. F. Spencer, J. D. Carlson, M. K. Sain, Large-scale MR fluid dampers: modeling
and dynamic performance considerations, Engineering Structures 24 (2002) 309-323 (Herschel-
Bulkley).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ScaleSlot, Values

REFERENCE = 0.1  # m/s


def power_law_yield(s: Signals, p: Values) -> dict[str, Array]:
    """Factor of the yield force, (n,) [1]."""
    return {"yield": (np.abs(s.xdot) / REFERENCE) ** p["n"]}


EFFECT = Effect(
    name="power_law_yield",
    stage=Stage.FLUID,
    slot=ScaleSlot(power_law_yield),
    title="the yield force rises with a power of speed (Herschel-Bulkley)",
    equation="F_ER -> F_ER (|xdot| / 0.1 m/s)^n",
    said="yield force rising with the speed, by an exponent of {n}",
    alters=(("yield", "(|xdot| / 0.1 m/s)^n {}"),),
    source="Yang, Spencer, Carlson and Sain, Engineering Structures 24 (2002) 309-323",
    validity="no plateau of the yield force within the speeds of the log",
    requires=(Requirement.FIELD, Requirement.SPEEDS),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="n", unit="1", title="flow index of the yield force",
            low=0.0, high=1.0, start=0.1,
        ),
    ),
    of_speed=True,
    companions=("shear_thinning",),  # one fluid: with the field and without
    c=CLaw(
        code="f->yield *= POW(FABS(s->xdot) / K(0.1), p->n);",
    ),
)  # fmt: skip
