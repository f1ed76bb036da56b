"""Closed-form motions of a described drive: deflection and velocity of the piston against time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Protocol

import numpy as np

from erdctl.core.recording import Array

TONES = 64


class Progress(Enum):
    """How the frequency of a sweep grows with time."""

    LINEAR = "linear"
    LOG = "log"


class Waveform(Protocol):
    """A motion about x = 0: a frozen dataclass whose fields are the keys of its kind."""

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        """x [m] and xdot [m/s] at t [s], each (n,)."""

    @property
    def fastest(self) -> float:
        """Highest frequency that the sampling must resolve [Hz]."""


def key(default: Any, unit: str, low: float, high: float, title: str) -> Any:
    """A key of a drive: default, unit, inclusive range and meaning."""
    return field(default=default, metadata={"unit": unit, "range": (low, high), "title": title})


@dataclass(frozen=True, kw_only=True)
class Sine:
    """x = amp sin(2 pi freq t).

    Check: 1 Hz, 10 mm begins with 2 pi 0.01 = 0.0628 m/s.
    >>> x, xdot = Sine(freq=1.0, amp=0.01)(np.zeros(1), 10.0)
    >>> x.tolist(), xdot.round(4).tolist()
    ([0.0], [0.0628])
    """

    freq: float = key(1.0, "Hz", 1e-4, 1e4, "frequency")
    amp: float = key(0.01, "m", 0.0, 1.0, "amplitude")

    @property
    def fastest(self) -> float:
        return self.freq

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        w = 2 * math.pi * self.freq
        return self.amp * np.sin(w * t), self.amp * w * np.cos(w * t)


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """x = amp sin(phi), dphi/dt = 2 pi f, f from f0 at the start to f1 at the end of the drive.

    linear:  f = f0 + (f1 - f0) t / T,  phi = 2 pi (f0 t + (f1 - f0) t^2 / (2 T))
    log:     f = f0 r^(t/T),  r = f1 / f0,  phi = 2 pi f0 T (r^(t/T) - 1) / ln r
    Check: linear, 1 to 3 Hz in T = 2 s: f = 2 Hz and phi = 2 pi 1.5 at t = 1 s, so that with
    amp = 1 m x = sin(3 pi) = 0 and xdot = 4 pi cos(3 pi) = -12.5664 m/s.
    >>> x, xdot = Sweep(f0=1.0, f1=3.0, amp=1.0)(np.ones(1), 2.0)
    >>> x.round(9).tolist(), xdot.round(4).tolist()
    ([0.0], [-12.5664])
    """

    f0: float = key(0.1, "Hz", 1e-4, 1e4, "first frequency")
    f1: float = key(10.0, "Hz", 1e-4, 1e4, "last frequency")
    amp: float = key(0.002, "m", 0.0, 1.0, "amplitude")
    scale: Progress = field(
        default=Progress.LINEAR, metadata={"unit": "1", "title": "linear or log"}
    )

    @property
    def fastest(self) -> float:
        return max(self.f0, self.f1)

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        part = t / duration
        log_ratio = math.log(self.f1 / self.f0)
        if self.scale is Progress.LOG and log_ratio != 0.0:
            # Not exp() - 1, which loses all digits as f1 approaches f0.
            cycles = self.f0 * duration * np.expm1(log_ratio * part) / log_ratio
            f = self.f0 * np.exp(log_ratio * part)
        else:
            cycles = (self.f0 + (self.f1 - self.f0) * part / 2) * t
            f = self.f0 + (self.f1 - self.f0) * part
        phase = 2 * math.pi * cycles
        return self.amp * np.sin(phase), self.amp * 2 * math.pi * f * np.cos(phase)


@dataclass(frozen=True, kw_only=True)
class Triangle:
    """Constant speed between -amp and amp, from x = 0 in compression; period 4 amp / speed.

    Check: 0.1 m/s, 10 mm: x = 10 mm at 0.1 s, 0 at 0.2 s, -10 mm at 0.3 s.
    >>> x, xdot = Triangle(speed=0.1, amp=0.01)(np.array([0.1, 0.2, 0.3]), 10.0)
    >>> (x.round(9) + 0.0).tolist()  # for -0.0 is 0.0, too
    [0.01, 0.0, -0.01]
    """

    speed: float = key(0.05, "m/s", 1e-6, 10.0, "speed")
    amp: float = key(0.01, "m", 1e-6, 1.0, "amplitude")

    @property
    def fastest(self) -> float:
        return self.speed / (4 * self.amp)

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        path = np.mod(self.speed * t / self.amp + 1.0, 4.0)
        return self.amp * (1.0 - np.abs(path - 2.0)), np.where(path < 2.0, self.speed, -self.speed)


@dataclass(frozen=True, kw_only=True)
class Bumps:
    """A sequence of sinusoidal bumps in compression, at rest between them (Fig. 19).

        x = amp sin^2(pi u / width),  u = t mod every < width, else 0

    Check: 10 mm, 0.5 s: x = 10 mm at 0.25 s; fastest pi 0.01 / 0.5 = 0.0628 m/s at 0.125 s.
    >>> x, xdot = Bumps(amp=0.01, width=0.5)(np.array([0.125, 0.25]), 10.0)
    >>> x.round(4).tolist(), xdot.round(4).tolist()
    ([0.005, 0.01], [0.0628, 0.0])
    """

    amp: float = key(0.01, "m", 0.0, 1.0, "height")
    width: float = key(0.5, "s", 1e-4, 1e4, "time over one bump")
    every: float = key(1.0, "s", 1e-4, 1e4, "time from bump to bump, at least width")

    def __post_init__(self) -> None:
        if self.every < self.width:
            raise ValueError(f"every={self.every:g} s is shorter than width={self.width:g} s")

    @property
    def fastest(self) -> float:
        return 1.0 / self.width

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        u = np.mod(t, self.every)
        w = math.pi / self.width
        on = u < self.width
        x = np.where(on, self.amp * np.sin(w * u) ** 2, 0.0)
        return x, np.where(on, self.amp * w * np.sin(2 * w * u), 0.0)


@dataclass(frozen=True, kw_only=True)
class Hold:
    """The piston stands still at `offset`: x = 0, xdot = 0."""

    @property
    def fastest(self) -> float:
        return 0.0

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        return np.zeros_like(t), np.zeros_like(t)


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Random motion with a flat spectrum up to f_max: 64 tones, one at random in each equal band.

        x = rms sqrt(2 / N) sum_k sin(2 pi f_k t + p_k),  N = 64, f_k = f_max (k + u_k) / N

    u_k, p_k uniform from `seed`; |x| <= rms sqrt(2 N) = 11.3 rms; xdot about 2 pi f_max rms /
    sqrt(3) rms.
    Check: rms 1 mm, 10 Hz gives about 2 pi 10 / sqrt(3) = 36 mm/s rms.
    >>> x, xdot = Noise(rms=1e-3, f_max=10.0)(np.arange(0.0, 100.0, 0.01), 100.0)
    >>> round(float(xdot.std()), 3)
    0.036
    """

    rms: float = key(0.002, "m", 0.0, 1.0, "effective value of x over a long time")
    f_max: float = key(5.0, "Hz", 1e-4, 1e4, "highest frequency")
    seed: int = key(0, "1", 0, 2**31 - 1, "seed of the random tones")

    @property
    def fastest(self) -> float:
        return self.f_max

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        random = np.random.default_rng(self.seed)
        w = 2 * math.pi * self.f_max * (np.arange(TONES) + random.random(TONES)) / TONES
        phase = 2 * math.pi * random.random(TONES)
        amp = self.rms * math.sqrt(2 / TONES)
        x, xdot = np.zeros_like(t), np.zeros_like(t)
        for w_k, p_k in zip(w.tolist(), phase.tolist(), strict=True):
            x += amp * np.sin(w_k * t + p_k)
            xdot += amp * w_k * np.cos(w_k * t + p_k)
        return x, xdot


KINDS: dict[str, type[Waveform]] = {
    shape.__name__.lower(): shape for shape in (Sine, Sweep, Triangle, Bumps, Hold, Noise)
}
