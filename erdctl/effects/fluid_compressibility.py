"""Fluid force through the stiffness of the compressed fluid (Maxwell element).

    F_f = c_vis v + F_ER sign(v),   v = xdot - s_f dF_f/dt

F_f : (n,) viscous and yield force [N];  v : (n,) speed of the flow in the duct [m/s]
s_f : compliance of fluid, hoses and trapped air [m/N], s_f >= 0, off at 0;  1/s_f is A_p^2 K / V
Valid for pressures at which the bulk modulus is constant. Simulated free-running, with the force
that the model itself makes (`erdctl.model.series_compliance`); the gas force acts in parallel.
Check: c_vis = 100 N s/m, no field, s_f = 1e-4 m/N: xdot rises from 0 to 0.1 m/s, F_f follows with
the time constant c_vis s_f = 10 ms: 10 (1 - exp(-1)) = 6.321 N after 10 ms.
>>> s = signals([0.0] + 10_000 * [0.1], step=1e-6)
>>> round(float(force_with(EFFECT, s, {"s_f": 1e-4}, c_vis=100.0)[-1]), 3)
6.321

Source: D. J. Peel, R. Stanway, W. A. Bullough, Dynamic modelling of an ER vibration damper for
vehicle suspension applications, Smart Mater. Struct. 5 (1996) 591-606; J. C. Maxwell (1867).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity, Scale
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SeriesSlot, Values


def fluid_compressibility(p: Values) -> float:
    """Compliance in series with the fluid [m/N]."""
    return p["s_f"]


EFFECT = Effect(
    name="fluid_compressibility",
    stage=Stage.FLUID,
    slot=SeriesSlot(fluid_compressibility, carries=("viscous", "yield")),
    title="fluid force through a series stiffness (Maxwell)",
    equation="F_f = c_vis v_f + F_ER sign(v_f), v_f = xdot - s_f dF_f/dt",
    said="{s_f} of compliance in series with the fluid",
    alters=(("viscous", "F_f"), ("yield", "")),
    source="Peel, Stanway and Bullough, Smart Mater. Struct. 5 (1996) 591-606",
    validity="a constant bulk modulus",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="s_f", unit="m/N", title="compliance of the fluid",
            low=1e-12, high=1.0, start=1e-5, scale=Scale.LOG,
        ),
    ),
    equivalents=("mount_compliance",),
    c=CLaw(
        code="return p->s_f;",
    ),
)  # fmt: skip
