"""Kinds of noise and rig error under which a plain damper is logged: no physics is hidden in any.

Each takes the log of a damper that is the paper's own, free of noise, and returns what a laboratory
has instead. The size of the noise is drawn within the limits of `plant.noise`, that of the error
around what benches show.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.plant.noise import Array, Random, coloured


@dataclass(frozen=True, eq=False)
class RigLog:
    """Records one after the other, (n,) each, sampled evenly.

    edges : first samples of the records, and n;  rate : [Hz]
    noise : rms of the force noise [N];  scale : range of the force [N]
    logs_velocity : whether there is a velocity channel
    """

    t: Array
    x: Array
    xdot: Array
    duty: Array
    force: Array
    edges: tuple[int, ...]
    rate: float
    noise: float
    scale: float
    logs_velocity: bool = True

    def records(self) -> list[slice]:
        """One slice for each record."""
        return [slice(a, b) for a, b in pairwise(self.edges)]

    def with_noise(self, unit: Array) -> RigLog:
        """With noise of unit rms (n,) on the force."""
        return replace(self, force=self.force + self.noise * unit)


def white(log: RigLog, random: Random) -> RigLog:
    """Normal and independent."""
    return log.with_noise(random.standard_normal(len(log.t)))


def ar1(log: RigLog, random: Random) -> RigLog:
    """n_i = rho n_{i-1} + e_i, rho from 0.8 to 0.99."""
    return log.with_noise(_by_record(log, random, "ar1", float(random.uniform(0.8, 0.99))))


def pink(log: RigLog, random: Random) -> RigLog:
    """Power as 1/f."""
    return log.with_noise(_by_record(log, random, "pink", 0.0))


def heavy_tails(log: RigLog, random: Random) -> RigLog:
    """Student's t with three degrees of freedom."""
    return log.with_noise(random.standard_t(3, len(log.t)) / np.sqrt(3.0))


def growing(log: RigLog, random: Random) -> RigLog:
    """Standard deviation that grows with the force, threefold to its largest."""
    size = 1.0 + 2.0 * np.abs(log.force) / np.abs(log.force).max()
    size /= np.sqrt(np.mean(size**2))
    return log.with_noise(size * random.standard_normal(len(log.t)))


def hum(log: RigLog, random: Random) -> RigLog:
    """A mains line of up to three times the noise, or its alias, besides white noise."""
    angle = 2 * np.pi * float(random.choice([50.0, 60.0])) * log.t + random.uniform(0, 2 * np.pi)
    size = float(random.uniform(1.0, 3.0))
    return white(log, random).with_noise(size * np.sqrt(2.0) * np.sin(angle))


def quantised(log: RigLog, random: Random) -> RigLog:
    """A force channel whose step is one to three times the noise."""
    noisy, step = white(log, random), log.noise * float(random.uniform(1.0, 3.0))
    return replace(noisy, force=np.round(noisy.force / step) * step)


def clipped(log: RigLog, random: Random) -> RigLog:
    """A force channel that ends where 1 to 5 % of the samples lie beyond."""
    noisy = white(log, random)
    end = np.quantile(np.abs(noisy.force), 1.0 - float(random.uniform(0.01, 0.05)))
    return replace(noisy, force=np.clip(noisy.force, -end, end))


def dropped(log: RigLog, random: Random) -> RigLog:
    """One per cent of the samples was never recorded, one by one and in runs."""
    noisy, n = white(log, random), len(log.t)
    lost = random.random(n) < 0.005
    for a in random.integers(0, n, 4):
        lost[a : a + round(0.00125 * n)] = True
    lost[list(log.edges[:-1])] = False
    rows = np.flatnonzero(~lost)
    edges = tuple(np.searchsorted(rows, log.edges).tolist())
    x, xdot, duty = noisy.x[rows], noisy.xdot[rows], noisy.duty[rows]
    return replace(
        noisy, t=noisy.t[rows], x=x, xdot=xdot, duty=duty, force=noisy.force[rows], edges=edges
    )


def bursts(log: RigLog, random: Random) -> RigLog:
    """A few tenths of a second of noise ten times as large, as of a loose plug."""
    size, length = np.ones(len(log.t)), round(0.2 * log.rate)
    for a in random.integers(0, len(log.t) - length, int(random.integers(2, 6))):
        size[a : a + length] = 10.0
    return log.with_noise(size * random.standard_normal(len(log.t)))


def spikes(log: RigLog, random: Random) -> RigLog:
    """Single samples 10 to 40 times the noise off, one in a thousand."""
    hit = random.random(len(log.t)) < 1e-3
    height = random.choice([-1.0, 1.0], len(log.t)) * random.uniform(10.0, 40.0, len(log.t))
    return white(log, random).with_noise(hit * height)


def record_gain(log: RigLog, random: Random) -> RigLog:
    """The gain of the force scatters by 1 % from record to record."""
    gain = 1.0 + 0.01 * np.clip(random.standard_normal(len(log.edges) - 1), -2.0, 2.0)
    return white(replace(log, force=log.force * _along(log, gain)), random)


def record_offset(log: RigLog, random: Random) -> RigLog:
    """The zero of the force scatters by 0.3 of the noise from record to record, and only scatters.

    What all records share would be a zero error, which has a name of its own.
    """
    offset = random.standard_normal(len(log.edges) - 1)
    along = _along(log, offset)
    return white(log, random).with_noise(0.3 * (along - along.mean()))


def velocity_noise(log: RigLog, random: Random) -> RigLog:
    """The velocity channel has noise of its own, 0.3 to 2 % of its largest."""
    size = float(random.uniform(0.003, 0.02)) * np.abs(log.xdot).max()
    noisy = white(log, random)
    return replace(noisy, xdot=noisy.xdot + size * random.standard_normal(len(log.t)))


def velocity_late(log: RigLog, random: Random) -> RigLog:
    """The velocity channel comes half a sample to three samples late."""
    noisy, late = white(log, random), float(random.uniform(0.5, 3.0)) / log.rate
    parts = [np.interp(log.t[s] - late, log.t[s], log.xdot[s]) for s in log.records()]
    return replace(noisy, xdot=np.concatenate(parts))


def wander(log: RigLog, random: Random) -> RigLog:
    """The zero of the force swings slowly by half of the noise, with a period of each record's."""
    parts = []
    for s in log.records():
        t = log.t[s]
        period = float(random.uniform(0.8, 2.0)) * (t[-1] - t[0])
        parts.append(np.sin(2 * np.pi * t / period + random.uniform(0, 2 * np.pi)))
    return white(log, random).with_noise(0.5 * np.sqrt(2.0) * np.concatenate(parts))


def jitter(log: RigLog, random: Random) -> RigLog:
    """The clock of the force channel jitters by 5 % of a sample against that of the motion."""
    late = 0.05 / log.rate * random.standard_normal(len(log.t))
    parts = [np.interp(log.t[s] - late[s], log.t[s], log.force[s]) for s in log.records()]
    return white(replace(log, force=np.concatenate(parts)), random)


def coarse_motion(log: RigLog, random: Random) -> RigLog:
    """Deflection in steps of 1e-4 of its range, velocity as its derivative."""
    from scipy.signal import savgol_filter

    noisy, step = white(log, random), 1e-4 * float(np.ptp(log.x))
    read = np.round((log.x + 0.5 * step * random.standard_normal(len(log.x))) / step) * step
    speed = [savgol_filter(read[s], 9, 3, deriv=1, delta=1.0 / log.rate) for s in log.records()]
    return replace(noisy, x=read, xdot=np.concatenate(speed))


def no_velocity(log: RigLog, random: Random) -> RigLog:
    """No velocity channel; the deflection has noise of 5e-5 to 1e-3 of its range, or such steps."""
    noisy, size = white(log, random), float(np.exp(random.uniform(np.log(5e-5), np.log(1e-3))))
    size *= float(np.ptp(log.x))
    x = log.x + size * random.standard_normal(len(log.t))
    if random.random() < 0.5:
        x = np.round(log.x / size) * size
    return replace(noisy, x=x, logs_velocity=False)


@dataclass(frozen=True)
class Kind:
    """One kind.

    only_noise : whether a model that is right leaves nothing but noise
    right : names that would not be wrong, as they say what the rig does
    """

    apply: Callable[[RigLog, Random], RigLog]
    only_noise: bool
    right: tuple[str, ...] = ()


VELOCITY = ("velocity_noise",)
KINDS: Mapping[str, Kind] = {
    "white": Kind(white, True),
    "ar1": Kind(ar1, True),
    "pink": Kind(pink, True),
    "heavy_tails": Kind(heavy_tails, True),
    "growing": Kind(growing, True),
    "hum": Kind(hum, True),
    "quantised": Kind(quantised, True),
    "clipped": Kind(clipped, False),
    "dropped": Kind(dropped, True),
    "bursts": Kind(bursts, False),
    "spikes": Kind(spikes, False),
    "record_gain": Kind(record_gain, False),
    "record_offset": Kind(record_offset, False),
    "velocity_noise": Kind(velocity_noise, False, VELOCITY),
    "velocity_late": Kind(velocity_late, False, VELOCITY),
    "wander": Kind(wander, False, ("force_drift",)),
    "jitter": Kind(jitter, False),
    "coarse_motion": Kind(coarse_motion, False),
    "no_velocity": Kind(no_velocity, False),
}


def _by_record(log: RigLog, random: Random, colour: str, rho: float) -> Array:
    return np.concatenate([coloured(random, s.stop - s.start, colour, rho) for s in log.records()])


def _along(log: RigLog, values: npt.ArrayLike) -> Array:
    return np.repeat(np.asarray(values, dtype=float), np.diff(log.edges))
