"""The duties that an amplifier knows, and the way from one to another."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from erdctl.core.recording import Array
from erdctl.model.amplifier import Amplifier

EQUAL = 1e-9  # parts of a time or of a step that differ by rounding only
ON_GRID = 1e-6  # of a step of the resolution: a given duty that is this near is on it


@dataclass(frozen=True)
class DutyLevels:
    """The duties that an amplifier knows: 0 to `top`, in steps of the resolution (0 for none).

    rounding : change that the slew limit allows by the rounding of logged times alone
    """

    top: float
    step: float
    rounding: float = 0.0

    @classmethod
    def of(cls, amplifier: Amplifier, t: Array) -> DutyLevels:
        """The levels of an amplifier over times t (n,) [s].

        The highest is the last step below its ceiling.
        """
        step, top, slew = amplifier.resolution, amplifier.duty_max, amplifier.slew
        # Two times, each rounded: 1e-10 s at the clock of a bench that has run for days.
        rounding = 2.0 * slew * float(np.spacing(np.abs(t).max())) if np.isfinite(slew) else 0.0
        if step:
            top = float(_of_steps(np.floor(top / step + EQUAL), step))
        return cls(top, step, rounding)

    def within(self, change: float, allowed: float) -> bool:
        """Whether a change is one that is allowed, but for rounding."""
        return change <= allowed * (1.0 + EQUAL) + self.rounding

    def nearest(self, wanted: Array) -> Array:
        """(n,) the level nearest to each wanted duty."""
        inside = np.clip(wanted, 0.0, self.top)
        if not self.step:
            return inside
        return np.asarray(np.minimum(_of_steps(np.rint(inside / self.step), self.step), self.top))

    def one(self, wanted: float) -> float:
        """`nearest` of a single duty."""
        inside = min(max(wanted, 0.0), self.top)
        return (
            min(_of_steps(round(inside / self.step), self.step), self.top) if self.step else inside
        )

    def given(self, duty: Array) -> Array:
        """(n,) `nearest`, but a given duty that is a level but for rounding stays as it is."""
        found = self.nearest(duty)
        near = (np.abs(found - duty) <= ON_GRID * self.step) & (duty <= self.top * (1.0 + 1e-12))
        return np.where(near, duty, found)

    def towards(self, last: float, target: float, reach: float, patience: float) -> float:
        """The level that follows `last` on the way to the level `target`.

        reach : change that is allowed;  patience : change that the time since the last one allows
        """
        way = target - last
        if self.within(abs(way), reach):
            return target
        if not self.step:
            return last + math.copysign(reach * (1.0 - 1e-12), way)
        # `last` may be a given duty that is a level but for rounding: the change counts, not steps.
        at, up = round(last / self.step), 1 if way > 0 else -1
        for steps in range(math.floor((reach + self.rounding) / self.step + EQUAL), 0, -1):
            found = float(_of_steps(at + up * steps, self.step))
            if self.within(abs(found - last), reach):
                return found
        found = float(_of_steps(at + up, self.step))
        if abs(target - found) <= ON_GRID * self.step:
            found = target
        return found if self.within(abs(found - last), patience) else last


def _of_steps(count: Any, step: float) -> Any:
    """count * step; of a decimal step the decimal: 3 * 0.1 is 0.3, not 0.30000000000000004."""
    parts = round(1.0 / step)
    return count / parts if abs(parts * step - 1.0) < EQUAL else count * step
