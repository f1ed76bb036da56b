"""Piston behind a joint with free play.

    q_i = rod - piston, held within -g/2..g/2;  x_p = x - q
    xdot_p = xdot where the joint presses on a flank, 0 in the play

x, x_p : (n,) stroke of the rod and of the piston [m];  g : free play [m], g >= 0, off at 0
A record begins on the flank of its first motion, or, from rest, in the middle. Where contact closes
between two samples, the motion of the nearer one sets in in part, so that the force is continuous
in g; one that it lies ahead of takes it to come at its own speed.
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
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import MotionSlot, Values


def backlash(s: Signals, p: Values) -> Signals:
    """Motion of the piston from that of the rod."""
    if p["g"] == 0.0:
        return s
    from erdctl.model.recurrences import BLUR, play

    blur = 0.0 if s.sharp else BLUR
    lost, engaged = play(s.xdot, s.step, s.starts, s.compressing, s.rests, p["g"], blur)
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
    c=CLaw(
        state=("lost", "past", "free"),
        code="""
        const real blur = K(0.2);  /* part of a step over which contact sets in */
        real half = K(0.5) * p->g, v0 = z->past, v1 = s->xdot, h = s->h;
        real before, a, b, span, travel, flank, room, met, contact = K(-1.0), edge = blur * h;
        int leg, turning = v0 * v1 < K(0.0), pressing;

        z->past = s->xdot;
        if (!(p->g > K(0.0)))
            return;
        m->joint = 1;
        if (s->first) {
            z->lost = s->rests ? K(0.0) : s->up ? half : -half;
            z->free = K(0.0);
            m->engaged = s->rests ? K(0.0) : K(1.0);
            m->x -= z->lost;
            m->xdot *= m->engaged;
            return;
        }
        before = turning ? v0 / (v0 - v1) * h : h;
        for (leg = 0; leg < (turning ? 2 : 1); leg++) {
            a = leg == 0 ? v0 : K(0.0);
            b = turning && leg == 0 ? K(0.0) : v1;
            span = leg == 0 ? before : h - before;
            travel = K(0.5) * (a + b) * span;
            if (!(FABS(travel) > K(0.0)))
                continue;
            flank = travel > K(0.0) ? half : -half;
            room = FABS(flank - z->lost);
            if (room >= p->g)
                z->free = K(0.0);
            if (FABS(travel) < room) {
                z->lost += travel;
                z->free += span;
                continue;
            }
            if (room > K(0.0)) {
                real u = FABS(a), rate = (FABS(b) - FABS(a)) / span;

                met = K(2.0) * room / (u + SQRT(FMAX(u * u + K(2.0) * rate * room, K(0.0))));
                met = FMIN(met, span);
                contact = (leg == 1 ? before : K(0.0)) + met;
                edge = FMAX(FMIN(blur * h, K(2.0) * (z->free + met)), K(1e-12));
            }
            z->lost = flank;
        }
        pressing = (v1 > K(0.0) && z->lost >= half) || (v1 < K(0.0) && z->lost <= -half);
        m->engaged = pressing ? K(1.0) : K(0.0);
        if (pressing && contact >= K(0.0))
            m->engaged = FMIN(K(1.0), K(0.5) + (h - contact) / edge);
        if (!pressing && FABS(v1) > K(0.0)) {
            /* Contact just ahead, at the speed of this sample. */
            met = FABS((v1 > K(0.0) ? half : -half) - z->lost) / FABS(v1);
            edge = FMAX(FMIN(blur * h, K(2.0) * (z->free + met)), K(1e-12));
            m->engaged = FMAX(K(0.0), K(0.5) - met / edge);
        }
        m->x -= z->lost;
        m->xdot *= m->engaged;
        """,
        play="return p->g;",
    ),
)  # fmt: skip
