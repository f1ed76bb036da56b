"""Motions of the rod in closed form: deflection, velocity and acceleration at any time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]

RESYNC = 256  # steps after which the rotating phasors start from exact values again


@dataclass(frozen=True)
class Trajectory:
    """One of four waveforms about an offset.

    kind : "tones"     sum of a sin(2 pi f t + p)
           "sweep"     a sin(2 pi (f_0 t + (f_1 - f_0) t^2 / 2 T) + p), from f_0 to f_1 within T
           "triangle"  a 2/pi asin(ROUNDING sin(2 pi f t + p)), corners rounded
    amplitudes [m], frequencies [Hz], phases [rad] : one each per tone; a sweep has two frequencies
    span : T of a sweep [s]
    ramp : s over which the motion starts from rest at t = 0; 0 if the damper moves already
    """

    kind: str
    amplitudes: tuple[float, ...]
    frequencies: tuple[float, ...]
    phases: tuple[float, ...]
    offset: float = 0.0
    span: float = 1.0
    ramp: float = 0.0

    def at(self, start: float, step: float, count: int) -> tuple[Array, Array, Array]:
        """x [m], xdot [m/s], xddot [m/s2] at start + k step, (count,) each."""
        if self.kind == "tones":
            x, v, a = _tones(
                start, step, count,
                np.array(self.amplitudes), np.array(self.frequencies), np.array(self.phases),
            )  # fmt: skip
        else:
            t: Array = start + step * np.arange(count, dtype=float)
            x, v, a = self._sweep(t) if self.kind == "sweep" else self._triangle(t)
        if self.ramp > 0.0:
            t = start + step * np.arange(count, dtype=float)
            x, v, a = self._ramped(t, x, v, a)
        return x + self.offset, v, a

    def _sweep(self, t: Array) -> tuple[Array, Array, Array]:
        f_0, f_1 = self.frequencies
        # Before the sweep its first frequency holds, or it would run through zero.
        rate = np.where(t > 0, (f_1 - f_0) / self.span, 0.0)
        phase = 2 * np.pi * (f_0 * t + 0.5 * rate * t * t) + self.phases[0]
        w, dw = 2 * np.pi * (f_0 + rate * t), 2 * np.pi * rate
        s, c = self.amplitudes[0] * np.sin(phase), self.amplitudes[0] * np.cos(phase)
        return s, w * c, dw * c - w * w * s

    def _triangle(self, t: Array) -> tuple[Array, Array, Array]:
        w = 2 * np.pi * self.frequencies[0]
        s, c = np.sin(w * t + self.phases[0]), np.cos(w * t + self.phases[0])
        scale = self.amplitudes[0] * 2 / np.pi
        left = 1.0 - (ROUNDING * s) ** 2
        x = scale * np.arcsin(ROUNDING * s)
        v = scale * ROUNDING * w * c / np.sqrt(left)
        a = -scale * ROUNDING * w * w * s * (1.0 - ROUNDING**2) / left**1.5
        return x, v, a

    def _ramped(self, t: Array, x: Array, v: Array, a: Array) -> tuple[Array, Array, Array]:
        """1 - exp(-(t/ramp)^2) times the motion, from t = 0."""
        u = np.maximum(t, 0.0) / self.ramp
        e = np.exp(-u * u)
        r, dr = 1.0 - e, 2 * u * e / self.ramp
        ddr = np.where(t > 0, (2 - 4 * u * u) * e / self.ramp**2, 0.0)
        return r * x, dr * x + r * v, ddr * x + 2 * dr * v + r * a


ROUNDING = 0.97


@njit(cache=True)
def _tones(
    start: float, step: float, count: int, amplitude: Array, frequency: Array, phase: Array
) -> tuple[Array, Array, Array]:
    """Phasors turned step by step: a sine a sample would cost ten times as much."""
    x, v, a = np.zeros(count), np.zeros(count), np.zeros(count)
    for j in range(len(amplitude)):
        w = 2 * np.pi * frequency[j]
        turn_c, turn_s = np.cos(w * step), np.sin(w * step)
        c = s = 0.0
        for k in range(count):
            if k % RESYNC == 0:
                angle = w * (start + k * step) + phase[j]
                c, s = amplitude[j] * np.cos(angle), amplitude[j] * np.sin(angle)
            x[k] += s
            v[k] += w * c
            a[k] -= w * w * s
            c, s = c * turn_c - s * turn_s, s * turn_c + c * turn_s
    return x, v, a
