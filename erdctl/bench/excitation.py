"""What a log excites: the measures of its motion and control that decide what it can show."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.core.blocks import SETTLE
from erdctl.core.cache import parts
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.core.signals import Signals
from erdctl.score.nrmse import percents

ENOUGH = 10  # samples of a kind below which there is no telling anything
SAME_LEVEL = 1.05  # duties within this ratio are one level with a noisy record of it
NO_STEP = 1.002  # duties within this ratio tell nothing from each other
PIECE = 50_000  # samples of a stretch over which accelerations are taken
ACCELERATION_SAMPLES = 1_000_000  # stretches of a longer log stand for the whole
SHARE = 0.05  # of the acceleration; less that no spring makes is what the slope leaves of a sine


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


@dataclass(frozen=True, eq=False)
class Survey:
    """What a log offers, each measure taken when it is first asked for."""

    recording: Recording
    signals: Signals

    @classmethod
    def of(cls, recording: Recording) -> Survey:
        """The survey of a recording; its force is not looked at."""
        return cls(recording, Signals.of(recording))

    @cached_property
    def directions(self) -> dict[str, Excitation]:
        """The excitation of each direction."""
        s = self.signals
        null = null_control(s)
        ways = zip(DIRECTIONS, (s.xdot > 0, s.xdot < 0), strict=True)
        return {name: self._direction(moving, null) for name, moving in ways}

    def _direction(self, moving: npt.NDArray[np.bool_], null: npt.NDArray[np.bool_]) -> Excitation:
        s = self.signals
        low, high = np.inf, -np.inf
        for part in parts(len(s)):
            x = s.x[part][moving[part]]
            low, high = float(x.min(initial=low)), float(x.max(initial=high))
        above = np.flatnonzero(moving & (s.duty > 0))
        moves = np.logical_or.reduceat(moving, self.recording.starts[:-1])
        return Excitation(
            moving=int(np.count_nonzero(moving)),
            null=int(np.count_nonzero(moving & null)),
            field=len(above),
            levels=_ends(s.duty[above[:: len(above) // 100_000 + 1]]) if len(above) else (0.0, 0.0),
            steps=float(self._duty_ranges[moves].max(initial=0.0)),
            stroke=max(high - low, 0.0),
            speeds=_speeds(s.xdot, moving),
        )

    @cached_property
    def _duty_ranges(self) -> Array:
        first, duty = self.recording.starts[:-1], self.signals.duty
        return np.asarray(np.maximum.reduceat(duty, first) - np.minimum.reduceat(duty, first))

    @property
    def reversals(self) -> int:
        """Changes of the direction of motion."""
        return len(self.signals.turns[0])

    @cached_property
    def field(self) -> int:
        """Samples with a duty above zero."""
        return int(np.count_nonzero(self.signals.duty > 0))

    @cached_property
    def levels(self) -> int:
        """Duty levels above zero that lie clearly apart, each held for some samples."""
        _, seen = percents(self.signals.duty)
        found, last = 0, 0.0
        for level in np.flatnonzero(seen >= ENOUGH).tolist():
            if level > last * SAME_LEVEL:
                found, last = found + 1, float(level)
        return found

    @property
    def steps(self) -> float:
        """Widest range of the duty within a record [1]."""
        return float(self._duty_ranges.max())

    @cached_property
    def speeds(self) -> float:
        """Standard deviation of the speed over its mean [1]; 0 at rest."""
        return _speeds(self.signals.xdot)

    @property
    def warming(self) -> float:
        """Range of the temperature [degC]; 0 where it is not logged."""
        warmth = self.signals.temperature
        return 0.0 if warmth is None else float(np.ptp(warmth))

    @cached_property
    def stroke(self) -> float:
        """Range of the deflection [m]."""
        return float(np.ptp(self.signals.x))

    @property
    def longest(self) -> float:
        """Length of the longest record [s]."""
        starts, t = self.recording.starts, self.recording.t
        return float((t[starts[1:] - 1] - t[starts[:-1]]).max())

    @cached_property
    def acceleration(self) -> float:
        """Effective value of the acceleration that is no multiple of deflection or speed [m/s^2].

            min over a, b, c of  rms(d2x/dt2 - a x - b xdot - c),  a, b, c per direction

        At one frequency d2x/dt2 = -omega^2 x, which a spring takes up: 0 then.
        """
        return _beyond_a_spring(self.signals)


def null_control(signals: Signals) -> npt.NDArray[np.bool_]:
    """(n,) samples at zero duty with the yield force of an earlier duty gone."""
    return np.asarray((signals.duty == 0.0) & (signals.since_duty_step > SETTLE))


def _speeds(xdot: Array, chosen: npt.NDArray[np.bool_] | None = None) -> float:
    """Standard deviation of the speed |xdot| over its mean, of all or some of (n,); 0 at rest."""
    samples, total, squares = 0, 0.0, 0.0
    for part in parts(len(xdot)):
        speed = np.abs(xdot[part] if chosen is None else xdot[part][chosen[part]])
        samples, total = samples + len(speed), total + float(speed.sum())
        squares += float(speed @ speed)
    if total == 0.0:
        return 0.0
    mean = total / samples
    return math.sqrt(max(squares / samples - mean * mean, 0.0)) / mean


def _ends(values: Array) -> tuple[float, float]:
    low, high = np.percentile(values, [1, 99])
    return float(low), float(high)


def _beyond_a_spring(s: Signals) -> float:
    bounds = [
        (i, min(i + PIECE, b))
        for a, b in pairwise(s.starts.tolist()) for i in range(a, b, PIECE)
    ]  # fmt: skip
    every = -(-len(s) // ACCELERATION_SAMPLES)
    normal, samples = np.zeros((7, 7)), 0
    for a, b in bounds[::every]:
        rows = _against_acceleration(s.t[a:b], s.x[a:b], s.xdot[a:b])
        if rows is not None:
            normal += rows @ rows.T
            samples += rows.shape[1]
    if not samples or normal[6, 6] == 0.0:
        return 0.0
    known = np.flatnonzero(np.diag(normal)[:6] > 0)
    scale = np.sqrt(np.diag(normal)[known])
    cross = normal[known, 6] / scale
    gram = normal[np.ix_(known, known)] / np.outer(scale, scale)
    left = normal[6, 6] - float(cross @ np.linalg.lstsq(gram, cross, rcond=1e-10)[0])
    if left < SHARE**2 * normal[6, 6]:
        return 0.0
    return float(np.sqrt(left / samples))


def _against_acceleration(t: Array, x: Array, xdot: Array) -> Array | None:
    """(7, m) x, xdot and 1 in either direction, and the acceleration; None if too short for it.

    The acceleration is the mean velocity of a twelfth of a period ahead less that of one behind,
    over the time between: it follows the motion (3 % low at its own frequency), and averages the
    noise of xdot over as long as the motion allows.
    """
    swing, speed = float(x.std()), float(xdot.std())
    if len(x) < 8 or swing == 0.0 or speed == 0.0:
        return None
    step = float(t[-1] - t[0]) / (len(t) - 1)
    reach = max(1, round(2.0 * math.pi * swing / speed / 12.0 / step))
    if len(x) < 4 * reach:
        return None
    sums = [np.concatenate([[0.0], np.cumsum(c)]) for c in (t - t[0], xdot)]
    n = len(x) - 2 * reach
    ahead, behind = (
        [(c[i + reach : i + reach + n] - c[i : i + n]) / reach for c in sums]
        for i in (reach + 1, 0)
    )
    span = ahead[0] - behind[0]
    # Windows that hold a gap of the sampling say nothing of the acceleration.
    use = span < 2.0 * (reach + 1) * step
    inside = slice(reach, reach + n)
    x, xdot = x[inside], xdot[inside]
    up = xdot > 0
    ones = np.ones(n)
    rows = np.array([c * way for c in (x, xdot, ones) for way in (up, ~up)])
    return np.vstack([rows, (ahead[1] - behind[1]) / span])[:, use]
