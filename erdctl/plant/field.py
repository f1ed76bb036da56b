"""From duty to yield force: supply, field, chains.

    e = voltage as a fraction of full scale, delayed, slew-limited
    target = sigma (e - e_c)^beta                 chains form above a critical field only
    target = sigma e_s^beta tanh((e / e_s)^beta)  polarisation is exhausted towards e_s, or sharply
    target = sigma e^beta (1 + (e / e_s)^(beta n))^(-1/n)
    T_d dF/dt + F = target                        Eq. 12; on the force with its sign if `signed`

Source: the paper, Eqs. 7, 10-12; saturation of the dipoles: Choi, Cho, Jhon (2001).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from erdctl.plant.plant import Physics, Side

Array = npt.NDArray[np.float64]


@njit(cache=True)
def held(duty: Array, step: int, substeps: int, lead_in: int) -> float:
    """Duty during a fine step; each sample holds until the next, the first one before t = 0."""
    sample = (step - lead_in) // substeps
    return float(duty[min(max(sample, 0), len(duty) - 1)])


@njit(cache=True)
def commanded(
    duty: Array, step: int, substeps: int, lead_in: int, h: float, dead_time: float
) -> float:
    """Mean duty over a fine step, a dead time ago."""
    if dead_time == 0.0:
        return held(duty, step, substeps, lead_in)
    past = dead_time / h
    whole = math.floor(past)
    part = past - whole
    earlier = held(duty, step - whole - 1, substeps, lead_in)
    later = held(duty, step - whole, substeps, lead_in)
    return part * earlier + (1.0 - part) * later


@njit(cache=True)
def commands(
    duty: Array, count: int, substeps: int, lead_in: int, h: float, dead_time: float
) -> Array:
    """(count,) `commanded` of the step that ends at each fine node; the first has no length."""
    out = np.empty(count)
    for k in range(count):
        out[k] = commanded(duty, max(k - 1, 0), substeps, lead_in, h, dead_time)
    return out


@njit(cache=True)
def slewed(voltage: float, command: float, h: float, slew: float) -> float:
    """Voltage one step later, at no more than 1/slew of full scale per second."""
    if slew == 0.0:
        return command
    most = h / slew
    return voltage + min(max(command - voltage, -most), most)


@njit(cache=True)
def target(voltage: float, side: Side, p: Physics) -> float:
    """Yield force that chains reach in a steady field [N]."""
    e = voltage - p.threshold
    if e <= 0.0:
        return 0.0
    if p.screening == 0.0:
        return float(side.sigma * e**side.beta)
    full = p.screening**side.beta
    level = full * e**side.beta
    if p.knee == 0.0:
        return float(side.sigma * math.tanh(level) / full)
    return float(side.sigma * level / (full * (1.0 + level**p.knee) ** (1.0 / p.knee)))


class Fades(NamedTuple):
    """What a whole fine step leaves of a distance to the target: exp(-h/T)."""

    up_forming: float
    up_dissolving: float
    down_forming: float
    down_dissolving: float


@njit(cache=True)
def left(h: float, T_d: float) -> float:
    """exp(-h/T_d); nothing if there is no lag."""
    if T_d == 0.0:
        return 0.0
    return math.exp(-h / T_d)


@njit(cache=True)
def fades(h: float, up: Side, down: Side, p: Physics) -> Fades:
    """For steps of h, computed once."""
    return Fades(
        left(h, up.T_d * p.rise), left(h, up.T_d * p.decay),
        left(h, down.T_d * p.rise), left(h, down.T_d * p.decay),
    )  # fmt: skip


@njit(cache=True)
def advanced(
    F: float, was: float, now: float, v0: float, v1: float,
    goal_c: float, goal_r: float, h: float, fade: Fades, up: Side, down: Side, p: Physics,
) -> float:  # fmt: skip
    """Yield state after a step of Eq. 12 towards constant goals, without error; a turn inside the
    step divides it where the speed is zero.

    was, now : direction before and after, +1 or -1;  goal_c, goal_r : targets of either
    Check: F = 0, goal 1 N, h = T_d, no turn gives 1 - 1/e = 0.632 N.
    >>> side, p = Side(k_nom=0.0, c_vis=0.0, T_d=0.04, sigma=1.0, beta=1.0), Physics()
    >>> fade = fades(0.04, side, side, p)
    >>> round(advanced(0.0, 1.0, 1.0, 0.1, 0.1, 1.0, 1.0, 0.04, fade, side, side, p), 3)
    0.632
    """
    if h == 0.0:
        return F
    if was != now and v0 != v1:
        share = min(max(v0 / (v0 - v1), 0.0), 1.0)
        F = _part(F, was, goal_c, goal_r, share * h, up, down, p)
        return _part(F, now, goal_c, goal_r, (1.0 - share) * h, up, down, p)
    goal = goal_c if now > 0.0 else goal_r
    if p.signed != 0.0:
        goal *= now
    if abs(goal) > abs(F):
        return goal + (F - goal) * (fade.up_forming if now > 0.0 else fade.down_forming)
    return goal + (F - goal) * (fade.up_dissolving if now > 0.0 else fade.down_dissolving)


@njit(cache=True)
def _part(
    F: float, way: float, goal_c: float, goal_r: float, h: float, up: Side, down: Side, p: Physics
) -> float:
    if h == 0.0:
        return F
    goal = goal_c if way > 0.0 else goal_r
    if p.signed != 0.0:
        goal *= way
    T = (up.T_d if way > 0.0 else down.T_d) * (p.rise if abs(goal) > abs(F) else p.decay)
    return goal + (F - goal) * left(h, T)
