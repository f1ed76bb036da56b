"""Elastic mount in series with the whole damper.

    x_p = x - s_m F,   xdot_p = xdot - s_m dF/dt

x, x_p : (n,) stroke of the rod and of the piston [m];  F : (n,) damper force [N]
s_m : compliance of the mount [m/N], s_m >= 0, off at 0;  its stiffness is k_m = 1 / s_m
Valid for a mount that is linear and has little damping of its own. Simulated free-running,
with the force that the model itself makes (`erdctl.model.series_compliance`).
Check: held at x = 10 mm with a gas spring of 1000 N/m and s_m = 1e-4 m/N:
F = k x / (1 + k s_m) = 10 / 1.1 = 9.0909 N.
>>> s = signals([0.0, 0.0], x=[0.01, 0.01])
>>> force_with(EFFECT, s, {"s_m": 1e-4}, k_nom=1000.0).round(4).tolist()
[9.0909, 9.0909]

Source: M. C. Constantinou, M. D. Symans, Experimental study of seismic response of buildings with
supplemental fluid dampers, Struct. Design Tall Build. 2 (1993) 93-132; J. C. Maxwell (1867).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity, Scale
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SeriesSlot, Values


def mount_compliance(p: Values) -> float:
    """Compliance in series with the whole damper [m/N]."""
    return p["s_m"]


EFFECT = Effect(
    name="mount_compliance",
    stage=Stage.MOTION,
    slot=SeriesSlot(mount_compliance),
    title="elastic mount in series with the damper, of stiffness k_m = 1 / s_m",
    equation="x_m = x - s_m F, xdot_m = xdot - s_m dF/dt",
    said="{s_m} of compliance in series with the damper",
    alters=(("x", "x_m"), ("xdot", "xdot_m")),
    source="Constantinou and Symans, Struct. Design Tall Build. 2 (1993) 93-132",
    validity="a linear mount with little damping of its own",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="s_m", unit="m/N", title="compliance of the mount, 1 / k_m",
            low=1e-12, high=1.0, start=1e-5, scale=Scale.LOG,
        ),
    ),
    equivalents=("fluid_compressibility",),
    c=CLaw(
        code="return p->s_m;",
    ),
)  # fmt: skip
