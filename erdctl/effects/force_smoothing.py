"""Force recorded as a moving average over a part of the motion's cycle.

    F_rec(t) = 1/W integral of F from t - W/2 to t + W/2,   W = w T,   T = 2 pi rms(x) / rms(xdot)

F, F_rec : (n,) force of the damper, and as recorded [N];  T : cycle of a record's motion [s], its
period if that is a sine, from x less its mean;  w : window over cycle [1], 0..0.5, off at 0
Straight lines between samples, and a jump where the motion turns; towards the ends of a record the
window shrinks. Every jump at a reversal becomes a ramp that takes the same part of each cycle,
whatever the stroke, the speed and the force: no law of the damper does that.
Valid for records that were smoothed one by one, slow tests over longer times than fast ones, before
they were stored; a window of the same time throughout looks alike where all have one cycle.
Check: xdot > 0 throughout, samples 1 s apart, F = 0, 4, 8, 0, 0 N, W = 2 s gives 0, 4, 5, 2, 0 N.
Source: S. W. Smith, The Scientist and Engineer's Guide to Digital Signal Processing (1997), ch. 15
(moving average).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from erdctl.effect import Effect, Requirement, Slot, Stage, Values, Variable
from erdctl.quantity import Quantity
from erdctl.recording import Array, Index
from erdctl.signals import Signals

FINEST = 1e-9  # of a record: a window narrower than that is lost in rounding


def force_smoothing(column: Array, s: Signals, p: Values) -> Array:
    """(n,) the column as the smoothed force channel shows it."""
    if p["w"] == 0.0:
        return column
    turn, before, after = _lines(column, s)
    out = np.empty_like(column)
    for a, b in pairwise(s.starts.tolist()):
        t = s.t[a:b] - s.t[a]  # small numbers, whatever the clock says
        part = slice(a, b)
        half = np.minimum(np.minimum(t, t[-1] - t), 0.5 * p["w"] * _cycle(s, part))
        until = _integral(t, column[part], turn[part], before[part], after[part])
        wide = half > FINEST * t[-1]
        low, high = t[wide] - half[wide], t[wide] + half[wide]
        out[part] = column[part]
        out[a:b][wide] = (until(high) - until(low)) / (high - low)
    return out


def _cycle(s: Signals, part: slice) -> float:
    """Cycle of the motion of one record [s]; 0 if it has none, as nothing turns then."""
    speed = float(np.sqrt(np.mean(s.xdot[part] ** 2)))
    return 2.0 * np.pi * float(np.std(s.x[part])) / speed if speed > 0.0 else 0.0


def _lines(column: Array, s: Signals) -> tuple[Array, Array, Array]:
    """(n,) for the step after each sample: time until the motion turns, slopes before and after.

    Where it turns the force may jump, and each side goes on as it came; all else is one line.
    """
    step, turn = s.step, s.step.copy()
    slope = np.diff(column, append=column[-1:]) / np.where(step > 0, step, 1.0)
    slope[step == 0] = 0.0
    before, after = slope.copy(), slope.copy()
    i, part = s.turns
    inner = (i > 0) & (step[i - 1] > 0) & (step[np.minimum(i + 1, len(s) - 1)] > 0)
    i = i[inner]
    turn[i] = part[inner] * step[i]
    before[i], after[i] = slope[i - 1], slope[i + 1]
    return turn, before, after


def _integral(
    t: Array, y: Array, turn: Array, before: Array, after: Array
) -> Callable[[Array], Array]:
    """The integral of one record's lines from its beginning to any times."""

    def start(i: Index, e: Array) -> Array:
        return e * (y[i] + 0.5 * e * before[i])

    def end(i: Index, e: Array) -> Array:
        return e * (y[i + 1] - 0.5 * e * after[i])

    every = np.arange(len(t) - 1)
    total = np.zeros(len(t))
    total[1:] = np.cumsum(start(every, turn[:-1]) + end(every, np.diff(t) - turn[:-1]))

    def until(u: Array) -> Array:
        i = np.clip(np.searchsorted(t, u, side="right") - 1, 0, len(t) - 2)
        e, rest = u - t[i], t[i + 1] - u
        return np.where(e <= turn[i], total[i] + start(i, e), total[i + 1] - end(i, rest))

    return until


EFFECT = Effect(
    name="force_smoothing",
    stage=Stage.SENSOR,
    slot=Slot.CHANNEL,
    title="force recorded as a moving average over a part of the motion's cycle",
    equation="F_rec(t) = mean of F from t - w T/2 to t + w T/2",
    source="Smith, The Scientist and Engineer's Guide to Digital Signal Processing (1997) ch. 15",
    validity="records smoothed one by one, each over the same part of its cycle",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="w", unit="1", title="window of the average over the cycle of the motion",
            low=0.0, high=0.5, start=0.1,
        ),
    ),
    apply=force_smoothing,
    order=1,
)  # fmt: skip
