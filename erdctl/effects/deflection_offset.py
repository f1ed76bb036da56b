"""Zero of the deflection channel beside that of the damper.

    x_s = x - x_z

x : (n,) logged deflection [m];  x_s : that from where the gas spring k_nom x is at rest [m]
x_z : what the channel shows there [m], of either sign, off at 0
Valid for a channel that counts from an end of its range, say, or from where somebody set it to
zero. All that goes with the deflection goes with x_s: where the springs of compression and release
are alike no force data tell it from force_offset (-k_nom x_z = F_z); where they are not, a jump at
reversals does.
Check: x = 30, 50 mm, x_z = 40 mm, k_nom = 600 N/m: the spring has -6 and 6 N, and not 18 and 30 N.
>>> s = signals([0.1, 0.1], x=[0.03, 0.05])
>>> force_with(EFFECT, s, {"x_z": 0.04}, k_nom=600.0).round(9).tolist()
[-6.0, 6.0]

Source: JCGM 200:2012, International vocabulary of metrology, 4.28 (zero error); in the ER damper
paper x_p counts from where the gas has its initial volume (Eq. 3).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import MotionSlot, Values

PARTS = (0.1, 0.5)  # of the stroke, of either sign, where a search begins


def deflection_offset(s: Signals, p: Values) -> Signals:
    """Motion with the deflection from where the gas spring is at rest."""
    if p["x_z"] == 0.0:
        return s
    return s.with_motion(s.x - p["x_z"], s.xdot)


def zeros(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: the middle of what was travelled, and places about where x is 0."""
    low, high = float(s.x.min()), float(s.x.max())
    found = [0.5 * (low + high), *(way * f * (high - low) for f in PARTS for way in (1.0, -1.0))]
    return [{"x_z": float(np.clip(z, -1.0, 1.0))} for z in found]


EFFECT = Effect(
    name="deflection_offset",
    stage=Stage.SENSOR,
    slot=MotionSlot(deflection_offset),
    title="zero of the deflection channel beside that of the damper",
    equation="x_s = x - x_z",
    said="{x_z} of zero error of the deflection",
    alters=(("x", "x_s"),),
    source="JCGM 200:2012, 4.28",
    validity="where the springs of both directions are alike, the same as force_offset",
    requires=(Requirement.STROKE,),
    shows=Variable.X,
    quantities=(
        Quantity(
            symbol="x_z", unit="m", title="deflection shown where the gas spring is at rest",
            low=-1.0, high=1.0, start=5e-3,
        ),
    ),
    guesses=zeros,
    gives_way_to=("force_offset", "gas_preload"),  # which take nothing along but a constant
    order=-10,  # the measuring chain comes before what moves behind the rod
)  # fmt: skip
