"""When an amplifier over a log can be given another duty."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.mimic.levels import EQUAL
from erdctl.model.amplifier import Amplifier


@dataclass(frozen=True, eq=False)
class Clock:
    """When the samples of a log can be ticks, at which the amplifier is given a duty.

    t, starts : (n,) [s], (r + 1,)
    next : (n,) first sample at which a tick can follow one here; the end of the record if none
    elapsed : (n,) time since the latest sample after which a tick can be here [s], 0 for none
    """

    t: Array
    starts: Index
    next: Index
    elapsed: Array

    @classmethod
    def of(cls, signals: Signals, amplifier: Amplifier) -> Clock:
        """The clock of an amplifier over a log.

        Check: samples 0 to 3 every 3 ms, 200 Hz: a tick at 0 can be followed by one at 2, and one
        at 1 by one at 3, 6 ms later.
        >>> every = signals(np.zeros(4), step=0.003)
        >>> clock = Clock.of(every, Amplifier(update_rate=200.0))
        >>> clock.next[:2].tolist(), (1e3 * clock.elapsed[2:]).round(6).tolist()
        ([2, 3], [6.0, 6.0])
        """
        t, starts = signals.t, signals.starts
        index = np.arange(len(t))
        following = index + 1
        if amplifier.update_rate is not None:
            period = 1.0 / amplifier.update_rate
            for a, b in pairwise(starts.tolist()):
                part = t[a:b]
                # Logged times are rounded: a log at the update rate itself has a tick a sample.
                slack = EQUAL * period + 2.0 * float(np.spacing(np.abs(part[[0, -1]]).max()))
                soonest = np.searchsorted(part, part + (period - slack)) + a
                following[a:b] = np.maximum(soonest, following[a:b])
        first = np.repeat(starts[:-1], np.diff(starts))
        before = np.searchsorted(following, index, side="right") - 1
        return cls(t, starts, following, t - t[np.maximum(before, first)])
