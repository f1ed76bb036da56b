"""What the rig adds: noise of the force channel, and motion as a laboratory measures it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.signal import butter, lfilter, savgol_filter, sosfiltfilt

from erdctl.plant.campaign import Campaign

Array = npt.NDArray[np.float64]
Random = np.random.Generator

COLOURS = ("white", "ar1", "pink")


@dataclass(frozen=True)
class ForceNoise:
    """Noise of the force channel.

    colour : "white", "ar1" (n_i = rho n_{i-1} + e_i) or "pink" (power as 1/f)
    fraction : rms over the range of the force;  rms : the same [N]
    mains : part of the power in a line at `line` Hz
    """

    colour: str
    rho: float
    fraction: float
    mains: float
    line: float
    rms: float = 0.0

    def scaled(self, force_range: float, favour: float = 1.0) -> ForceNoise:
        """For a damper's range of force [N]; `favour` moves the fraction within its limits."""
        fraction = float(np.clip(self.fraction * favour, *FRACTIONS))
        return replace(self, fraction=fraction, rms=fraction * force_range)

    def at(self, random: Random, lengths: Sequence[int], rate: float) -> Array:
        """(n,) noise [N] over records of the given lengths, of exactly this rms."""
        parts = []
        for n in lengths:
            part = coloured(random, n, self.colour, self.rho)
            if self.mains > 0.0:
                angle = 2 * np.pi * self.line * np.arange(n) / rate + random.uniform(0, 2 * np.pi)
                part = np.sqrt(1 - self.mains) * part + np.sqrt(2 * self.mains) * np.sin(angle)
            parts.append(part)
        noise = np.concatenate(parts)
        scaled: Array = noise * (self.rms / np.sqrt(np.mean(noise**2)))
        return scaled


FRACTIONS = (0.003, 0.02)


def draw_force_noise(random: Random, colour: str | None = None) -> ForceNoise:
    """Colour, amplitude and mains line."""
    drawn = str(random.choice(COLOURS, p=(0.4, 0.4, 0.2)))
    rho = float(random.uniform(0.9, 0.99))
    fraction = float(np.exp(random.uniform(*np.log(FRACTIONS))))
    mains = float(random.uniform(0.03, 0.15)) if random.random() < 0.2 else 0.0
    line = float(random.choice([50.0, 60.0]))
    return ForceNoise(colour or drawn, rho, fraction, mains, line)


def coloured(random: Random, n: int, colour: str, rho: float) -> Array:
    """(n,) noise of one record: "white", "ar1" of some rho, or "pink"; its rms is about 1."""
    white = random.standard_normal(n)
    if colour == "ar1":
        start = rho * random.standard_normal(1)  # as if it had run for long
        out, _ = lfilter([np.sqrt(1 - rho * rho)], [1.0, -rho], white, zi=start)
        return np.asarray(out)
    if colour == "pink":
        f = np.fft.rfftfreq(n)
        spectrum = np.fft.rfft(white) / np.sqrt(np.maximum(f, 1.0 / n))
        spectrum[0] = 0.0
        shaped = np.fft.irfft(spectrum, n)
        return np.asarray(shaped / np.std(shaped))
    return white


@dataclass(frozen=True)
class MotionNoise:
    """How deflection and velocity reach the log.

    kind : "exact"; "savgol" or "difference": xdot from the noisy, quantised x, by a local cubic
        over `window` samples, or by central differences behind a zero-phase low-pass at `cutoff` Hz
    noise, step : of the deflection channel [m]
    """

    kind: str
    noise: float
    step: float
    window: int
    cutoff: float

    def at(self, random: Random, x: Array, v: Array, rate: float) -> tuple[Array, Array]:
        """Deflection and velocity of one record as logged."""
        if self.kind == "exact":
            return x, v
        read = np.round((x + self.noise * random.standard_normal(len(x))) / self.step) * self.step
        if self.kind == "savgol":
            speed = savgol_filter(read, self.window, 3, deriv=1, delta=1.0 / rate)
        else:
            sos = butter(2, self.cutoff, fs=rate, output="sos")
            speed = sosfiltfilt(sos, np.gradient(read, 1.0 / rate))
        return read, np.asarray(speed)


def draw_motion_noise(random: Random, campaign: Campaign, kind: str | None = None) -> MotionNoise:
    """Half of the logs hold the motion as it was; `kind` may ask for "exact" or "measured"."""
    exact = random.random() < 0.5
    way = str(random.choice(["savgol", "difference"]))
    step = campaign.rating.stroke * float(np.exp(random.uniform(np.log(2e-5), np.log(1.5e-4))))
    noise = step * float(random.uniform(0.3, 1.0))
    # Over no more than a fifth of the shortest period, or the smoothing bends the motion.
    widest = max(int(campaign.rate / campaign.high / 10), 3)
    window = 2 * int(random.integers(3, min(widest, 15) + 1)) + 1
    cutoff = min(float(random.uniform(10.0, 20.0)) * campaign.high, 0.4 * campaign.rate)
    if kind == "exact" or (kind is None and exact):
        way = "exact"
    return MotionNoise(way, noise, step, window, cutoff)


def draw_gains(random: Random, count: int, scatter: float) -> tuple[float, ...]:
    """Gain of the force in each record: 1 but for a relative scatter."""
    z = np.clip(random.standard_normal(count), -2.0, 2.0)
    return tuple(float(g) for g in np.exp(scatter * z))


DISTURBANCES = ("white", "ar1", "growing", "scatter")


def disturbed(random: Random, force: Array, lengths: Sequence[int], rms: float, kind: str) -> Array:
    """(n,) a clean force [N] as a rig records it.

    kind : "white" noise of rms [N]; "ar1", the same with a memory; "growing", white from half of
        rms at no force to twice rms at the largest; "scatter", white, and each record with a gain
        that scatters by 1 % and a zero that scatters by rms
    """
    white = random.standard_normal(len(force))
    if kind == "ar1":
        rho = float(random.uniform(0.8, 0.97))
        return force + rms * np.concatenate([coloured(random, n, "ar1", rho) for n in lengths])
    if kind == "growing":
        size = np.abs(force) / float(np.abs(force).max())
        return np.asarray(force + rms * (0.5 + 1.5 * size) * white)
    if kind == "scatter":
        gain = 1.0 + 0.01 * random.standard_normal(len(lengths))
        zero = rms * random.standard_normal(len(lengths))
        return np.asarray(np.repeat(gain, lengths) * force + np.repeat(zero, lengths) + rms * white)
    if kind != "white":
        raise ValueError(f"kind is {kind!r}, expected one of {', '.join(DISTURBANCES)}")
    return np.asarray(force + rms * white)
