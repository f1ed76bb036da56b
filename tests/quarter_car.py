"""A quarter car of a fifth of the size, its ER damper in a closed loop; nothing of erdctl.

    m_s z_s'' = k_s x + F,   m_u z_u'' = k_t (z_r - z_u) - k_s x - F,   x = z_u - z_s
    F = k_nom x + c_vis xdot + F_ER tanh(xdot / v_y),   T_d F_ER' + F_ER = sigma duty^beta

Masses and springs as of a car that INOVE-like benches carry (assumed). Wheels hop at 33 Hz, which
logs at 100 or 200 Hz hold with three to six samples a cycle; the control switches the duty at
reversals of the motion.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pandas as pd
from numba import njit
from scipy.signal import lfilter

Array = npt.NDArray[np.float64]

H = 5e-5  # s; the motion and the control are integrated at 20 kHz
SPRUNG, UNSPRUNG, SPRING, TYRE = 2.27, 0.32, 1396.0, 12270.0  # kg, kg, N/m, N/m
V_Y = 3e-3  # m/s
CONTROLS = ("none", "on-off skyhook", "clipped skyhook", "groundhook")
ROADS = ("random", "bumps", "sweep", "tones")


@njit(cache=False)
def drive(road: Array, every: int, damper: Array, control: int, low: float, high: float) -> Array:
    """(n, 4) x, xdot, duty and force at every so many steps on a road (m,) [m].

    damper : k_nom, c_vis, T_d, sigma, beta in compression, then in release
    control : number in CONTROLS;  low, high : duty [1], of "none" the lower
    """
    out = np.zeros((len(road) // every, 4))
    z_s = v_s = z_u = v_u = F_ER = 0.0
    duty = low
    for i in range(len(road)):
        x, v = z_u - z_s, v_u - v_s
        if i % 100 == 0:  # the controller's 5 ms
            if control == 1:
                duty = high if -v_s * v > 0 else low
            elif control == 2:
                duty = min(low + 1.5 * abs(v_s), high) if -v_s * v > 0 else low
            elif control == 3:
                duty = high if v_u * v > 0 else low
        at = 0 if v > 0 else 5
        k, c, T_d, sigma, beta = damper[at : at + 5]
        F_ER += (sigma * duty**beta - F_ER) * (1.0 - np.exp(-H / T_d))
        force = k * x + c * v + F_ER * np.tanh(v / V_Y)
        if i % every == 0:
            out[i // every] = (x, v, duty, force)
        body = (SPRING * x + force) / SPRUNG
        wheel = (TYRE * (road[i] - z_u) - SPRING * x - force) / UNSPRUNG
        v_s, v_u = v_s + H * body, v_u + H * wheel
        z_s, z_u = z_s + H * v_s, z_u + H * v_u
    return out


def road(g: np.random.Generator, seconds: float, kind: str) -> Array:
    """(m,) a road from rest [m]."""
    t = np.arange(round(seconds / H)) * H
    size = g.uniform(0.003, 0.008)
    if kind == "random":
        low, high = np.exp(-H * 2 * np.pi * 0.3), np.exp(-H * 2 * np.pi * 15.0)
        z = lfilter([1.0 - high], [1.0, -high], lfilter([1.0], [1.0, -low], g.normal(size=len(t))))
        z *= size / np.std(z)
    elif kind == "bumps":
        z = np.zeros(len(t))
        for at in np.arange(1.0, seconds, g.uniform(1.5, 3.0)):
            along = (t - at) / g.uniform(0.08, 0.3)
            z += np.where(
                (along > 0) & (along < 1), 1.5 * size * (1 - np.cos(2 * np.pi * along)), 0
            )
    elif kind == "sweep":
        phase = 2 * np.pi * (0.5 * t + 11.5 * t * t / (2 * seconds))
        z = 1.4 * size * np.sin(phase) * np.linspace(1.5, 0.4, len(t))
    else:
        slow, fast = g.uniform(1, 4), g.uniform(5, 9)
        z = size * (1.4 * np.sin(2 * np.pi * slow * t) + 0.5 * np.sin(2 * np.pi * fast * t + 1.0))
    return np.asarray(z * np.minimum(1.0, t))


def log(
    seed: int, rate: int, *, records: int = 6, seconds: float = 10.0, velocity: float = 3e-4
) -> pd.DataFrame:
    """A log of a plain damper in the car: white noise on all channels.

    velocity : noise of xdot [m/s]
    """
    g = np.random.default_rng(seed)
    way = [(150, 250), (50, 80), (0.015, 0.06), (12, 25), (0.3, 0.8)]
    damper = np.array([g.uniform(*bounds) for bounds in 2 * way])
    parts = []
    for k in range(records):
        control = 0 if k == 0 else int(g.integers(len(CONTROLS)))
        z = road(g, seconds, str(g.choice(ROADS)))
        low, high = g.choice([0.0, 0.05, 0.1]), g.choice([0.25, 0.35, 0.45])
        x, v, duty, force = drive(z, round(1 / H / rate), damper, control, low, high).T
        n = len(x)
        parts.append(
            pd.DataFrame({
                "t": np.arange(n) / rate, "x": x + 1e-5 * g.normal(size=n),
                "xdot": v + velocity * g.normal(size=n), "duty": duty,
                "force": force + 0.3 * g.normal(size=n), "record": f"r{k}",
            })
        )  # fmt: skip
    return pd.concat(parts, ignore_index=True)
