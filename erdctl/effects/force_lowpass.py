"""Force channel behind a low-pass filter: the amplifier of a load cell, or one against aliasing.

    tau dF_rec/dt + F_rec = F

F, F_rec : (n,) force of the damper, and as recorded [N];  tau : time constant [s], off at 0; the
cut-off frequency is 1 / (2 pi tau)
Straight lines between samples, and a jump where the motion turns; a record begins settled. Every
jump of the force becomes an exponential after it, in the same time whatever the motion, the field
and the force: a lag of the yield force takes its part alone, an average begins before the jump.
Valid for filters of the first order, and of higher orders with one pole well below the others. A
mere delay of a smooth force looks alike.
Check: a jump from 0 to 1 N as the motion turns half a step of tau after a sample shows
1 - exp(-0.5) = 0.393 N at the next, and 1 - exp(-1.5) = 0.777 N at the one after it.
>>> s, jump = signals([-1.0, 1.0, 1.0], step=0.01), np.array([0.0, 1.0, 1.0])
>>> force_lowpass(jump, s, {"tau": 0.01}).round(3).tolist()
[0.0, 0.393, 0.777]

Source: K. Ogata, Modern Control Engineering (5th ed. 2010), ch. 5 (first-order systems).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.kernels import follow
from erdctl.model.slots import ChannelSlot, Values


def force_lowpass(column: Array, s: Signals, p: Values) -> Array:
    """(n,) the column as the filtered force channel shows it."""
    if p["tau"] == 0.0:
        return column
    exponent = s.step / p["tau"]
    i, part = s.turns
    before, after = part * exponent[i], (1.0 - part) * exponent[i]
    return follow(column, exponent, i, before, after, column[s.starts[:-1]], s.starts)


def shortest(s: Signals, force: Array) -> dict[str, float]:
    """A tenth of the time between samples, which moves the one after a jump by 5 % of it."""
    return {"tau": 0.1 * s.typical_step}


EFFECT = Effect(
    name="force_lowpass",
    stage=Stage.SENSOR,
    slot=ChannelSlot(force_lowpass),
    title="force recorded through a low-pass filter of the first order",
    equation="tau dF_rec/dt + F_rec = F",
    said="{tau} of a low-pass filter in the force channel",
    source="Ogata, Modern Control Engineering (2010) ch. 5",
    validity="a filter of the first order, or with one pole well below the others",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="time constant of the filter",
            low=0.0, high=0.5, start=3e-3,
        ),
    ),
    least=shortest,
)  # fmt: skip
