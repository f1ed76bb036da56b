"""What a log excites: the measures of its motion and control that decide what it can show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from erdctl.bench.accelerations import Accelerations
from erdctl.bench.counts import Counts, Excitation
from erdctl.core.blocks import SETTLE
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.core.stretches import stretches

__all__ = ["ENOUGH", "NO_STEP", "SAME_LEVEL", "Excitation", "Survey", "null_control"]

ENOUGH = 10  # samples of a kind below which there is no telling anything
SAME_LEVEL = 1.05  # duties within this ratio are one level with a noisy record of it
NO_STEP = 1.002  # duties within this ratio tell nothing from each other
S = TypeVar("S", Counts, Accelerations)


@dataclass(frozen=True, eq=False)
class Survey:
    """What a log offers, each measure taken when it is first asked for."""

    counted: Callable[[], Counts]
    accelerated: Callable[[], float]

    @classmethod
    def of(cls, recording: Recording) -> Survey:
        """The survey of a recording; its force is not looked at."""

        def surveyed(kind: type[S]) -> S:
            found = kind(recording.starts)
            for part in stretches(recording):
                found.add(part)
            return found

        return cls(lambda: surveyed(Counts), lambda: surveyed(Accelerations).beyond_a_spring())

    @cached_property
    def counts(self) -> Counts:
        """All that is counted in one go."""
        return self.counted()

    @cached_property
    def directions(self) -> dict[str, Excitation]:
        """The excitation of each direction."""
        return self.counts.directions()

    @property
    def reversals(self) -> int:
        """Changes of the direction of motion."""
        return self.counts.reversals

    @property
    def field(self) -> int:
        """Samples with a duty above zero."""
        return self.counts.field

    @cached_property
    def levels(self) -> int:
        """Duty levels above zero that lie clearly apart, each held for some samples."""
        found, last = 0, 0.0
        for level in np.flatnonzero(self.counts.percents >= ENOUGH).tolist():
            if level > last * SAME_LEVEL:
                found, last = found + 1, float(level)
        return found

    @property
    def steps(self) -> float:
        """Widest range of the duty within a record [1]."""
        return self.counts.steps[0]

    @property
    def speeds(self) -> float:
        """Standard deviation of the speed over its mean [1]; 0 at rest."""
        return self.counts.speeds[0].scatter

    @property
    def warming(self) -> float:
        """Range of the temperature [degC]; 0 where it is not logged."""
        return self.counts.temperature.range

    @property
    def stroke(self) -> float:
        """Range of the deflection [m]."""
        return self.counts.x[0].range

    @property
    def speed(self) -> float:
        """Highest speed, in either direction [m/s]."""
        return max(abs(self.counts.xdot.low), abs(self.counts.xdot.high))

    @property
    def duty(self) -> float:
        """Highest duty [1]."""
        return self.counts.duty.high

    @property
    def longest(self) -> float:
        """Length of the longest record [s]."""
        return self.counts.longest

    @cached_property
    def acceleration(self) -> float:
        """Effective value of the acceleration that is no multiple of deflection or speed [m/s^2].

            min over a, b, c of  rms(d2x/dt2 - a x - b xdot - c),  a, b, c per direction

        At one frequency d2x/dt2 = -omega^2 x, which a spring takes up: 0 then.
        """
        return self.accelerated()


def null_control(signals: Signals) -> npt.NDArray[np.bool_]:
    """(n,) samples at zero duty with the yield force of an earlier duty gone."""
    return np.asarray((signals.duty == 0.0) & (signals.since_duty_step > SETTLE))
