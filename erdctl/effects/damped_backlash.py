"""Joint with free play whose filling damps, and whose flanks are elastic.

    F = e_g / s_m + c_m de/dt,   e_g = e - sign(e) min(|e|, g/2),   x_p = x - e

x, x_p : (n,) stroke of the rod and of the piston [m];  F : (n,) damper force [N]
e, e_g : what lies between them, and what of it is beyond the play [m]
g : free play [m];  s_m : compliance of its flanks [m/N], s_m >= 0, off at 0
c_m : damping of what fills it [N s/m]: grease, oil that is squeezed out, rubber
After a reversal the flanks unload; then the play is crossed, in which c_m de/dt alone is borne: the
force stands on a step, the higher the faster the rod is, and rises again where the play ends. With
c_m near 0 these are `backlash` and `mount_compliance` in one, with no play a bush of rubber
(Kelvin-Voigt).
Valid for a linear damping, the same all along the play. Simulated free-running
(`erdctl.model.series_compliance`).
Check: c_vis = 100 N s/m, no field, c_m = 300 N s/m, s_m = 1e-4 m/N, xdot from 0 to 0.1 m/s at once,
no play: the dashpots share it, F = 100 * 0.1 * 3/4 = 7.5 N, and 10 N is reached with the time
constant (c_vis + c_m) s_m = 40 ms: 10 - 2.5 exp(-1) = 9.080 N after 40 ms.
>>> s = signals([0.0] + 40_000 * [0.1], step=1e-6)
>>> F = force_with(EFFECT, s, {"g": 0.0, "s_m": 1e-4, "c_m": 300.0}, c_vis=100.0)
>>> F[[1, 40_000]].round(2).tolist()
[7.5, 9.08]

Source: M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey,
Automatica 38 (2002) 1633-1649, the dead zone with damping; W. Voigt, Ann. Phys. 283 (1892) 671-693.
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity, Scale
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import SeriesSlot, Values


def damped_backlash(p: Values) -> float:
    """Compliance in series with the whole damper [m/N]."""
    return p["s_m"]


def damping(p: Values) -> float:
    """Damping across the joint [N s/m]."""
    return p["c_m"]


def free_play(p: Values) -> float:
    """Play in the joint [m]."""
    return p["g"]


EFFECT = Effect(
    name="damped_backlash",
    stage=Stage.MOTION,
    slot=SeriesSlot(damped_backlash, damping=damping, free_play=free_play),
    title="joint with free play whose filling damps, and whose flanks are elastic",
    equation="c_m de/dt = F - e_g / s_m, e_g = e - sign(e) min(|e|, g/2), x_p = x - e, "
    "xdot_p = xdot - de/dt",
    said="{g} of free play, which {c_m} of damping crosses, between flanks of {s_m}",
    alters=(("x", "x_p"), ("xdot", "xdot_p")),
    source="Nordin and Gutman, Automatica 38 (2002) 1633-1649; Voigt, Ann. Phys. 283 (1892)",
    validity="a linear damping, the same all along the play",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="g", unit="m", title="free play, from flank to flank",
            low=1e-7, high=0.05, start=1e-4, scale=Scale.LOG,
        ),
        Quantity(
            symbol="s_m", unit="m/N", title="compliance of the flanks, 1 / k_m",
            low=1e-12, high=1.0, start=1e-5, scale=Scale.LOG,
        ),
        Quantity(
            symbol="c_m", unit="N s/m", title="damping of what fills the play",
            low=1e-3, high=1e8, start=1e3, scale=Scale.LOG,
        ),
    ),
    richer_than=("backlash", "mount_compliance"),
    c=CLaw(
        code="return p->s_m;",
        play="return p->g;",
        damping="return p->c_m;",
    ),
)  # fmt: skip
