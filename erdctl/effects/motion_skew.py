"""Motion recorded late, or early, against force and duty.

    x_s(t) = x(t + tau),   xdot_s(t) = xdot(t + tau)

x, xdot : (n,) logged deflection [m] and velocity [m/s];  x_s, xdot_s : those of the damper
tau : delay of both [s], < 0 when early, off at 0
Straight lines between samples; beyond the ends of a record its first or last motion holds. Valid
for a deflection behind a filter or a converter of its own, or two recorders of which one has the
motion and the other one force and duty. Where no duty changes within records it is a force channel
that is early by as much.
Check: samples 10 ms apart, x = 0, 1, 2, 2 mm, tau = 5 ms gives 0.5, 1.5, 2, 2 mm.
>>> s = signals([0.1, 0.1, 0.1, 0.0], x=[0.0, 1.0, 2.0, 2.0], step=0.01)
>>> motion_skew(s, {"tau": 5e-3}).x.round(9).tolist()
[0.5, 1.5, 2.0, 2.0]

Source: T. I. Laakso et al., Splitting the unit delay, IEEE Signal Processing Magazine 13 (1996)
30-60 (linear interpolation as fractional delay).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import MotionSlot, Values


def motion_skew(s: Signals, p: Values) -> Signals:
    """Motion as it was when force and duty were recorded."""
    if p["tau"] == 0.0:
        return s
    x, xdot = np.empty_like(s.x), np.empty_like(s.xdot)
    for a, b in pairwise(s.starts.tolist()):
        t = s.t[a:b] - s.t[a]  # small numbers, whatever the clock says
        x[a:b] = np.interp(t + p["tau"], t, s.x[a:b])
        xdot[a:b] = np.interp(t + p["tau"], t, s.xdot[a:b])
    return s.with_motion(x, xdot)


def delays(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search, of either sign: the cost has a dip for every jump that meets another."""
    step = s.typical_step or 1e-3
    longest = 0.2 * float(np.diff(s.t[[s.starts[:-1], s.starts[1:] - 1]], axis=0).min())
    sizes = np.geomspace(step, max(min(longest, 0.3), 2.0 * step), 10).tolist()
    return [{"tau": way * size} for size in sizes for way in (1.0, -1.0)]


EFFECT = Effect(
    name="motion_skew",
    stage=Stage.SENSOR,
    slot=MotionSlot(motion_skew),
    title="deflection and velocity recorded late (or early) against force and duty",
    equation="x_s(t) = x(t + tau), xdot_s(t) = xdot(t + tau)",
    said="{tau} of delay of the deflection",
    alters=(("xdot", "xdot_s"), ("x", "x_s")),
    source="Laakso et al., IEEE Signal Processing Magazine 13 (1996) 30-60",
    validity="a constant delay, with force and duty logged on one clock",
    requires=(Requirement.REVERSALS, Requirement.STEPS),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="delay of the motion, below 0 when early",
            low=-0.5, high=0.5, start=2e-3,
        ),
    ),
    guesses=delays,
    gives_way_to=("time_skew",),  # which takes one channel for two
    order=-20,  # the measuring chain comes before what moves behind the rod
)  # fmt: skip
