"""Force recorded on another clock than the motion and the control, which gains or loses on it.

    F_rec(t) = F(t - tau - r t)

F, F_rec : (n,) force of the damper, and as recorded [N];  t : (n,) logged time of the record [s]
tau : delay of the force channel at t = 0 [s], < 0 when early;  r : by how much it grows [1], in s a
second, off at 0
Straight lines between samples; beyond the ends of a record its first or last force holds.
Valid for two recorders that began together, once or with each record: the time is that of the log,
which begins anew with a record or goes on over all. Over long records a thousandth is seen, as of a
clock that a program keeps; what two quartzes differ by, 5e-5, is 3 ms in a minute.
Check: samples 10 ms apart from t = 0, F = 0, 4, 8, 12 N, tau = 5 ms, r = -0.5: the delays are 5, 0,
-5, -10 ms, which gives 0, 4, 10, 12 N.
>>> s, F = signals(np.ones(4), step=0.01), np.array([0.0, 4.0, 8.0, 12.0])
>>> clock_drift(F, s, {"tau": 5e-3, "r": -0.5}).round(9).tolist()
[0.0, 4.0, 10.0, 12.0]

Source: D. L. Mills, IEEE Transactions on Communications 39 (1991) 1482-1493 (offset and frequency
error of clocks).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.delayed_channel import delayed
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ChannelSlot, Values

GROWN = (0.002, 0.005, 0.012, 0.03)  # s, by the end of the log, where a search begins


def clock_drift(column: Array, s: Signals, p: Values) -> Array:
    """(n,) the column as the force channel records it."""
    if p["r"] == 0.0 and p["tau"] == 0.0:
        return column
    return delayed(column, s, p["tau"] + p["r"] * s.t)


def rates(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: none at the beginning, and at the middle of what the log lasts."""
    longest = max(float(np.abs(s.t).max()), 1e-3)
    found = []
    for grown in GROWN:
        for r in (grown / longest, -grown / longest):
            found += [{"tau": 0.0, "r": r}, {"tau": -0.5 * r * longest, "r": r}]
    return found


EFFECT = Effect(
    name="clock_drift",
    stage=Stage.SENSOR,
    slot=ChannelSlot(clock_drift),
    title="force recorded on another clock than the motion, which gains or loses on it",
    equation="F_rec(t) = F(t - tau - r t)",
    said="{r} of drift between two clocks",
    source="Mills, IEEE Transactions on Communications 39 (1991) 1482-1493",
    validity="two recorders that began together, with clocks of a constant rate",
    requires=(Requirement.REVERSALS, Requirement.TIME),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="delay of the force channel at t = 0",
            low=-0.5, high=0.5, start=1e-3,
        ),
        Quantity(
            symbol="r", unit="1", title="growth of that delay, in s a second",
            low=-0.5, high=0.5, start=1e-3,
        ),
    ),
    guesses=rates,
    richer_than=("time_skew",),
)  # fmt: skip
