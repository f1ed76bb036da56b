"""Force channel recorded late, or early, against motion and control.

    F_rec(t) = F(t - tau)

F, F_rec : (n,) force of the damper, and as recorded [N];  tau : delay [s], < 0 when early, off at 0
Straight lines between samples; beyond the ends of a record its first or last force holds.
Valid for a constant delay (filters, conversion times) of a few samples or more.
Check: samples 10 ms apart, F = 0, 4, 8, 8 N, tau = 5 ms gives 0, 2, 6, 8 N; -5 ms 2, 6, 8, 8 N.
>>> s, F = signals(np.ones(4), step=0.01), np.array([0.0, 4.0, 8.0, 8.0])
>>> [time_skew(F, s, {"tau": tau}).round(9).tolist() for tau in (5e-3, -5e-3)]
[[0.0, 2.0, 6.0, 8.0], [2.0, 6.0, 8.0, 8.0]]

Source: T. I. Laakso et al., Splitting the unit delay, IEEE Signal Processing Magazine 13 (1996)
30-60 (linear interpolation as fractional delay).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.delayed_channel import delayed
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ChannelSlot, Values


def time_skew(column: Array, s: Signals, p: Values) -> Array:
    """(n,) the column as the force channel records it."""
    if p["tau"] == 0.0:
        return column
    return delayed(column, s, np.broadcast_to(p["tau"], column.shape))


def delays(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: the cost has a dip of its own for every jump that meets another.

    Delays of a part of a step have the slope of the force, and not its jumps, for their direction.
    """
    step = s.typical_step or 1e-3
    longest = 0.2 * float(np.diff(s.t[[s.starts[:-1], s.starts[1:] - 1]], axis=0).min())
    sizes = [0.2 * step, *np.geomspace(step, max(min(longest, 0.3), 2.0 * step), 12).tolist()]
    return [{"tau": way * size} for size in sizes for way in (1.0, -1.0)]


def of_the_motion(p: Values, step: float) -> str:
    """No channel is ahead of what it shows: another one is behind."""
    if p["tau"] >= 0.0:
        return ""
    return (
        "early is to say that the motion was recorded late, as a deflection behind a filter; a dead"
        " time of the field of about as much beside it is then none of the fluid"
    )


EFFECT = Effect(
    name="time_skew",
    stage=Stage.MOTION,
    slot=ChannelSlot(time_skew),
    title="force channel recorded late (or early) against the motion",
    equation="F_rec(t) = F(t - tau)",
    said="{tau} of delay of the force channel",
    source="Laakso et al., IEEE Signal Processing Magazine 13 (1996) 30-60",
    validity="a constant delay, with the duty logged on the clock of the motion",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="delay of the force channel, below 0 when early",
            low=-0.5, high=0.5, start=2e-3,
        ),
    ),
    guesses=delays,
    caveat=of_the_motion,
)  # fmt: skip
