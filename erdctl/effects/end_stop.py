"""Stiff contact beyond a stroke limit, one spring for each end.

    F = k_c max(x - x_stop, 0) - k_r max(-x - x_stop, 0)

x : (n,) stroke [m], 0 half-way between the stops;  x_stop : free stroke to either side [m], > 0
k_c, k_r : stiffness of the stop in compression and in release [N/m], >= 0, off at 0
Valid for an elastic stop met at a speed that its damping does not matter for.
Check: x_stop = 20 mm, k_c = 1000 N/m, k_r = 2000 N/m, x = 19, 21, -22 mm gives 0, 1, -4 N.
>>> s = signals([0.0, 0.0, 0.0], x=[0.019, 0.021, -0.022])
>>> ([1000.0, 2000.0] @ end_stop(s, {"x_stop": 0.02})).round(9).tolist()
[0.0, 1.0, -4.0]

Source: J. C. Dixon, The Shock Absorber Handbook, 2nd ed. (2007), bump stops; the one-sided spring
without the damping of K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440-445.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def end_stop(s: Signals, p: Values) -> Array:
    """(2, n) forces of stops of 1 N/m [m]."""
    stop = p["x_stop"]
    return np.array([np.maximum(s.x - stop, 0.0), -np.maximum(-s.x - stop, 0.0)])


def starts(s: Signals, rest: Array) -> list[Values]:
    """Stops that the recorded stroke would touch."""
    reached = float(np.abs(s.x).max())
    return [{"x_stop": max(part * reached, 1e-4)} for part in (0.5, 0.7, 0.85, 0.95)]


EFFECT = Effect(
    name="end_stop",
    stage=Stage.MOTION,
    slot=TermSlot(),
    title="stiff contact beyond a stroke limit",
    equation="F = k_c max(x - x_stop, 0) - k_r max(-x - x_stop, 0)",
    said="contact beyond {x_stop} of stroke",
    source="Dixon, The Shock Absorber Handbook (2007); Hunt and Crossley (1975)",
    validity="elastic stops, x = 0 half-way between them",
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
            symbol="x_stop", unit="m", title="free stroke to either side",
            low=1e-4, high=1.0, start=0.02, off=0.02, scale=Scale.LOG,
        ),
    ),
    columns=end_stop,
    guesses=starts,
)  # fmt: skip
