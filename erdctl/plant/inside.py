"""The damper behind the rod during one fine step, and the speed at which its forces balance.

A spring in series hides the speed of what lies behind it; it is found from

    mount:  e / s + c de/dt = fluid + gas + stops + seals + m dv/dt,   x_p' = x_p + h v
            e = x - x_p beyond -g/2..g/2, 0 within: play in the mount's joint bears no force but
            that of what fills it, c (xdot - v)
    fluid column:  (e - h v) / s = fluid,   e = deflection of the column if its fluid stood still

by implicit Euler, which is stable for every s > 0. At v = 0 the dry forces may take any value
between their limits from either side: the body rests if the spring's force lies between them.
"""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from erdctl.plant.field import Fades, advanced
from erdctl.plant.law import bent, direction, friction, gas, stops, viscous
from erdctl.plant.plant import Physics, Side

MOUNT = 1
COLUMN = 2


class Instant(NamedTuple):
    """What is known before the speed at the end of a fine step is.

    x0, v0, way0 : position, speed and direction of the body behind the spring before the step
    drive, rate : deflection that pulls the spring [m], and its speed [m/s]
    x1 : of the piston, where the spring is not its [m]
    yielding, goal_c, goal_r : yield state before the step, and its targets [N]
    bend : friction of the bent seal before the step [N];  void : not yet taken up [m]
    on_gas, on_viscous, on_yield : factors of faults, heat and the like
    told, sign : whether there is a given value in place of sign(xdot), and that value
    """

    h: float
    x0: float
    v0: float
    way0: float
    drive: float
    rate: float
    x1: float
    fade: Fades
    yielding: float
    goal_c: float
    goal_r: float
    bend: float
    void: float
    on_gas: float
    on_viscous: float
    on_yield: float
    told: bool
    sign: float


@njit(cache=True)
def yield_state(v: float, way: float, i: Instant, up: Side, down: Side, p: Physics) -> float:
    """State of Eq. 12 after the step [N]."""
    now = i.way0 if way == 0.0 else way
    return advanced(
        i.yielding, i.way0, now, i.v0, v, i.goal_c, i.goal_r, i.h, i.fade, up, down, p
    )  # fmt: skip


@njit(cache=True)
def fluid(x: float, v: float, way: float, i: Instant, up: Side, down: Side, p: Physics) -> float:
    """Viscous and yield force [N]."""
    now = i.way0 if way == 0.0 else way
    left = 1.0
    if i.void > 0.0 and now < 0.0:
        # The gas that came out of the oil is squeezed back at p V = const.
        bubbles = p.bubbles * p.void
        left = bubbles / (bubbles + i.void)
    state = yield_state(v, way, i, up, down, p)
    if p.signed == 0.0:
        state *= i.sign if i.told else direction(x, v, way, p)
    loss = viscous(x, v, up if now > 0.0 else down, p)
    return left * (i.on_viscous * loss + i.on_yield * state)


@njit(cache=True)
def beside(x: float, v: float, way: float, i: Instant, up: Side, down: Side, p: Physics) -> float:
    """Gas, stops and seals, which act beside the fluid [N]."""
    now = i.way0 if way == 0.0 else way
    held = i.on_gas * (gas(x, up if now > 0.0 else down, p) + p.preload)
    return held + stops(x, v, p) + friction(v, way, p) + bent(i.bend, x - i.x0, p)


@njit(cache=True)
def stretch(apart: float, p: Physics) -> float:
    """Of the mount between a rod and a piston that are so far apart [m]."""
    return max(apart - 0.5 * p.gap, 0.0) + min(apart + 0.5 * p.gap, 0.0)


@njit(cache=True)
def _excess(v: float, way: float, mode: int, i: Instant, up: Side, down: Side, p: Physics) -> float:
    """Force of the spring beyond that of the body behind it [N]; falls with v."""
    if mode == MOUNT:
        x = i.x0 + i.h * v
        spring = stretch(i.drive - x, p) / p.mount + p.film * (i.rate - v)
        inertia = p.mass * (v - i.v0) / i.h
        return (
            spring - inertia
            - fluid(x, v, way, i, up, down, p) - beside(x, v, way, i, up, down, p)
        )  # fmt: skip
    return (i.drive - i.h * v) / p.fluid_spring - fluid(i.x1, v, way, i, up, down, p)


@njit(cache=True)
def balanced(mode: int, i: Instant, up: Side, down: Side, p: Physics) -> tuple[float, float]:
    """Speed at which the forces balance, and its direction (0 at rest)."""
    way = i.way0
    first = way * _excess(0.0, way, mode, i, up, down, p)
    if first <= 0.0:  # it does not go on; where it could go either way it goes on as before
        way = -way
        first = way * _excess(0.0, way, mode, i, up, down, p)
        if first <= 0.0:
            return 0.0, 0.0
    soft = p.mount if mode == MOUNT else p.fluid_spring
    side = up if way > 0.0 else down
    # w = |v|; a straight line through what is linear lands on the root if all is linear.
    slope = i.h / soft + i.on_viscous * side.c_vis
    if mode == MOUNT:
        slope += p.mass / i.h + p.film
    low, f_low = 0.0, first
    high = first / slope
    f_high = way * _excess(way * high, way, mode, i, up, down, p)
    close = 1e-9 * abs(first) + 1e-300
    for _ in range(60):
        if f_high <= 0.0:
            break
        low, f_low = high, f_high
        high *= 2.0
        f_high = way * _excess(way * high, way, mode, i, up, down, p)
    if abs(f_high) <= close:
        return way * high, way
    last = 0
    for _ in range(60):
        w = (low * f_high - high * f_low) / (f_high - f_low)
        f = way * _excess(way * w, way, mode, i, up, down, p)
        if abs(f) <= close or high - low <= 1e-12 * high:
            return way * w, way
        if f > 0.0:  # Illinois: halve the end that stays, or one end would never move
            low, f_low = w, f
            if last == 1:
                f_high *= 0.5
            last = 1
        else:
            high, f_high = w, f
            if last == -1:
                f_low *= 0.5
            last = -1
    return way * 0.5 * (low + high), way
