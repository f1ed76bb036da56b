"""Release force lost after each reversal, until the void is taken up.

    F_viscous, F_yield -> (1 - lambda) of them in release while d < x_v

d : (n,) distance since the reversal into release [m], the integral of |xdot|
x_v : distance at which the void is taken up [m], x_v >= 0, off at 0
lambda : part of the force that is lost [1], 0..1, 1 by default
At d = x_v the force returns within the travel of one sample, so that it is continuous in x_v. What
came before a record is unknown: until its first reversal no force is lost.
Valid for a void that each stroke forms anew, whatever its speed.
Check: x_v = 2 mm, lambda = 0.8, d = 1 mm and 3 mm in release: 0.2 and 1 of both forces.
Source: S. Duym, R. Stiens, K. Reybrouck, Evaluation of shock absorber models, Vehicle System
Dynamics 27 (1997) 109-127 (vapour that must be taken up before the pressure builds up).
"""

from __future__ import annotations

import numpy as np

from erdctl.effect import Effect, Requirement, Slot, Stage, Values, Variable
from erdctl.quantity import Quantity, Scale
from erdctl.recording import Array
from erdctl.signals import Signals

NEGLIGIBLE = 1e-12  # m


def cavitation(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the viscous and the yield force, (n,) each [1]."""
    x_v = p["x_v"]
    if x_v == 0.0:
        return {}
    edge = np.maximum(np.minimum(s.path[0], 2.0 * x_v), NEGLIGIBLE)
    void = np.clip(0.5 + (x_v - s.path_since_reversal) / edge, 0.0, 1.0)
    left = np.where(s.compressing, 1.0, 1.0 - p["lambda"] * void)
    return {"viscous": left, "yield": left}


EFFECT = Effect(
    name="cavitation",
    stage=Stage.FLUID,
    slot=Slot.SCALE,
    title="release force lost until the void is taken up",
    equation="F_viscous, F_yield -> (1 - lambda) of them in release while d < x_v",
    source="Duym, Stiens and Reybrouck, Vehicle System Dynamics 27 (1997) 109-127",
    validity="a void that each stroke forms anew",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="x_v", unit="m", title="distance at which the void is taken up",
            low=1e-6, high=0.5, start=2e-3, scale=Scale.LOG,
        ),
        Quantity(
            symbol="lambda", unit="1", title="part of the force that is lost",
            low=0.0, high=1.0, start=1.0, off=1.0,
        ),
    ),
    apply=cavitation,
)  # fmt: skip
