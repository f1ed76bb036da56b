"""How an amplifier takes a wanted duty: a causal hold, the one place that makes what is written.

A *tick* is a sample at which the amplifier is given a duty; from one to the next it holds. Ticks of
a record are at least 1 / update_rate apart, and a record starts at its first duty. At a tick the
duty moves towards the wanted one by at most

    slew * (time since the latest sample at which the last tick could have been)

so by no more than the time since the previous change allows, and never by a leap after a long rest,
which no slewing amplifier can do either. Steps of the resolution stay within these bounds; where a
tick is too short for a whole step, it is due when slew * (time since the previous change) is one.

While no fault acts the wanted duty is the healthy one as given, which comes through bit for bit
where it keeps the limits itself: ticks are then where it changes. While a fault acts, ticks follow
each other as fast as the update rate allows. After a fault they lead back to the healthy duty, at
the moments of its own changes where those are near, so that its phase is met again.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.mimic.clock import Clock
from erdctl.mimic.levels import EQUAL, DutyLevels
from erdctl.mimic.outcome import Flags
from erdctl.model.amplifier import Amplifier


@dataclass(frozen=True, eq=False)
class CausalHold:
    """How one amplifier takes duties over a log.

    healthy : (n,) duty without a fault, as the amplifier carries it out
    acting : (n,) some fault acts;  ticks : (n,) the amplifier is given a duty
    """

    clock: Clock
    levels: DutyLevels
    slew: float
    healthy: Array
    acting: Flags
    ticks: Flags

    @classmethod
    def of(cls, signals: Signals, amplifier: Amplifier, acting: Flags) -> CausalHold:
        """The hold of an amplifier; the signals' duty is the healthy control, as given."""
        clock, levels = Clock.of(signals, amplifier), DutyLevels.of(amplifier, signals.t)
        healthy = carried_out(signals.duty, clock, levels, amplifier.slew)
        if amplifier.update_rate is None:
            ticks = np.ones(len(signals), dtype=bool)
        else:
            ticks = _ticks(clock, healthy, acting, lingers=np.isfinite(amplifier.slew))
        return cls(clock, levels, amplifier.slew, healthy, acting, ticks)

    @cached_property
    def unstepped(self) -> CausalHold:
        """The same without the resolution, for what a small change would do."""
        return replace(self, levels=replace(self.levels, step=0.0))

    @cached_property
    def reach(self) -> Array:
        """(n,) change that a tick can make [1]."""
        if np.isinf(self.slew):
            return np.full(len(self.healthy), np.inf)
        return self.slew * self.clock.elapsed

    @cached_property
    def moments(self) -> Flags:
        """(n,) samples at which a fault acts and the amplifier is given a duty for it."""
        return self.ticks & self.acting

    def wanted(self, duty: Array) -> Array:
        """(n,) what the amplifier is to be given at each sample if it could be."""
        levels = self.levels.nearest(duty)
        # A fault that needs no change makes none, not even by rounding.
        needless = np.abs(levels - self.healthy) <= max(EQUAL, 1e-6 * self.levels.step)
        return np.where(self.acting & ~needless, levels, self.healthy)

    def follow(self, duty: Array) -> Array:
        """(n,) what the amplifier makes of a wanted duty while a fault acts, and healthy else."""
        wanted = self.wanted(duty)
        if np.isfinite(self.slew):
            wanted = self._slewed(wanted)
        elif self.ticks.all():
            return wanted
        at = np.where(self.ticks, np.arange(len(wanted)), 0)
        return self._released(wanted[np.maximum.accumulate(at)])

    @cached_property
    def _released_at(self) -> list[tuple[int, int, int]]:
        """First healthy sample after each fault, the next tick, and the start of the record."""
        if self.ticks.all():
            return []
        first = np.flatnonzero(self.acting[:-1] & ~self.acting[1:]) + 1
        starts = self.clock.starts
        first = first[~np.isin(first, starts)]
        record = np.searchsorted(starts, first, side="right") - 1
        ticks = np.append(np.flatnonzero(self.ticks), len(self.ticks))
        until = np.minimum(ticks[np.searchsorted(ticks, first)], starts[record + 1])
        return list(zip(first.tolist(), until.tolist(), starts[record].tolist(), strict=True))

    def _released(self, out: Array) -> Array:
        """`out` (n,), but a tick of a fault that changed nothing holds nothing after its end."""
        following, healthy = self.clock.next, self.healthy
        for a, b, start in self._released_at:
            held = float(out[a])
            moved = np.flatnonzero(healthy[a:b] != held)
            if not moved.size:
                continue
            h = a + int(moved[0])
            changed = np.flatnonzero(out[start + 1 : a] != out[start : a - 1])
            last = start + 1 + int(changed[-1]) if changed.size else start
            if following[last] > h or healthy[h - 1] != held:
                continue
            ends = b in self.clock.starts
            again = h + int(np.append(0, np.flatnonzero(np.diff(healthy[h:b])) + 1)[-1])
            if ends or (
                ((out[b] == healthy[b] and not self.acting[b]) or following[again] <= b)
                and self.levels.within(abs(out[b] - healthy[b - 1]), self.reach[b])
            ):
                out[h:b] = healthy[h:b]
        return out

    def _slewed(self, wanted: Array) -> Array:
        """(n,) `wanted` at ticks as the slew limit lets it be; other samples are not touched."""
        out = wanted.copy()
        at = np.flatnonzero(self.ticks)
        towards, slew = self.levels.towards, self.slew
        begins = np.zeros(len(wanted), dtype=bool)
        begins[self.clock.starts[:-1]] = True
        rows = zip(
            at.tolist(), wanted[at].tolist(), self.reach[at].tolist(), begins[at].tolist(),
            self.clock.t[at].tolist(), strict=True,
        )  # fmt: skip
        last, changed = 0.0, 0.0
        for i, target, reach, begin, t in rows:
            if begin:
                last, changed = target, t
            elif target != last:
                found = towards(last, target, reach, slew * (t - changed))
                if found != last:
                    last, changed = found, t
                out[i] = last
        return out


def carried_out(given: Array, clock: Clock, levels: DutyLevels, slew: float) -> Array:
    """(n,) what an amplifier makes of a given duty (n,): the same, bit for bit, where it can.

    It is given another duty where that changes, or as soon after as it can be.
    """
    wanted = levels.given(given)
    change = np.flatnonzero(wanted[1:] != wanted[:-1]) + 1
    change = change[~np.isin(change, clock.starts)]
    at = np.union1d(change, clock.starts[:-1])
    previous = at[np.searchsorted(at, change) - 1]
    size = np.abs(wanted[change] - wanted[change - 1])
    possible = clock.next[previous] <= change
    if np.isfinite(slew):
        possible &= size <= slew * clock.elapsed[change] * (1.0 + EQUAL) + levels.rounding
    if possible.all():
        return wanted
    out = wanted.copy()
    following, t, rows = clock.next.tolist(), clock.t.tolist(), wanted.tolist()
    elapsed = clock.elapsed.tolist()
    for a, b in pairwise(clock.starts.tolist()):
        last, tick = rows[a], a
        for i in range(a + 1, b):
            if rows[i] != last and following[tick] <= i:
                found = levels.towards(last, rows[i], slew * elapsed[i], slew * (t[i] - t[tick]))
                if found != last:
                    last, tick = found, i
            out[i] = last
    return out


def _ticks(clock: Clock, healthy: Array, acting: Flags, *, lingers: bool) -> Flags:
    """(n,) samples at which an amplifier with an update rate is given a duty.

    lingers : one tick after a fault may not be enough to be back at the healthy duty
    """
    out = np.zeros(len(healthy), dtype=bool)
    following, acts = clock.next.tolist(), acting.tolist()
    for a, b in pairwise(clock.starts.tolist()):
        changes = _edges(healthy[a:b], a)
        onsets = [i for i in _edges(acting[a:b], a) if acts[i]]
        tick, away = a, acts[a]
        while True:
            out[tick] = True
            soonest = following[tick]
            if soonest >= b:
                break
            away = acts[tick] or (away and lingers)
            change = _first(changes, soonest, b)
            if acts[soonest]:
                tick = soonest
            elif away:
                # A tick that the next change of the healthy duty would come too soon after.
                onset = _first(onsets, soonest, b)
                tick = change if change < min(following[soonest], onset) else soonest
            else:
                tick = min(change, _first(onsets, soonest, b))
                if tick >= b:
                    break
    return out


def _edges(values: Array | Flags, offset: int) -> list[int]:
    """Samples at which a value is not that of the sample before; `offset` is that of the first."""
    found: list[int] = (np.flatnonzero(values[1:] != values[:-1]) + 1 + offset).tolist()
    return found


def _first(sorted_: list[int], least: int, none: int) -> int:
    """The first entry that is not below `least`, or `none`."""
    k = bisect_left(sorted_, least)
    return sorted_[k] if k < len(sorted_) else none


def follow(wanted: Array, signals: Signals, amplifier: Amplifier) -> Array:
    """What an amplifier makes of a duty (n,) that it is given."""
    clock, levels = Clock.of(signals, amplifier), DutyLevels.of(amplifier, signals.t)
    return carried_out(wanted, clock, levels, amplifier.slew)
