"""Semi-active dampers as the literature writes them, none of them by the paper's model, in own
physics at a fine step: what a laboratory has whose damper nobody here modelled.

A law is asked for the rates of its states and for its force, of x [m], xdot [m/s] and a control
from 0 to 1, for all records at once. Its values differ from the published ones from damper to
damper, by 15 % (standard deviation). Records come under random motion with a control that steps at
random times, or under sines, each with a control of its own; all begin from rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from erdctl.core.recording import Array

FINE, RATE = 10_000, 200  # Hz: of the integration, and logged
LEAD_IN, RAMP = 3.0, 2.0  # s before a record begins, and of these in which the motion grows
NOISE = 0.01  # of the highest force
LEVELS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
Law = Callable[[Array, Array, Array, Array], tuple[Array, Array]]
Varied = Callable[[float], float]


@dataclass(frozen=True)
class Damper:
    """law : rates of the states and force;  stroke [m];  hz : highest frequency of its sines."""

    states: int
    law: Law
    stroke: float
    hz: float


def dahl(k: Varied) -> Damper:
    """Ikhouane and Dyke 2007: F = k_x(u) xdot + k_w(u) w, dw/dt = rho (xdot - |xdot| w)."""
    k_x, k_w, rho = (k(1500.0), k(1500.0)), (k(60.0), k(800.0)), k(4800.0)

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        w, q = s
        force = (k_x[0] + k_x[1] * q) * v + (k_w[0] + k_w[1] * q) * w
        return np.array([rho * (v - np.abs(v) * w), -60.0 * (q - u)]), force

    return Damper(2, law, 0.012, 2.0)


def lugre(k: Varied) -> Damper:
    """Jimenez and Alvarez-Icaza 2005: F = s_0(u) z + s_1 dz/dt + s_2 xdot."""
    s_0, s_1, s_2, a = (k(15e3), k(80e3)), k(300.0), k(900.0), k(190.0)

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        z, q = s
        rate = v - a * np.abs(v) * z
        force = (s_0[0] + s_0[1] * q) * z + s_1 * rate + s_2 * v
        return np.array([rate, -60.0 * (q - u)]), force

    return Damper(2, law, 0.015, 2.0)


def spencer(k: Varied) -> Damper:
    """Spencer et al. 1997, Eqs. 13 to 18: Bouc-Wen and a dashpot in series."""
    c_0, c_1, alpha = (k(2100.0), k(350.0)), (k(28.3e3), k(295.0)), (k(14e3), k(69.5e3))
    k_0, k_1, A, beta = k(4690.0), k(500.0), k(301.0), k(3.63e6)

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        y, z, q = s
        V = 2.25 * q
        inner, outer = c_0[0] + c_0[1] * V, c_1[0] + c_1[1] * V
        slides = ((alpha[0] + alpha[1] * V) * z + inner * v + k_0 * (x - y)) / (inner + outer)
        r = v - slides
        rate = A * r - beta * (np.abs(r) * z * np.abs(z) + r * z * z)
        return np.array([slides, rate, -190.0 * (q - u)]), outer * slides + k_1 * x

    return Damper(3, law, 0.02, 2.0)


def biviscous(k: Varied) -> Damper:
    """Wereley et al. 1998, hysteretic biviscous; its loop opens with the acceleration."""
    c, F, x_k, v_0, v_y = (k(45.0), k(35.0)), (k(1.5), k(26.0)), k(200.0), k(0.008), k(0.012)

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        late, q = s
        a = (v - late) / 0.004
        yields = np.tanh((v - v_0 * np.tanh(a / 0.3)) / (v_y * (1.0 + q)))
        force = (c[0] + c[1] * q) * v + (F[0] + F[1] * q**1.4) * yields + x_k * x
        return np.array([a, (u - q) / 0.012]), force

    return Damper(2, law, 0.012, 3.0)


def kwok(k: Varied) -> Damper:
    """Kwok et al. 2006: F = c xdot + k x + alpha tanh(beta xdot + delta sign(x)), in its values."""
    c, x_k, alpha = (k(1232.0), k(1929.0)), k(5100.0), (k(32.0), k(918.0), k(244.0))
    beta, delta = k(100.0), (k(0.58), k(0.3))

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        q = s[0]
        z = np.tanh(beta * v + (delta[0] + delta[1] * q) * np.sign(x))
        force = (c[0] + c[1] * q) * v + x_k * x
        force = force + (alpha[0] + alpha[1] * q - alpha[2] * q * q) * z
        return np.array([(u - q) / 0.02]), force

    return Damper(1, law, 0.012, 2.0)


def bleed_valve(k: Varied) -> Damper:
    """A velocity curve with a knee, other in release, the field beside it, in series with oil."""
    slow, fast, knee, F, apart = k(2500.0), k(600.0), k(0.1), k(900.0), k(1.5)

    def law(s: Array, x: Array, v: Array, u: Array) -> tuple[Array, Array]:
        q, force = s
        curve = fast * v + (slow - fast) * knee * np.tanh(v / knee)
        steady = curve * np.where(v > 0.0, apart, 1.0) + F * q * np.tanh(v / 0.01)
        return np.array([(u - q) / 0.015, (steady - force) / 0.003]), force

    return Damper(2, law, 0.02, 2.0)


DAMPERS = {d.__name__: d for d in (dahl, lugre, spencer, biviscous, kwok, bleed_valve)}


def log(
    name: str,
    seed: int,
    *,
    random: bool,
    drive: int = 0,
    records: int = 8,
    measured: bool = False,
) -> pd.DataFrame:
    """A log [8 times 10 s] of damper number `seed`; another `drive` has other motions.

    measured : a deflection of 12 bits with half a bit of noise, and no velocity beside it
    """
    values = np.random.default_rng([seed, *name.encode()])
    damper = DAMPERS[name](lambda value: value * float(np.exp(values.normal(0.0, 0.15))))
    g = np.random.default_rng([seed, drive, random, records])
    n, every = round((LEAD_IN + 10.0) * FINE), FINE // RATE
    t = np.arange(n) / FINE - LEAD_IN
    x, v, u = (np.empty((records, n)) for _ in range(3))
    names = []
    for r in range(records):
        x[r], v[r], u[r], said = (_ride if random else _sine)(g, damper, t, every)
        names.append(f"{said}-{r}")
    force = _integrated(damper, x, v, u)[:, t >= 0.0][:, ::every]
    force += NOISE * np.abs(force).max() * g.normal(size=force.shape)
    x, v, u = (signal[:, t >= 0.0][:, ::every] for signal in (x, v, u))
    rows = {"t": np.tile(np.arange(x.shape[1]) / RATE, records), "x": x, "xdot": v, "duty": u}
    table = pd.DataFrame({key: np.ravel(value) for key, value in rows.items()})
    table = table.assign(force=force.ravel(), record=np.repeat(names, x.shape[1]))
    if measured:
        bit = 2.0 * 1.2 * damper.stroke / 4096
        table["x"] = bit * np.round(table["x"] / bit + 0.5 * g.normal(size=len(table)))
        table = table.drop(columns="xdot")
    return table


def _grown(t: Array) -> tuple[Array, Array]:
    """(n,) how far a motion has grown from rest, and the rate of that."""
    q = np.clip((t + LEAD_IN) / RAMP, 0.0, 1.0)
    return q**3 * (10.0 - 15.0 * q + 6.0 * q * q), 30.0 * (q * (1.0 - q)) ** 2 / RAMP


def _ride(
    g: np.random.Generator, d: Damper, t: Array, every: int
) -> tuple[Array, Array, Array, str]:
    """Noise of a band, under a control that steps every 0.3 to 1.2 s."""
    n = len(t)
    f = np.fft.rfftfreq(n, 1.0 / FINE)
    band = (f >= 0.2) & (f <= 1.5 * d.hz)
    a = np.where(band, g.normal(size=len(f)) + 1j * g.normal(size=len(f)), 0.0)
    a /= np.maximum(f, 0.3)
    x, v = np.fft.irfft(a, n), np.fft.irfft(2j * np.pi * f * a, n)
    by, (grown, rate) = d.stroke / np.abs(x).max(), _grown(t)
    held = round(RATE * g.uniform(0.3, 1.2)) * every
    u = np.repeat(g.choice(LEVELS, n // held + 1), held)[:n]
    return by * x * grown, by * (v * grown + x * rate), u, "ride"


def _sine(
    g: np.random.Generator, d: Damper, t: Array, every: int
) -> tuple[Array, Array, Array, str]:
    """One tone under one control."""
    f, level = d.hz * g.choice([0.25, 0.5, 1.0, 1.5]), float(g.choice(LEVELS))
    amplitude = d.stroke * g.uniform(0.5, 1.0) * (0.5 if f > 0.9 * d.hz else 1.0)
    w, (grown, rate) = 2.0 * np.pi * f, _grown(t)
    x, v = np.sin(w * t), w * np.cos(w * t)
    said = f"{f:g}Hz-{1e3 * amplitude:.0f}mm-{level:g}"
    return amplitude * x * grown, amplitude * (v * grown + x * rate), np.full(len(t), level), said


def _integrated(damper: Damper, x: Array, v: Array, u: Array) -> Array:
    """(r, n) force, by Runge and Kutta's fourth order; the control is held over a step."""
    s, force, h = np.zeros((damper.states, len(x))), np.empty_like(x), 1.0 / FINE
    ahead = np.minimum(np.arange(x.shape[1]) + 1, x.shape[1] - 1)
    x_mid, v_mid = 0.5 * (x + x[:, ahead]), 0.5 * (v + v[:, ahead])
    for i, j in enumerate(ahead):
        now = u[:, i]
        k_1, force[:, i] = damper.law(s, x[:, i], v[:, i], now)
        k_2, _ = damper.law(s + 0.5 * h * k_1, x_mid[:, i], v_mid[:, i], now)
        k_3, _ = damper.law(s + 0.5 * h * k_2, x_mid[:, i], v_mid[:, i], now)
        k_4, _ = damper.law(s + h * k_3, x[:, j], v[:, j], now)
        s = s + h / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4)
    return force
