"""Inertia of the fluid column and of the moving parts.

    F = m d2x/dt2

d2x/dt2 : (n,) acceleration [m/s^2], the slope of xdot within 20 ms each way (`Signals.xddot`)
m : mass [kg], m >= 0, off at 0; that of the fluid in a duct counts with the square of the ratio
of piston to duct area
Valid below about 20 Hz, where the window passes the acceleration (99.9 % at 7 Hz). At one frequency
m cannot be distinguished from k_nom, as then d2x/dt2 = -omega^2 x.
In C, which does not know what comes, the slope of xdot over the last step, half a step late.
Check: m = 2 kg, xdot = 0.5 t m/s gives 1 N.
>>> (2.0 * fluid_inertia(signals([0.0, 0.05, 0.10, 0.15], step=0.1), {})[0]).round(9).tolist()
[1.0, 1.0, 1.0, 1.0]

Source: D. J. Peel, R. Stanway, W. A. Bullough, Dynamic modelling of an ER vibration damper for
vehicle suspension applications, Smart Mater. Struct. 5 (1996) 591-606.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Causal, Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def fluid_inertia(s: Signals, p: Values) -> Array:
    """(1, n) force of 1 kg [m/s^2]."""
    return s.xddot[None]


def of_the_last_step(s: Signals, p: Values) -> Array:
    """(1, n) force of 1 kg by the slope of xdot over the last step, half a step late [m/s^2]."""
    h = s.step_before
    change = np.diff(s.xdot, prepend=s.xdot[:1])
    return np.where(h > 0.0, change / np.where(h > 0.0, h, 1.0), 0.0)[None]


EFFECT = Effect(
    name="fluid_inertia",
    stage=Stage.FLUID,
    slot=TermSlot(),
    title="inertia of the fluid column and of the moving parts",
    equation="F = m d2x/dt2",
    said="{m} of moving mass",
    source="Peel, Stanway and Bullough, Smart Mater. Struct. 5 (1996) 591-606",
    validity="motion below about 20 Hz",
    requires=(Requirement.FREQUENCIES,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="m", unit="kg", title="effective mass",
            low=0.0, high=1e9, start=0.1, linear=True,
        ),
    ),
    columns=fluid_inertia,
    causal=Causal(columns=of_the_last_step),
    c=CLaw(
        force="""
        /* No velocity is known ahead of a sample: the slope of the last step, half a step late. */
        return s->first ? K(0.0) : p->m * (s->xdot - s->xdot0) / s->h;
        """,
        note="the acceleration is the slope of xdot over the last step, where Python looks 20 ms "
        "each way",
    ),
)  # fmt: skip
