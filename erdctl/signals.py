"""What a model sees of a log: motion and control, with the derived quantities that it shares."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.recording import Array, Index, Recording

# Steps that differ by less than this part of themselves are one sampling rate with rounded times.
JITTER = 1e-6


@dataclass(frozen=True, eq=False)
class Signals:
    """Motion and control of one or more records.

    t, x, xdot, duty, step : (n,) time [s], deflection [m], velocity [m/s], duty cycle [1], time to
    the next sample [s] (0 at the end of a record);  starts : (r + 1,) offsets of the records
    """

    t: Array
    x: Array
    xdot: Array
    duty: Array
    step: Array
    starts: Index

    @classmethod
    def of(cls, recording: Recording) -> Signals:
        """The signals of a recording."""
        r = recording
        return cls(t=r.t, x=r.x, xdot=r.xdot, duty=r.duty, step=r.step, starts=r.starts)

    def __len__(self) -> int:
        return len(self.t)

    def with_duty(self, duty: Array) -> Signals:
        """The same motion under another control."""
        return replace(self, duty=duty)

    def with_motion(self, x: Array, xdot: Array) -> Signals:
        """The same control under another motion."""
        return replace(self, x=x, xdot=xdot)

    @cached_property
    def compressing(self) -> npt.NDArray[np.bool_]:
        """(n,) direction whose parameters apply.

        xdot > 0 is compression, xdot < 0 release; at xdot = 0 the last direction holds, and a
        record that begins at rest takes its first direction of motion (compression if it has none).
        """
        up = self.xdot > 0
        still = self.xdot == 0
        if not still.any():
            return up
        for a, b in pairwise(self.starts.tolist()):
            moving = np.flatnonzero(~still[a:b])
            if moving.size == 0:
                up[a:b] = True
            elif moving.size < b - a:
                last = np.maximum(np.searchsorted(moving, np.arange(b - a), side="right") - 1, 0)
                up[a:b] = up[a:b][moving[last]]
        return up

    @cached_property
    def turns(self) -> tuple[Index, Array]:
        """Steps in which the direction changes, and the part of each that passes before it does.

        Returns (k,) indices i with a change between samples i and i + 1, and (k,) fractions of
        the step, from the straight line between the two velocities.
        """
        up = self.compressing
        i = np.flatnonzero(up[1:] != up[:-1])
        if len(self.starts) > 2:
            i = i[~np.isin(i, self.starts[1:-1] - 1)]
        before, after = self.xdot[i], self.xdot[i + 1]
        span = before - after
        safe = np.where(span == 0, 1.0, span)
        return i, np.clip(np.where(span == 0, 0.0, before / safe), 0.0, 1.0)

    @cached_property
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

    @cached_property
    def since_duty_step(self) -> Array:
        """(n,) time since the duty last changed in this record [s]; inf before it first does."""
        changed = np.empty(len(self), dtype=bool)
        np.not_equal(self.duty[1:], self.duty[:-1], out=changed[1:])
        changed[self.starts[:-1]] = False
        return self._since(changed)

    @cached_property
    def since_reversal(self) -> Array:
        """(n,) time since the direction last changed in this record [s]; inf before that."""
        changed = np.zeros(len(self), dtype=bool)
        changed[self.turns[0] + 1] = True
        return self._since(changed)

    def _since(self, event: npt.NDArray[np.bool_]) -> Array:
        """(n,) time since the last event in the same record [s], inf before the first."""
        mark = np.where(event, np.arange(len(self)), -1)
        out = np.full(len(self), np.inf)
        for a, b in pairwise(self.starts.tolist()):
            last = np.maximum.accumulate(mark[a:b])
            seen = last >= 0
            out[a:b][seen] = self.t[a:b][seen] - self.t[last[seen]]
        return out

    def per_direction(self, compression: float, release: float) -> Array | float:
        """The value that applies at each sample: (n,), or one number if both are equal."""
        if compression == release:
            return compression
        return np.where(self.compressing, compression, release)
