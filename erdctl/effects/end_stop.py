"""Stiff contact beyond a stroke limit, with damping, at either end or at one.

    F = k_c c(x - x_stop, xdot) - k_r c(-x - x_r, -xdot)
    c(d, u) = max(d + theta u (1 - exp(-d / e)), 0) for d > 0, 0 elsewhere

x, xdot : (n,) stroke [m] and speed [m/s];  x_stop, x_r : free stroke in compression and in release
[m], from x = 0, of either sign
k_c, k_r : stiffness of the stop in compression and in release [N/m], >= 0, off at 0
theta : damping over stiffness of the contact [s], off at 0;  e : depth over which it sets in [m]:
far above the depths reached the law of Hunt and Crossley, d (1 + theta / e u), far below a spring
and a dashpot beside each other. A stop pushes and does not pull.
Valid for stops of one stiffness; one that is not touched has none.
Check: x_stop = x_r = 20 mm, k_c = 1000 N/m, k_r = 2000 N/m, theta = 0, x = 19, 21, -22 mm gives 0,
1, -4 N; with theta = 10 ms, e = 1 mm, entering at 0.1 m/s: 1 mm deep 1 + 1 - exp(-1) = 1.6321 N.
>>> s, p = signals([0.1, 0.1, 0.1], x=[0.019, 0.021, -0.022]), {"x_stop": 0.02, "x_r": 0.02}
>>> ([1000.0, 2000.0] @ end_stop(s, p | {"theta": 0.0, "e": 1e-3})).round(9).tolist()
[0.0, 1.0, -4.0]
>>> round(float(1000.0 * end_stop(s, p | {"theta": 0.01, "e": 1e-3})[0, 1]), 4)
1.6321

Source: K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted as damping in
vibroimpact, J. Appl. Mech. 42 (1975) 440-445; J. C. Dixon, The Shock Absorber Handbook, 2nd ed.
(2007), bump stops.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def end_stop(s: Signals, p: Values) -> Array:
    """(2, n) forces of stops of 1 N/m [m]."""
    return np.array([
        _contact(s.x - p["x_stop"], s.xdot, p), -_contact(-s.x - p["x_r"], -s.xdot, p)
    ])  # fmt: skip


def _contact(depth: Array, speed: Array, p: Values) -> Array:
    """(n,) spring and dashpot of a stop over its stiffness [m]."""
    d = np.maximum(depth, 0.0)
    if p["theta"] == 0.0:
        return d
    return np.maximum(d - p["theta"] * speed * np.expm1(-d / p["e"]), 0.0)


def starts(s: Signals, rest: Array) -> list[Values]:
    """Stops that the recorded stroke would touch, with and without damping."""
    low, high = float(s.x.min()), float(s.x.max())
    middle, half = 0.5 * (high + low), max(0.5 * (high - low), 1e-4)
    fastest = max(float(np.abs(s.xdot).max()), 1e-4)
    return [
        {
            "x_stop": middle + part * half, "x_r": part * half - middle,
            "theta": min(theta * half / fastest, 1.0), "e": min(max(0.1 * half, 1e-6), 1.0),
        }
        for part in (0.5, 0.7, 0.85, 0.95)
        for theta in (0.0, 0.1)
    ]  # fmt: skip


def softer_than_the_gas(p: Values, step: float) -> str:
    """No end of a stroke gives way more readily than the spring within it."""
    gas = max(p.get("compression.k_nom", 0.0), p.get("release.k_nom", 0.0))
    if max(p["k_c"], p["k_r"]) >= gas:
        return ""
    return (
        "softer than the gas spring, so a spring that stiffens along the stroke, or a deflection"
        " channel that is not linear, rather than a stop"
    )


EFFECT = Effect(
    name="end_stop",
    stage=Stage.MOTION,
    slot=TermSlot(),
    title="stiff contact beyond a stroke limit",
    equation="F = k_c c(x - x_stop, xdot) - k_r c(-x - x_r, -xdot),"
    " c(d, u) = max(d + theta u (1 - exp(-d / e)), 0) for d > 0",
    said="contact beyond {x_stop} of compression or {x_r} of release",
    source="Dixon, The Shock Absorber Handbook (2007); Hunt and Crossley (1975)",
    validity="stops of one stiffness each, touched in the log",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="k_c", unit="N/m", title="stiffness of the stop in compression",
            low=0.0, high=1e12, start=1e4, linear=True,
        ),
        Quantity(
            symbol="k_r", unit="N/m", title="stiffness of the stop in release",
            low=0.0, high=1e12, start=1e4, linear=True,
        ),
        Quantity(
            symbol="x_stop", unit="m", title="free stroke in compression",
            low=-1.0, high=1.0, start=0.02, off=0.02,
        ),
        Quantity(
            symbol="x_r", unit="m", title="free stroke in release",
            low=-1.0, high=1.0, start=0.02, off=0.02,
        ),
        Quantity(
            symbol="theta", unit="s", title="damping of the contact over its stiffness",
            low=0.0, high=1.0, start=5e-3,
        ),
        Quantity(
            symbol="e", unit="m", title="depth over which the damping sets in",
            low=1e-6, high=1.0, start=1e-3, off=1e-3, scale=Scale.LOG,
        ),
    ),
    columns=end_stop,
    guesses=starts,
    caveat=softer_than_the_gas,
    earlier=(("x_r", "x_stop"), ("theta", 0.0), ("e", 1e-3)),
    c=CLaw(
        force="""
        return p->k_c * stop_contact(s->x - p->x_stop, s->xdot, p->theta, p->e)
               - p->k_r * stop_contact(-s->x - p->x_r, -s->xdot, p->theta, p->e);
        """,
    ),
)  # fmt: skip
