"""Piston behind a joint with free play.

    q_i = rod - piston, held within -g/2..g/2;  x_p = x - q
    xdot_p = xdot where the joint presses on a flank, 0 in the play

x, x_p : (n,) stroke of the rod and of the piston [m];  g : free play [m], g >= 0, off at 0
A record begins on the flank of its first motion, or, from rest, in the middle. Where contact closes
between two samples, the motion of the nearer one sets in in part, so that the force is continuous
in g.
Valid for a joint without damping of its own, with a clamp much stiffer than the damper.
With a compliance in series the joint is its: after a reversal the spring unloads, then the play is
crossed without force, then it loads again (`erdctl.model.series_compliance`).
The play is followed along the integral of xdot: noise in x does not open the joint.
Check: x = 0, 1, 2, 1, 0 mm from the lower flank, g = 2 mm gives x_p - x_p0 = 0, 1, 2, 2, 2 mm.
>>> t = np.linspace(0.0, 4.0, 4001)
>>> s = signals(np.where(t < 2.0, 1e-3, -1e-3), x=2e-3 - 1e-3 * abs(t - 2.0), t=t)
>>> x_p = 1e3 * backlash(s, {"g": 2e-3}).x[::1000]
>>> (x_p - x_p[0]).round(2).tolist()
[0.0, 1.0, 2.0, 2.0, 2.0]

Source: M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey,
Automatica 38 (2002) 1633-1649; the play operator of Krasnosel'skii and Pokrovskii (1989).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import MotionSlot, Values


def backlash(s: Signals, p: Values) -> Signals:
    """Motion of the piston from that of the rod."""
    if p["g"] == 0.0:
        return s
    from erdctl.model.recurrences import play

    lost, engaged = play(s.xdot, s.step, s.starts, s.compressing, s.rests, p["g"])
    return s.with_motion(s.x - lost, s.xdot * engaged, engaged)


def free_play(p: Values) -> float:
    """Play in the joint, for a spring in series with it to take over [m]."""
    return p["g"]


def gaps(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search, close together: which samples lie in the play changes with every step."""
    stroke = max(float(np.ptp(s.x)), 1e-6)
    return [
        {"g": float(np.clip(part * stroke, 1e-7, 0.05))} for part in np.geomspace(1e-4, 0.3, 30)
    ]


EFFECT = Effect(
    name="backlash",
    stage=Stage.MOTION,
    slot=MotionSlot(backlash, free_play=free_play),
    title="lost motion between the measured rod and the piston",
    equation="x_p = x - q, |q| <= g/2, dq/dt = xdot in the play and 0 on its flanks",
    said="{g} of free play",
    alters=(("x", "x_p"), ("xdot", "xdot_p")),
    source="Nordin and Gutman, Automatica 38 (2002) 1633-1649",
    validity="a joint stiffer than the damper and without damping of its own",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="g", unit="m", title="free play, from flank to flank",
            low=1e-7, high=0.05, start=1e-4, scale=Scale.LOG,
        ),
    ),
    guesses=gaps,
    companions=("mount_compliance", "coulomb_friction"),
)  # fmt: skip
