"""A quarter car of a fifth of the size, its ER damper in a closed loop; nothing of erdctl.

    m_s z_s'' = k_s x + F,   m_u z_u'' = k_t (z_r - z_u) - k_s x - F,   x = z_u - z_s
    F = k_nom x + c_vis xdot + F_ER tanh(xdot / v_y),   T_d F_ER' + F_ER = sigma duty^beta

and one effect of `EFFECTS` more, and one of `FAULTS` from a time on, if asked for.

Masses and springs as of a car that INOVE-like benches carry (assumed). Wheels hop at 33 Hz, which
logs at 100 or 200 Hz hold with three to six samples a cycle; the control switches the duty at
reversals of the motion.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd
from numba import njit
from scipy.signal import lfilter

Array = npt.NDArray[np.float64]

FAULTS = ("oil_leakage", "electrical_fault", "deformation_fault")

H = 5e-5  # s; the motion and the control are integrated at 20 kHz
SPRUNG, UNSPRUNG, SPRING, TYRE = 2.27, 0.32, 1396.0, 12270.0  # kg, kg, N/m, N/m
V_Y = 3e-3  # m/s
CONTROLS = ("none", "on-off skyhook", "clipped skyhook", "groundhook")
ROADS = ("random", "bumps", "sweep", "tones")
EFFECTS: dict[str, tuple[float, ...]] = {
    "none": (),
    "coulomb_friction": (1.5,),  # N
    "stribeck_friction": (1.0, 2.5, 0.02),  # N, N, m/s
    "gas_preload": (1.5,),  # N
    "quadratic_damping": (80.0,),  # N s^2/m^2
    "thermal_fade": (0.015, 0.15, 200.0),  # 1/degC, degC/J, s
    "end_stop": (0.006, 3000.0),  # m, N/m
    "rise_decay_asymmetry": (3.0,),
    "field_saturation": (0.15,),  # of the duty
    "position_dependent_damping": (40.0,),  # 1/m
    "input_delay": (0.012,),  # s
    "presliding_friction": (2.0, 3e-4),  # N, m
    "preyield_viscosity": (0.02,),  # m/s
    "shear_thinning": (0.3,),  # m/s
    "field_viscosity": (1.5,),  # of the viscosity at full duty
    "time_skew": (0.003,),  # s, the force later
}


@njit(cache=False)
def drive(
    road: Array,
    every: int,
    damper: Array,
    control: int,
    duties: tuple[float, float],
    effect: int,
    p: Array,
    fault: int,
    left: float,
    onset: float,
) -> Array:
    """(n, 4) x, xdot, duty and force at every so many steps on a road (m,) [m].

    damper : k_nom, c_vis, T_d, sigma, beta in compression, then in release
    control : number in CONTROLS;  duties : low and high [1], of "none" the lower
    effect, p : number in EFFECTS and its values, of which there are at least three
    fault, left, onset : number in FAULTS, effectiveness that is left [1], from when on [s]
    """
    out = np.zeros((len(road) // every, 4))
    z_s = v_s = z_u = v_u = F_ER = bristle = heat = 0.0
    low, high = duties
    duty, past = low, np.full(2000, low)
    for i in range(len(road)):
        x, v = z_u - z_s, v_u - v_s
        if i % 100 == 0:  # the controller's 5 ms
            if control == 1:
                duty = high if -v_s * v > 0 else low
            elif control == 2:
                duty = min(low + 1.5 * abs(v_s), high) if -v_s * v > 0 else low
            elif control == 3:
                duty = high if v_u * v > 0 else low
        past[i % 2000] = duty
        at = 0 if v > 0 else 5
        k, c, T_d, sigma, beta = damper[at : at + 5]
        u, v_y, level = duty, V_Y, 1.0
        if effect == 5:
            level = np.exp(-p[0] * heat)
        elif effect == 8:
            u = p[0] * np.tanh(u / p[0])
        elif effect == 9:
            c *= 1.0 + p[0] * x
        elif effect == 10:
            u = past[max(i - int(p[0] / H), 0) % 2000]
        elif effect == 12:
            v_y = p[0]
        elif effect == 13:
            c /= 1.0 + abs(v) / p[0]
        elif effect == 14:
            c *= 1.0 + p[0] * u
        aim = level * sigma * u**beta
        falls = effect == 7 and aim < F_ER
        F_ER += (aim - F_ER) * (1.0 - np.exp(-H / (p[0] * T_d if falls else T_d)))
        f = left if i * H >= onset else 1.0
        force = (f if fault == 0 else 1.0) * k * x + f * F_ER * np.tanh(v / v_y)
        force += (1.0 if fault == 1 else f) * level * c * v
        rubbing = np.tanh(v / 1e-4)
        if effect == 1:
            force += p[0] * rubbing
        elif effect == 2:
            force += (p[0] + (p[1] - p[0]) * np.exp(-((v / p[2]) ** 2))) * rubbing
        elif effect == 3:
            force += p[0]
        elif effect == 4:
            force += p[0] * v * abs(v)
        elif effect == 5:
            heat += H * (p[1] * force * v - heat / p[2])
        elif effect == 6:
            force += p[1] * max(x - p[0], 0.0)
        elif effect == 11:
            bristle += H * (v - abs(v) * bristle / p[1])
            force += p[0] * bristle / p[1]
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


def damper(g: np.random.Generator) -> Array:
    """(10,) k_nom, c_vis, T_d, sigma, beta in compression, then in release: the first of a seed."""
    way = [(150, 250), (50, 80), (0.015, 0.06), (12, 25), (0.3, 0.8)]
    return np.array([g.uniform(*bounds) for bounds in 2 * way])


def log(
    seed: int,
    rate: int,
    *,
    records: int = 6,
    seconds: float = 10.0,
    velocity: float = 3e-4,
    effect: str = "none",
    fault: str = FAULTS[0],
    left: float = 0.6,
    onsets: Sequence[float] = (),
) -> pd.DataFrame:
    """A log of a damper in the car: white noise on all channels.

    velocity : noise of xdot [m/s];  fault, left : see `drive`
    onsets : when it sets in in each record [s], inf for never; none in any if empty
    """
    names = list(EFFECTS)
    own = np.array([*EFFECTS[effect], 0.0, 0.0, 0.0])
    g = np.random.default_rng(seed)
    values = damper(g)
    parts = []
    for k in range(records):
        control = 0 if k == 0 else int(g.integers(len(CONTROLS)))
        z = road(g, seconds, str(g.choice(ROADS)))
        low, high = g.choice([0.0, 0.05, 0.1]), g.choice([0.25, 0.35, 0.45])
        every = round(1 / H / rate)
        number = names.index(effect)
        wrong = FAULTS.index(fault), left, onsets[k] if onsets else np.inf
        x, v, duty, force = drive(z, every, values, control, (low, high), number, own, *wrong).T
        n = len(x)
        if effect == "time_skew":
            force = np.interp(np.arange(n) / rate - own[0], np.arange(n) / rate, force)
        parts.append(
            pd.DataFrame({
                "t": np.arange(n) / rate, "x": x + 1e-5 * g.normal(size=n),
                "xdot": v + velocity * g.normal(size=n), "duty": duty,
                "force": force + 0.3 * g.normal(size=n), "record": f"r{k}",
            })
        )  # fmt: skip
    return pd.concat(parts, ignore_index=True)
