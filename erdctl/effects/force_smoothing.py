"""Force recorded as a moving average over a part of the motion's cycle.

    F_rec(t) = 1/W integral of F from t - W/2 to t + W/2,   W = w T,   T = 2 pi rms(x) / rms(xdot)

F, F_rec : (n,) force of the damper, and as recorded [N];  T : cycle of a record's motion [s], its
period if that is a sine, from x less its mean over time;  w : window over cycle [1], 0..0.5, off
at 0
Straight lines between samples, and a jump where the motion turns; towards the ends of a record the
window shrinks. Every jump at a reversal becomes a ramp that takes the same part of each cycle,
whatever the stroke, the speed and the force: no law of the damper does that.
Valid for records that were smoothed one by one, slow tests over longer times than fast ones, before
they were stored; a window of the same time throughout looks alike where all have one cycle.
Check: xdot > 0 throughout, samples 1 s apart, F = 0, 4, 8, 0, 0 N, W = 2 s gives 0, 4, 5, 2, 0 N.
>>> x = np.array([1.0, -1.0, 1.0, -1.0, 0.0]) * 1.25**0.5  # rms 1, as that of xdot: T = 2 pi s
>>> s = signals(np.ones(5), x=x, step=1.0)
>>> force_smoothing(np.array([0.0, 4.0, 8.0, 0.0, 0.0]), s, {"w": 1 / np.pi}).round(9).tolist()
[0.0, 4.0, 5.0, 2.0, 0.0]

Source: S. W. Smith, The Scientist and Engineer's Guide to Digital Signal Processing (1997), ch. 15
(moving average).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ChannelSlot, Values

LAGS = (1, 2, 3, 5, 8, 13, 21, 34)  # samples over which changes of the force are looked at
FEWEST_TURNS = 4  # of a record that says how wide a window can be
FLATTENED = 1.25  # of over 100 logs of the plant with another effect beside it one asked for 1.04
LOOKED_AT = 200_000  # samples of a record from its beginning: enough turns
FINEST = 1e-9  # of a log: a window narrower than that is lost in rounding


def force_smoothing(column: Array, s: Signals, p: Values) -> Array:
    """(n,) the column as the smoothed force channel shows it."""
    if p["w"] == 0.0:
        return column
    lines, windows = _lines(s.motion), _windows(s.motion, p["w"])
    y = lines.values(column)
    until = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(lines.clock))])
    low, high = (until[i] + a * y[i] + b * y[i + 1] for i, a, b in (windows.low, windows.high))
    out = column.copy()
    out[windows.wide] = (high - low) / windows.width
    return out


class _Lines(NamedTuple):
    """The force as straight lines between nodes: the samples, and two more at each turn.

    Where the motion turns the force may jump, and each side goes on as it came.

    clock : (m,) time of the nodes, records in a row [s];  sample : (n,) the nodes that are samples
    turn : (k,) samples before a turn;  ahead, behind : (k,) how far lines are drawn on to the turn
    from the two samples before it and the two after it [1]
    """

    clock: Array
    sample: Index
    turn: Index
    ahead: Array
    behind: Array

    def values(self, column: Array) -> Array:
        """(m,) of the nodes."""
        y, i = np.empty(len(self.clock)), self.turn
        y[self.sample] = column
        y[self.sample[i] + 1] = column[i] + self.ahead * (column[i] - column[i - 1])
        y[self.sample[i] + 2] = column[i + 1] - self.behind * (column[i + 2] - column[i + 1])
        return y


@lru_cache(maxsize=1)
def _lines(s: Signals) -> _Lines:
    """The same for every column of a fit."""
    n, step = len(s), s.step
    i, part = s.turns
    near = np.minimum(i + 1, n - 1)
    inner = (i > 0) & (step[i - 1] > 0) & (step[near] > 0)
    i, part, near = i[inner], part[inner], near[inner]
    sample = np.arange(n) + 2 * np.searchsorted(i, np.arange(n))
    time = np.concatenate([[0.0], np.cumsum(step[:-1])])
    clock = np.empty(n + 2 * len(i))
    clock[sample] = time
    clock[sample[i] + 1] = clock[sample[i] + 2] = time[i] + part * step[i]
    ahead, behind = part * step[i] / step[i - 1], (1.0 - part) * step[i] / step[near]
    return _Lines(clock, sample, i, ahead, behind)


Weights = tuple[Index, Array, Array]  # nodes before some times, what they and the next weigh since


class _Windows(NamedTuple):
    """Windows of samples that have one: which do, how long, from when, until when."""

    wide: Index
    width: Array
    low: Weights
    high: Weights


@lru_cache(maxsize=1)
def _windows(s: Signals, w: float) -> _Windows:
    """The same for every column of a fit."""
    lines = _lines(s)
    t = lines.clock[lines.sample]
    first, last, records = s.starts[:-1], s.starts[1:] - 1, np.diff(s.starts)
    begin, end = np.repeat(t[first], records), np.repeat(t[last], records)
    half = np.minimum(np.minimum(t - begin, end - t), 0.5 * w * np.repeat(_cycles(s), records))
    wide = np.flatnonzero(half > FINEST * t[-1])
    low, high = t[wide] - half[wide], t[wide] + half[wide]
    return _Windows(wide, high - low, _weights(lines.clock, low), _weights(lines.clock, high))


def _weights(clock: Array, times: Array) -> Weights:
    i = np.clip(np.searchsorted(clock, times, side="right") - 1, 0, len(clock) - 2)
    since, whole = times - clock[i], clock[i + 1] - clock[i]
    later = 0.5 * since**2 / np.where(whole > 0, whole, 1.0)
    return i, since - later, later


def _cycles(s: Signals) -> Array:
    """(r,) cycle of the motion of each record [s]; 0 if it has none, as nothing turns then.

    Means are over time: samples may lie closer where the motion turns.
    """
    first, count = s.starts[:-1], np.diff(s.starts)
    after, before = s.step.copy(), np.concatenate([[0.0], s.step[:-1]])
    last = s.starts[1:] - 1
    after[last], before[first] = before[last], after[first]
    dt = 0.5 * (before + after)  # the same for all samples where the log is even

    def sums(values: Array) -> Array:
        return np.add.reduceat(dt * values, first)

    lasting = sums(np.ones_like(dt))
    mean = np.repeat(sums(s.x) / np.where(lasting > 0, lasting, np.inf), count)
    travel, speed = sums((s.x - mean) ** 2), sums(s.xdot**2)
    return 2.0 * np.pi * np.sqrt(travel / np.where(speed > 0, speed, np.inf))


def widest(s: Signals, force: Array) -> dict[str, float]:
    """The widest window that lets the force change as fast as it does where the motion turns.

        |F_rec(t + d) - F_rec(t)| <= R d / W,   R sin(pi w) / (pi w) <= FLATTENED R_rec

    R, R_rec : range of the force of a record, before and behind the average

    The first holds whatever the damper does, as windows that lie d apart share all but d at either
    end. Of every half cycle counts the largest change, less what noise adds to it, of a record the
    median of these: neither a knock nor an outlier rules an average out. The second is that of a
    sine and a quarter more for narrower peaks, and fails where some stand above that.
    """
    turns, cycles = s.turns[0], _cycles(s)
    found = [np.inf]
    for first, last, cycle in zip(s.starts[:-1], s.starts[1:], cycles, strict=True):
        end = min(last, first + LOOKED_AT)
        turn = turns[(turns >= first) & (turns < end - 1)] - first
        if len(turn) >= FEWEST_TURNS and cycle > 0.0:
            changes = _steepest(s.t[first:end], force[first:end], turn, 0.05 * cycle)
            found += [np.ptp(force[first:end]) * d / (cycle * change) for d, change in changes]
    sine = np.pi * FLATTENED * min(found)
    return {"w": float(np.arcsin(sine) / np.pi)} if sine < 1.0 else {}


def narrowest(s: Signals, force: Array) -> dict[str, float]:
    """The narrowest window that samples show: two steps, of the record in the middle.

    Over less a sample is averaged with its neighbours alone, by a quarter each at most. That is no
    average of a recorder: it takes of the noise that the modelled force has of the velocity, where
    it is steep.
    """
    cycles, count = _cycles(s), np.diff(s.starts)
    moving = np.flatnonzero(cycles > 0.0)
    if not len(moving):
        return {}
    steps = [float(np.median(s.step[s.starts[r] : s.starts[r + 1] - 1])) for r in moving]
    least = 2.0 * np.array(steps) / cycles[moving]
    order = np.argsort(least)
    half = np.searchsorted(np.cumsum(count[moving][order]), 0.5 * count[moving].sum())
    return {"w": min(float(least[order][half]), 0.5)}


def _steepest(t: Array, force: Array, turn: Index, longest: float) -> list[tuple[float, float]]:
    """Times [s] of some lags, and by how much the force changes within them at every turn [N]."""
    middle = np.concatenate([[0], (turn[1:] + turn[:-1]) // 2])
    out = []
    for lag in LAGS:
        if len(t) < 4 * lag or (d := float((t[lag:] - t[:-lag]).max())) > longest:
            break
        change = _lasting_change(force, lag)
        half = middle[middle < len(change)]
        bent = np.abs(force[2 * lag :] - 2.0 * force[lag:-lag] + force[: -2 * lag])
        # Noise in a change, from those of the slope: by a half more than white noise has.
        noise = 1.4826 * float(np.median(bent)) / np.sqrt(2.0)
        most = noise * (np.sqrt(2.0 * np.log(max(len(change) / len(half), 2.0))) + 1.0)
        sure = float(np.median(np.maximum.reduceat(change, half))) - most
        if sure > 0.0:
            out.append((d, sure))
    return out


def _lasting_change(force: Array, lag: int) -> Array:
    """(n - lag,) by how much a force (n,) changes at the least from either of two samples to either
    of two, lag and more later [N]: noise of heavy tails has one outlier or the other in every half
    cycle, and no sample beside it like it.

    Check: a jump of 1 stays, a single sample of 5 does not.
    >>> _lasting_change(np.array([0.0, 0.0, 1.0, 1.0, 1.0, 5.0, 1.0, 1.0]), 1).tolist()
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    out = np.zeros(len(force) - lag)
    ends = force[1 + lag : -1], force[2 + lag :]
    begins = force[1 : -1 - lag], force[: -2 - lag]
    changes = np.array([e - b for e in ends for b in begins])
    out[1:-1] = np.maximum(np.maximum(changes.min(axis=0), -changes.max(axis=0)), 0.0)
    return out


EFFECT = Effect(
    name="force_smoothing",
    stage=Stage.SENSOR,
    slot=ChannelSlot(force_smoothing),
    title="force recorded as a moving average over a part of the motion's cycle",
    equation="F_rec(t) = mean of F from t - w T/2 to t + w T/2",
    said="{w:%} of a cycle averaged",
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
    most=widest,
    least=narrowest,
    order=1,
)  # fmt: skip
