"""Stretches of a recording that the checks look at, each with its noise and its resolution."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from erdctl.core.quantiles import median, percentiles
from erdctl.core.recording import Array, Index, Recording

FEWEST = 40  # samples of a stretch that can be told anything of
MOST = 500_000  # samples that are looked at; of a longer log, even stretches
STRETCHES = 100  # of a longer log
THIN = 3_000  # samples that a percentile is taken of
RECORDS = 200  # records that are looked at, evenly
CHANGE = 0.02  # of the range of the force, by which it changes as the rod turns
SETTLING = 0.6  # of its change from the first quarter of a rest to the next
SIGMAS = 4.0  # of its noise
BREAKS = 0.3  # of the effective speed, by which it changes in a step where it breaks
STEP = 0.02  # of the duty, that a force answers visibly
NEAR = 8  # samples next to a reversal or a duty step, where a force may jump


@dataclass(frozen=True, eq=False)
class Piece:
    """A stretch of one record, with views of its channels.

    record, name : number of its record in the log, and what that is called
    first : sample of the recording at which it begins
    """

    recording: Recording
    record: int
    name: str
    first: int
    end: int

    def __len__(self) -> int:
        return self.end - self.first

    def of(self, channel: str) -> Array:
        """(n,) a channel."""
        values: Array = getattr(self.recording, channel)[self.first : self.end]
        return values

    @cached_property
    def t(self) -> Array:
        """(n,) [s]."""
        return self.of("t")

    @cached_property
    def x(self) -> Array:
        """(n,) [m]."""
        return self.of("x")

    @cached_property
    def xdot(self) -> Array:
        """(n,) [m/s]."""
        return self.of("xdot")

    @cached_property
    def force(self) -> Array:
        """(n,) [N]."""
        return self.of("force")

    @cached_property
    def step(self) -> float:
        """Usual time from sample to sample [s]."""
        return median(np.diff(self.t[:: max(1, len(self) // 10_000)])) / max(1, len(self) // 10_000)

    @cached_property
    def beyond(self) -> Array:
        """(n - 1,) steps of x beyond those that xdot gives [m].

            x_{i+1} - x_i - h (13 (v_i + v_{i+1}) - v_{i-1} - v_{i+2}) / 24

        of which trapezoids would leave 40 % of a motion with three samples a cycle. Where the speed
        breaks (a triangle turns), trapezoids are the better ones next to it, and right to half of
        the break at it: less than that is none.
        """
        v, broken = self.xdot, self._broken
        padded = np.pad(v, 1, mode="edge")
        two = v[1:] + v[:-1]
        bend = two - padded[:-3] - padded[3:]
        dt = np.diff(self.t)
        straight = np.diff(self.x) - dt * 0.5 * two
        out = straight - dt * bend / 24.0
        better = widened(broken > 0, 1) & (np.abs(straight) < np.abs(out))
        out = np.where(better, straight, out)
        return np.asarray(out - np.clip(out, -0.5 * dt * broken, 0.5 * dt * broken))

    @property
    def _broken(self) -> Array:
        """(n - 1,) by how much xdot changes in a step beyond what it does near it [m/s]; 0 where
        the motion turns as smoothly as it goes on.
        """
        change = np.abs(np.diff(self.xdot))
        wide = np.pad(change, 2, mode="edge")
        broken = change - np.maximum(wide[:-4], wide[4:])
        return np.where(broken > BREAKS * self.speed, broken, 0.0)

    @cached_property
    def moved(self) -> Array:
        """(n - 1,) what the piston moves in a step, at the highest speed near it [m]."""
        speed = np.abs(self.xdot)
        return self.step * largest_near(np.maximum(speed[1:], speed[:-1]), 2)

    @cached_property
    def unresolved(self) -> Array:
        """(n - 1,) steps of x beyond xdot that a motion of few samples a cycle makes [m].

        The usual part of what it moves where it is fast.
        """
        fast = self.moved > self.speed * self.step
        part = median(np.abs(self.beyond[fast]) / self.moved[fast]) if fast.any() else 0.0
        return part * self.moved

    @cached_property
    def stroke(self) -> float:
        """Range of x without its outermost thousandth on either side [m]."""
        return spread(self.x)

    @cached_property
    def speed(self) -> float:
        """Effective speed [m/s], of the middle 99.8 % of the samples."""
        thin = self.xdot[:: 1 + len(self) // THIN]
        low, high = percentiles(thin, 0.1, 99.9)
        return float(np.sqrt(np.mean(np.clip(thin, low, high) ** 2)))

    @cached_property
    def cycle(self) -> float:
        """Mean period of the motion, by its effective stroke and speed [s]; 0 at rest."""
        speed = float(np.std(self.xdot))
        return 2.0 * np.pi * float(np.std(self.x)) / speed if speed > 0 else 0.0

    @cached_property
    def near(self) -> npt.NDArray[np.bool_]:
        """(n,) samples next to a reversal or a duty step, or at which the piston hardly moves."""
        return self.turning(max(NEAR, round(0.01 / self.step)) if self.step > 0 else NEAR)

    @cached_property
    def duty_steps(self) -> Index:
        """(k,) samples before which the duty is another."""
        return np.flatnonzero(np.diff(self.of("duty"))) + 1

    @cached_property
    def _noises(self) -> dict[str, tuple[float, float]]:
        return {}

    def noise(self, channel: str) -> tuple[float, float]:
        """Noise of a channel and how white it is; see `white_noise`."""
        if channel not in self._noises:
            self._noises[channel] = white_noise(self.of(channel))
        return self._noises[channel]

    def travelled(self, a: int, b: int) -> float:
        """How far apart the places are that a measured xdot leads to from sample a to b [m].

        To and fro as well: x may have stood at a limit over a whole turn. But while a rod rests its
        velocity goes on by what its zero is off, as it does elsewhere.
        """
        steps = np.diff(self.t)
        far = 0.5 * steps * (self.xdot[1:] + self.xdot[:-1])
        off, time = -self.beyond, steps.copy()
        off[max(a - 1, 0) : b] = time[max(a - 1, 0) : b] = 0.0
        zero = float(off.sum()) / max(float(time.sum()), 1e-300)
        return float(np.ptp(np.cumsum(np.append(0.0, (far - zero * steps)[a : b - 1]))))

    def goes_on(self, a: int, b: int) -> bool:
        """Whether the force goes on changing from sample a to b, as where a rod turns.

        At rest it settles: from quarter to quarter it changes less and less.
        """
        quarters = np.array_split(self.force[a:b], min(4, b - a))
        first, *later = np.abs(np.diff([float(q.mean()) for q in quarters]))
        least = SIGMAS * self.noise("force")[0] * (8.0 / (b - a)) ** 0.5
        return bool(max(later) > max(CHANGE * spread(self.force), least, SETTLING * first))

    def stepped(self, reach: int) -> npt.NDArray[np.bool_]:
        """(n,) samples so near to a step of the duty that the force may overshoot."""
        step = np.abs(np.diff(self.of("duty"), prepend=self.of("duty")[:1])) > STEP
        return widened(step, reach)

    def turning(self, reach: int) -> npt.NDArray[np.bool_]:
        """The same, with so many samples on either side of a reversal or a duty step."""
        duty = self.of("duty")
        up = self.xdot > 0
        jump = np.zeros(len(self), dtype=np.bool_)
        jump[1:] = (up[1:] != up[:-1]) | (duty[1:] != duty[:-1])
        out = widened(jump, reach)
        out |= np.abs(self.xdot) < 0.1 * self.speed
        return out


def spread(values: Array) -> float:
    """Range of values (n,) without the outermost thousandth on either side."""
    low, high = percentiles(values[:: 1 + len(values) // THIN], 0.1, 99.9)
    return high - low


def largest_near(values: Array, reach: int) -> Array:
    """(n,) the largest of the values (n,) within so many samples.

    >>> largest_near(np.array([3.0, 1.0, 0.0, 0.0, 2.0]), 1).tolist()
    [3.0, 3.0, 1.0, 2.0, 2.0]
    """
    out = values.copy()
    for k in range(1, reach + 1):
        np.maximum(out[k:], values[:-k], out=out[k:])
        np.maximum(out[:-k], values[k:], out=out[:-k])
    return out


def widened(flags: npt.NDArray[np.bool_], reach: int) -> npt.NDArray[np.bool_]:
    """(n,) flags, set also at so many samples before and behind.

    Check: 0 0 1 0 0 with reach 1 gives 0 1 1 1 0.
    >>> widened(np.array([0, 0, 1, 0, 0], dtype=bool), 1).astype(int).tolist()
    [0, 1, 1, 1, 0]
    """
    if reach <= 0 or not flags.any():
        return flags.copy()
    count = np.concatenate([[0], np.cumsum(flags)])
    n = len(flags)
    high = np.minimum(np.arange(n) + reach + 1, n)
    low = np.maximum(np.arange(n) - reach, 0)
    return np.asarray(count[high] > count[low])


def white_noise(values: Array) -> tuple[float, float]:
    """Standard deviation of white noise on a smooth signal (n,), and how white its rest is.

        s = median |d3| / (0.6745 sqrt(20)),   median |d3| / median |d2|

    The second is sqrt(20 / 6) = 1.83 for white noise, and far less for a signal that is smooth.
    Check: 0, 1, 0, 1, ... has |d3| = 4 and |d2| = 2: 1.3261 and 2.
    >>> s, white = white_noise(np.arange(100) % 2 * 1.0)
    >>> round(s, 4), white
    (1.3261, 2.0)
    """
    d2 = np.diff(values, 2)
    d3 = np.diff(d2)
    second, third = median(np.abs(d2)), median(np.abs(d3))
    return third / (0.6745 * 20.0**0.5), third / second if second > 0 else 0.0


def resolution(values: Array) -> float:
    """Smallest step between two different values of (n,); 0 if all are the same."""
    # Not np.unique, which imports masked arrays.
    ordered = np.sort(values[:: max(1, len(values) // 20_000)])
    between = np.diff(ordered)
    scale = float(np.abs(ordered[[0, -1]]).max())
    apart = between[between > 1e-9 * max(scale, 1e-300)]
    return float(apart.min()) if apart.size else 0.0


def runs_of_equals(values: Array) -> tuple[Index, Index]:
    """First sample (k,) and length (k,) of runs of two or more equal values in (n,).

    Check: 1, 2, 2, 2, 3, 3 gives 1, 4 and 3, 2.
    >>> first, length = runs_of_equals(np.array([1.0, 2.0, 2.0, 2.0, 3.0, 3.0]))
    >>> first.tolist(), length.tolist()
    ([1, 4], [3, 2])
    """
    same = np.zeros(len(values) + 1, dtype=np.int8)
    same[1:-1] = values[1:] == values[:-1]
    edge = np.diff(same)
    first, end = np.flatnonzero(edge == 1), np.flatnonzero(edge == -1)
    return first, end - first + 1


def looked_at(starts: Index) -> list[tuple[int, int, int]]:
    """Record, first and end of the stretches that are looked at: all records, or even parts of a
    very long log; starts : (r + 1,) offsets of its records."""
    bounds = starts.tolist()
    count = len(bounds) - 1
    chosen = dict.fromkeys(np.linspace(0, count - 1, min(count, RECORDS)).astype(int).tolist())
    total = sum(bounds[i + 1] - bounds[i] for i in chosen)
    out = []
    for i in chosen:
        a, b = bounds[i], bounds[i + 1]
        if total <= MOST or b - a <= MOST // STRETCHES:
            parts = [(a, b)]
        else:
            length = MOST // STRETCHES
            many = max(1, round((b - a) / total * STRETCHES))
            firsts = np.linspace(a, b - length, many).astype(int).tolist()
            parts = [(f, f + length) for f in firsts]
        out += [(i, f, e) for f, e in parts if e - f >= FEWEST]
    return out
