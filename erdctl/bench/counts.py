"""What is counted of the motion and control of a log, one stretch after the other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.core.blocks import SETTLE
from erdctl.core.cache import parts
from erdctl.core.recording import DIRECTIONS, Array, Index
from erdctl.core.signals import Signals
from erdctl.core.stretches import Stretch
from erdctl.score.nrmse import BINS, bins, percents

MOST = 400_000  # samples that the levels of the duty are told from, evenly out of a longer log


@dataclass(frozen=True)
class Excitation:
    """What one direction of motion of a log offers.

    moving, null, field : samples that move this way; of those, settled without field; with field
    levels : lowest and highest duty above zero (1st and 99th percentile), 0 if there is none
    steps : widest range of the duty within a record in which the piston moves this way [1]
    stroke, speeds : spread of x [m], and of the speed relative to its mean [1]
    """

    moving: int
    null: int
    field: int
    levels: tuple[float, float]
    steps: float
    stroke: float
    speeds: float

    @property
    def ratio(self) -> float:
        """Highest over lowest duty above zero [1]; 0 without a field."""
        return self.levels[1] / self.levels[0] if self.levels[0] > 0 else 0.0


class Ends:
    """Lowest and highest of all values."""

    def __init__(self) -> None:
        self.low, self.high = math.inf, -math.inf

    def add(self, values: Array) -> None:
        """More values, or none."""
        self.low = float(values.min(initial=self.low))
        self.high = float(values.max(initial=self.high))

    @property
    def range(self) -> float:
        """How far they are apart; 0 of none."""
        return max(self.high - self.low, 0.0)


class _Speeds:
    """Sums of speeds |xdot|."""

    def __init__(self) -> None:
        self.samples, self.total, self.squares = 0, 0.0, 0.0

    def add(self, xdot: Array, chosen: npt.NDArray[np.bool_] | None = None) -> None:
        for part in parts(len(xdot)):
            speed = np.abs(xdot[part] if chosen is None else xdot[part][chosen[part]])
            self.samples, self.total = self.samples + len(speed), self.total + float(speed.sum())
            self.squares += float(speed @ speed)

    @property
    def scatter(self) -> float:
        """Standard deviation of the speed over its mean; 0 at rest."""
        if self.total == 0.0:
            return 0.0
        mean = self.total / self.samples
        return math.sqrt(max(self.squares / self.samples - mean * mean, 0.0)) / mean


class Counts:
    """Sums and ends over one stretch of a log after the other.

    Of three values one is of all samples, the others of those that move either way.
    starts : offsets of its records
    """

    def __init__(self, starts: Index) -> None:
        self._every = 1 + int(starts[-1]) // MOST
        self.reversals = self.field = 0
        self.percents = np.zeros(101, dtype=np.intp)
        self.bins = np.zeros(len(BINS), dtype=np.intp)
        self.steps, self.longest = [0.0, 0.0, 0.0], 0.0
        self.x, self.xdot, self.duty, self.temperature = [Ends() for _ in range(3)], *_three()
        self.speeds = [_Speeds() for _ in range(3)]
        self._moving, self._null, self._fields = [0, 0], [0, 0], [0, 0]
        self._above = [Ends(), Ends()]
        self._levels: list[list[Array]] = [[], []]
        self._open = _OpenRecord()

    def add(self, stretch: Stretch) -> None:
        """The next stretch."""
        own = stretch.own
        s = Signals.of(own)
        # The step to the sample ahead is this stretch's, the next one begins behind it.
        self.reversals += len(Signals.of(stretch.recording).turns[0])
        self.field += int(np.count_nonzero(s.duty > 0))
        self.percents += percents(s.duty)[1]
        self.bins += np.bincount(bins(s.duty), minlength=len(BINS))
        for ends, values in ((self.x[0], s.x), (self.xdot, s.xdot), (self.duty, s.duty)):
            ends.add(values)
        if own.temperature is not None:
            self.temperature.add(own.temperature)
        self.speeds[0].add(s.xdot)
        null = (s.duty == 0.0) & (self._open.since_duty_step(stretch) > SETTLE)
        ways = s.xdot > 0, s.xdot < 0
        for way, moving in enumerate(ways):
            self._add_way(way, moving, s, null, stretch.first)
        moves = [np.logical_or.reduceat(way, own.starts[:-1]) for way in ways]
        self._open.add(stretch, moves, self)

    def _add_way(
        self,
        way: int,
        moving: npt.NDArray[np.bool_],
        s: Signals,
        null: npt.NDArray[np.bool_],
        first: int,
    ) -> None:
        above = moving & (s.duty > 0)
        self._moving[way] += int(np.count_nonzero(moving))
        self._null[way] += int(np.count_nonzero(moving & null))
        self._fields[way] += int(np.count_nonzero(above))
        self.x[1 + way].add(s.x[moving])
        self.speeds[1 + way].add(s.xdot, moving)
        self._above[way].add(s.duty[above])
        even = slice(-first % self._every, None, self._every)
        self._levels[way].append(s.duty[even][above[even]])

    def directions(self) -> dict[str, Excitation]:
        """The excitation of each direction."""
        return {
            name: Excitation(
                moving=self._moving[way],
                null=self._null[way],
                field=self._fields[way],
                levels=self._ends_of(way),
                steps=self.steps[1 + way],
                stroke=self.x[1 + way].range,
                speeds=self.speeds[1 + way].scatter,
            )
            for way, name in enumerate(DIRECTIONS)
        }

    def _ends_of(self, way: int) -> tuple[float, float]:
        if not self._fields[way]:
            return 0.0, 0.0
        levels = np.concatenate(self._levels[way])
        if not len(levels):  # too rare for an even part of the samples
            return self._above[way].low, self._above[way].high
        low, high = np.percentile(levels, [1, 99])
        return float(low), float(high)


def _three() -> tuple[Ends, Ends, Ends]:
    return Ends(), Ends(), Ends()


class _OpenRecord:
    """A record that may go on in the next stretch.

    low, high : of its duty;  moves : whether it moves either way;  first : its first time [s]
    stepped : when its duty last changed [s], -inf for never
    """

    def __init__(self) -> None:
        self.low, self.high = math.inf, -math.inf
        self.moves = [False, False]
        self.first, self.stepped = 0.0, -math.inf

    def since_duty_step(self, stretch: Stretch) -> Array:
        """(n,) of the samples of a stretch, by what came before it [s]."""
        s = Signals.of(stretch.recording)
        since = s.since_duty_step
        if stretch.begun:
            since = np.where(np.isinf(since), s.t - self.stepped, since)
        if stretch.ahead:
            self.stepped = float(s.t[-1] - since[-1])
        return since[: len(stretch)]

    def add(self, stretch: Stretch, moves: list[npt.NDArray[np.bool_]], counts: Counts) -> None:
        """Count the records of the next stretch, as far as they go."""
        r = stretch.own
        low = np.minimum.reduceat(r.duty, r.starts[:-1])
        high = np.maximum.reduceat(r.duty, r.starts[:-1])
        first, last = r.t[r.starts[:-1]], r.t[r.starts[1:] - 1]
        if stretch.begun or stretch.ahead:
            if not stretch.begun:
                self.low, self.high, self.moves = math.inf, -math.inf, [False, False]
                self.first = float(first[0])
            self.low, self.high = min(self.low, float(low[0])), max(self.high, float(high[0]))
            self.moves = [a or bool(b[0]) for a, b in zip(self.moves, moves, strict=True)]
            low, high, first = np.array([self.low]), np.array([self.high]), np.array([self.first])
            moves = [np.array([m]) for m in self.moves]
        counts.longest = max(counts.longest, float((last - first).max()))
        wide = high - low
        for i, chosen in enumerate((np.ones(len(wide), dtype=np.bool_), *moves)):
            counts.steps[i] = float(wide[chosen].max(initial=counts.steps[i]))
