"""Damping that varies along the stroke.

    F_viscous -> max(1 + b_1 x + b_2 x^2, 0) of it,   F_yield -> max(1 + e_1 x + e_2 x^2, 0) of it

x : (n,) piston stroke [m];  b_1, e_1 [1/m], b_2, e_2 [1/m^2] : slopes and curvatures, off at 0
Valid for tapered or eccentric ducts and for bypasses, with the force at x = 0 as reference. A duct
of varying gap d changes the two alike in sign but not in size: by d^-3 and d^-1 (Eq. 8), and a
bypass may change the viscous force alone.
Check: b_1 = 10 /m, b_2 = 100 /m^2, x = 20, -20, 0 mm gives 1.24, 0.84, 1 of the viscous force.
>>> s = signals([0.1, 0.1, 0.1], x=[0.02, -0.02, 0.0])
>>> p = {"b_1": 10.0, "b_2": 100.0, "e_1": 0.0, "e_2": 0.0}
>>> position_dependent_damping(s, p)["viscous"].round(9).tolist()
[1.24, 0.84, 1.0]

Source: J. C. Dixon, The Shock Absorber Handbook, 2nd ed. (2007), position-dependent dampers.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ScaleSlot, Values


def position_dependent_damping(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the viscous and the yield force, (n,) each [1]."""

    def along(slope: float, curvature: float) -> Array:
        return np.maximum(1.0 + (slope + curvature * s.x) * s.x, 0.0)

    return {"viscous": along(p["b_1"], p["b_2"]), "yield": along(p["e_1"], p["e_2"])}


EFFECT = Effect(
    name="position_dependent_damping",
    stage=Stage.POSITION,
    slot=ScaleSlot(position_dependent_damping),
    title="damping varies along the stroke",
    equation="F_viscous -> max(1 + b_1 x + b_2 x^2, 0) F_viscous,"
    " F_yield -> max(1 + e_1 x + e_2 x^2, 0) F_yield",
    said="viscous force changing by {b_1} and yield force by {e_1} along the stroke",
    alters=(
        ("viscous", "max(1 + b_1 x + b_2 x^2, 0) {}"),
        ("yield", "max(1 + e_1 x + e_2 x^2, 0) {}"),
    ),
    source="Dixon, The Shock Absorber Handbook (2007)",
    validity="the force at x = 0 as reference",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="b_1", unit="1/m", title="slope of the viscous force over the stroke",
            low=-1e4, high=1e4, start=1.0,
        ),
        Quantity(
            symbol="b_2", unit="1/m^2", title="curvature of the viscous force over the stroke",
            low=-1e7, high=1e7, start=100.0,
        ),
        Quantity(
            symbol="e_1", unit="1/m", title="slope of the yield force over the stroke",
            low=-1e4, high=1e4, start=1.0,
        ),
        Quantity(
            symbol="e_2", unit="1/m^2", title="curvature of the yield force over the stroke",
            low=-1e7, high=1e7, start=100.0,
        ),
    ),
    c=CLaw(
        code="""
        f->viscous *= FMAX(K(1.0) + (p->b_1 + p->b_2 * s->x) * s->x, K(0.0));
        f->yield *= FMAX(K(1.0) + (p->e_1 + p->e_2 * s->x) * s->x, K(0.0));
        """,
    ),
)  # fmt: skip
