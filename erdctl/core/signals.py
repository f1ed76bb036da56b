"""What a model sees of a log: motion and control, with the derived quantities that it shares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from itertools import pairwise
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from erdctl.core.acceleration import acceleration
from erdctl.core.recording import DERIVED, Array, Index, Recording

# Steps that differ by less than this part of themselves are one sampling rate with rounded times.
JITTER = 1e-6
SLOW = 0.05  # of the highest speed in a record: at less it may be at rest, if it
LONG = 4.0  # times as long as at a turning point, and
STILL = 3  # samples
NEARLY = 0.02  # of its stroke, travels no further, as a slow motion would

T = TypeVar("T")


def _of_motion(derived: Callable[[Signals], T]) -> cached_property[T]:
    """A cached property of the motion alone, the same under any control."""

    @wraps(derived)
    def once(s: Signals) -> T:
        if s.first is None:
            return derived(s)
        known: T = getattr(s.first, derived.__name__)
        return known

    return cached_property(once)


@dataclass(frozen=True, eq=False)
class Signals:
    """Motion and control of one or more records.

    t, x, xdot, duty, step : (n,) time [s], deflection [m], velocity [m/s], duty cycle [1], time to
    the next sample [s] (0 at the end of a record);  starts : (r + 1,) offsets of the records
    engaged : (n,) part of a sample during which the piston moves with the rod [1], None for always;
        between 0 and 1 only where play in between runs out, so that the force does not jump from
        sample to sample as the play grows
    temperature : (n,) [degC] where the log has it
    sampled : all samples of the log, and which of them these are (n,), where they are not all; for
        what counts by samples
    begun : (r,) F_ER as each record begins [N], where that goes on from elsewhere; None for steady
    logged_step : step of the log between whose samples these were made up [s], 0 where none was
    sharp : whether a sample is engaged or not, and never in part
    first : signals of the same motion under another control, which have what is derived from it
    derived : whether xdot is that of x, and of no sensor
    """

    t: Array
    x: Array
    xdot: Array
    duty: Array
    step: Array
    starts: Index
    engaged: Array | None = None
    temperature: Array | None = None
    sampled: tuple[Signals, Index] | None = None
    begun: Array | None = None
    logged_step: float = 0.0
    sharp: bool = False
    first: Signals | None = None
    derived: bool = False

    @classmethod
    def of(cls, recording: Recording) -> Signals:
        """The signals of a recording."""
        r = recording
        return cls(
            t=r.t, x=r.x, xdot=r.xdot, duty=r.duty, step=r.step, starts=r.starts,
            temperature=r.temperature, derived=r.xdot_note.startswith(DERIVED),
        )  # fmt: skip

    def __len__(self) -> int:
        return len(self.t)

    def at(self, rows: Index, recording: Recording) -> Signals:
        """The signals of some samples, taken from a recording of those alone."""
        whole, of = self.sampled or (self, np.arange(len(self)))
        return replace(Signals.of(recording), sampled=(whole, of[rows]))

    def with_duty(self, duty: Array) -> Signals:
        """The same motion under another control."""
        return replace(self, duty=duty, first=self.motion)

    def with_motion(self, x: Array, xdot: Array, engaged: Array | None = None) -> Signals:
        """The same control under another motion."""
        return replace(self, x=x, xdot=xdot, engaged=engaged, first=None)

    @property
    def motion(self) -> Signals:
        """The same object for all signals of one motion: a key to what is derived from it."""
        return self if self.first is None else self.first

    @_of_motion
    def step_before(self) -> Array:
        """(n,) time since the sample before [s], 0 at the first of a record."""
        before = np.concatenate([[0.0], self.step[:-1]])[: len(self)]
        before[self.starts[:-1]] = 0.0
        return before

    @_of_motion
    def sign(self) -> Array:
        """(n,) sign(xdot) of Eq. 18, 0 at rest; a part of it where play runs out."""
        sign: Array = np.sign(self.xdot)
        return sign if self.engaged is None else sign * self.engaged

    @_of_motion
    def compressing(self) -> npt.NDArray[np.bool_]:
        """(n,) direction whose parameters apply.

        xdot > 0 is compression, xdot < 0 release; at xdot = 0 the last direction holds, and a
        record that begins at rest takes its first direction of motion (compression if it has none).
        """
        up = self.xdot > 0
        still = self.xdot == 0
        if not still.any():
            return up
        index = np.arange(len(self))
        lengths = np.diff(self.starts)
        first, end = np.repeat(self.starts[:-1], lengths), np.repeat(self.starts[1:], lengths)
        last = np.maximum.accumulate(np.where(still, -1, index))
        ahead = np.minimum.accumulate(np.where(still, len(self), index)[::-1])[::-1]
        to = np.where(last >= first, last, ahead)
        never = (last < first) & (ahead >= end)
        return np.where(never, True, up[np.minimum(to, len(self) - 1)])

    @_of_motion
    def rests(self) -> npt.NDArray[np.bool_]:
        """(r,) records that begin at rest; not those that begin as a motion turns, or slowly."""
        out = np.ones(len(self.starts) - 1, dtype=np.bool_)
        for r, (a, b) in enumerate(pairwise(self.starts.tolist())):
            speed = np.abs(self.xdot[a:b])
            moving = speed > SLOW * float(speed.max(initial=0.0))
            if not moving.any():
                continue
            first = int(np.argmax(moving))
            stroke = float(np.ptp(self.x[a:b]))
            # At a turning point of x = A sin(w t) the speed is SLOW w A after SLOW / w.
            turning = SLOW * float(np.std(self.x[a:b])) / float(np.sqrt(np.mean(speed**2)))
            waited = float(self.t[a + first] - self.t[a])
            way = float(np.dot(speed[:first], self.step[a : a + first]))
            out[r] = first > STILL and waited > LONG * turning and way < NEARLY * stroke
        return out

    @_of_motion
    def turns(self) -> tuple[Index, Array]:
        """Steps in which the direction changes, and the part of each that passes before it does.

        Returns (k,) indices i with a change between samples i and i + 1, and (k,) fractions of
        the step, from the straight line between the two velocities.
        """
        up = self.compressing
        i = np.flatnonzero(up[1:] != up[:-1])
        if len(self.starts) > 2:
            within = np.ones(len(up), dtype=np.bool_)
            within[self.starts[1:-1] - 1] = False
            i = i[within[i]]
        before, after = self.xdot[i], self.xdot[i + 1]
        span = before - after
        safe = np.where(span == 0, 1.0, span)
        part = np.clip(np.where(span == 0, 0.0, before / safe), 0.0, 1.0)
        if self.engaged is not None:
            # From rest in the play the piston sets off when that runs out, not as the step begins.
            part = np.where(before == 0, np.minimum(1.5 - self.engaged[i + 1], 1.0), part)
        return i, part

    @_of_motion
    def path(self) -> tuple[Array, Array]:
        """Distance travelled in each step (n,), and after the turn in each of `turns` (k,) [m].

        From velocities that are straight lines between samples: noise in x adds nothing to it.
        """
        speed = np.abs(self.xdot)
        path = np.zeros(len(self))
        path[:-1] = 0.5 * (speed[:-1] + speed[1:]) * self.step[:-1]
        i, part = self.turns
        after: Array = 0.5 * speed[i + 1] * (1.0 - part) * self.step[i]
        path[i] = 0.5 * speed[i] * part * self.step[i] + after
        return path, after

    @_of_motion
    def path_since_reversal(self) -> Array:
        """(n,) distance since the direction last changed in this record [m]; inf before that."""
        path, after = self.path
        total = np.concatenate([[0.0], np.cumsum(path[:-1])])
        turned = self.turns[0] + 1
        origin = np.zeros(len(self))
        origin[turned] = total[turned] - after
        mark = np.full(len(self), -1)
        mark[turned] = turned
        last = np.maximum.accumulate(mark)
        first = np.repeat(self.starts[:-1], np.diff(self.starts))
        distance: Array = np.where(last >= first, total - origin[last], np.inf)
        return distance

    @_of_motion
    def xddot(self) -> Array:
        """(n,) acceleration [m/s^2], see `erdctl.core.acceleration`."""
        if self.sampled and np.array_equal(self.xdot, self.sampled[0].xdot[self.sampled[1]]):
            return self.sampled[0].xddot[self.sampled[1]]  # not of what lies farther apart
        return acceleration(
            self.t, self.xdot, self.starts,
            common=self.common_step, finest=self.finest_step, logged=self.logged_step,
        )  # fmt: skip

    @_of_motion
    def common_step(self) -> float | None:
        """The step of the whole log [s] if it is the same everywhere, else None."""
        inner = self.step[self.step > 0] if len(self.starts) > 2 else self.step[:-1]
        if inner.size == 0:
            return None
        low, high = float(inner.min()), float(inner.max())
        if high - low > JITTER * high:
            return None
        # The mean over a record, since each single step carries the rounding of its two times.
        a, b = int(self.starts[0]), int(self.starts[1]) - 1
        return float(self.t[b] - self.t[a]) / (b - a) if b > a else high

    @_of_motion
    def typical_step(self) -> float:
        """The step of most of the log [s]; 0 if no record has two samples."""
        if self.common_step is not None:
            return self.common_step
        inner = self.step[self.step > 0]
        return float(np.median(inner)) if inner.size else 0.0

    @_of_motion
    def finest_step(self) -> float:
        """The step where a log is dense [s], a tenth of it or more; 0 if no record has two samples.

        That of most of the log, unless this is dense in parts alone.
        """
        if self.common_step is not None:
            return self.common_step
        inner = self.step[self.step > 0]
        return float(np.quantile(inner, 0.1)) if inner.size else 0.0

    @cached_property
    def since_duty_step(self) -> Array:
        """(n,) time since the duty last changed in this record [s]; inf before it first does."""
        changed = np.empty(len(self), dtype=bool)
        np.not_equal(self.duty[1:], self.duty[:-1], out=changed[1:])
        changed[self.starts[:-1]] = False
        return self._since(changed)

    @_of_motion
    def since_reversal(self) -> Array:
        """(n,) time since the direction last changed in this record [s]; inf before that."""
        changed = np.zeros(len(self), dtype=bool)
        changed[self.turns[0] + 1] = True
        return self._since(changed)

    def _since(self, event: npt.NDArray[np.bool_]) -> Array:
        """(n,) time since the last event in the same record [s], inf before the first."""
        marks = event.copy()
        marks[self.starts[:-1]] = True
        at = np.flatnonzero(marks)
        last = np.where(event[at], self.t[at], -np.inf)
        since: Array = np.repeat(last, np.diff(at, append=len(self)))
        np.subtract(self.t, since, out=since)
        return since

    def per_direction(self, compression: float, release: float) -> Array | float:
        """The value that applies at each sample: (n,), or one number if both are equal."""
        if compression == release:
            return compression
        if self.engaged is None:
            return np.where(self.compressing, compression, release)
        return release + (compression - release) * self._share

    def split(self, column: Array) -> tuple[Array, Array]:
        """(n,) that part of a column that belongs to compression, and that of release."""
        if self.engaged is None:
            return np.where(self.compressing, column, 0.0), np.where(self.compressing, 0.0, column)
        return column * self._share, column * (1.0 - self._share)

    @_of_motion
    def _share(self) -> Array:
        """(n,) part of each sample that belongs to compression, where `engaged` is given."""
        up = self.compressing.astype(float)
        last = np.concatenate([up[:1], up[:-1]])
        last[self.starts[:-1]] = up[self.starts[:-1]]
        share: Array = last + (up - last) * (1.0 if self.engaged is None else self.engaged)
        return share
