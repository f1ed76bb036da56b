"""Forces of gas, fluid, stops and seals at one instant.

`way` is the direction of motion, +1 compression and -1 release; at standstill it is the side from
which a limit is taken, and 0 where the body does rest (Eq. 18: no yield force then).
"""

from __future__ import annotations

import math

from numba import njit

from erdctl.plant.plant import FOREVER, Outside, Physics, Side


@njit(cache=True)
def gas(x: float, side: Side, p: Physics) -> float:
    """Gas force without its static part [N]: Eq. 14, or Eq. 3 with closing = A_s/V_0.

    P_0 A_s ((1 - x/L)^-n - 1) with P_0 A_s = k L / n, so that k stays the stiffness at x = 0.
    Check: k = 100 N/m, L = 0.1 m, n = 1, x = 0.05 m gives 100 * 0.1 * (2 - 1) = 10 N.
    >>> side, p = Side(100.0, 0.0, 0.0, 0.0, 1.0), Physics(closing=10.0, polytropic=1.0)
    >>> round(gas(0.05, side, p), 9)
    10.0
    """
    if p.closing == 0.0:
        return side.k_nom * x
    left = max(1.0 - p.closing * x, 1e-3)
    return float(side.k_nom / (p.polytropic * p.closing) * (left**-p.polytropic - 1.0))


@njit(cache=True)
def pressed(d: float, v: float, p: Physics) -> float:
    """Force of one stop by depth and its speed [N]."""
    if p.stop_depth >= FOREVER:
        return p.stop_rate * d * max(1.0 + p.stop_loss * v, 0.0)
    depth = p.stop_depth * (1.0 - math.exp(-d / p.stop_depth))
    return p.stop_rate * max(d + p.stop_loss * v * depth, 0.0)


@njit(cache=True)
def stops(x: float, v: float, p: Physics) -> float:
    """Contact force of the stops [N]: k d (1 + loss dd/dt), and never a pull.

    The damping may level off, as that of a rubber that is compressed all over: its d is then
    e (1 - exp(-d / e)).

    Check: k = 1000 N/m, loss = 2 s/m, 1 mm deep at 0.25 m/s gives 1000 * 0.001 * 1.5 = 1.5 N.
    >>> p = Physics(stop_high=0.01, stop_rate=1000.0, stop_loss=2.0)
    >>> round(stops(0.011, 0.25, p), 9), stops(0.011, -1.0, p)
    (1.5, 0.0)
    """
    if x > p.stop_high:
        return pressed(x - p.stop_high, v, p)
    if x < p.stop_low:
        return -pressed(p.stop_low - x, -v, p)
    return 0.0


@njit(cache=True)
def viscous(x: float, v: float, side: Side, p: Physics) -> float:
    """Loss in the duct [N]: linear, thinned by shear, turbulent; the duct may be tapered.

    c v_ref |v/v_ref|^n sign(v)
    Check: c = 10, v_ref = 1, n = 0.5, v = 0.25 m/s gives 5 N.
    >>> side = Side(0.0, 10.0, 0.0, 0.0, 1.0)
    >>> viscous(0.0, 0.25, side, Physics(flow_index=0.5, v_ref=1.0))
    5.0
    """
    if p.flow_index == 1.0:
        linear = side.c_vis * v
    else:
        shear = abs(v) / p.v_ref
        linear = math.copysign(side.c_vis * p.v_ref * shear**p.flow_index, v)
    # A duct never closes by its taper.
    width = max(1.0 + p.taper * x + p.groove * x * x, 0.02)
    return float(linear * width + p.turbulent * v * abs(v))


@njit(cache=True)
def direction(x: float, v: float, way: float, p: Physics) -> float:
    """What stands in the place of sign(xdot): tanh((v + lead x) / v_y)."""
    if p.v_y > 0.0:
        return math.tanh((v + p.lead * x) / p.v_y)
    return way


@njit(cache=True)
def friction(v: float, way: float, p: Physics) -> float:
    """Dry friction of seals that do not bend [N]."""
    force = p.F_c
    if p.F_s != 0.0:
        force += p.F_k + (p.F_s - p.F_k) * math.exp(-((v / p.v_s) ** 2))
    return way * force


@njit(cache=True)
def bent(F: float, travel: float, p: Physics) -> float:
    """Friction of a seal that bends, after some more travel (Dahl 1968) [N]:
    dF/dx = (F_p - F sign(v)) / x_p, solved without error for travel in one direction."""
    if p.F_p == 0.0 or travel == 0.0:
        return F
    limit = math.copysign(p.F_p, travel)
    return limit + (F - limit) * math.exp(-abs(travel) / p.x_p)


@njit(cache=True)
def bore(x: float, o: Outside) -> float:
    """Relative drag of an uneven bore, >= 0: five waves of unlike length, where positive."""
    u = 2.0 * math.pi * x / o.bump_pitch + o.bump_phase
    waves = (
        math.sin(u) + math.sin(2.3 * u + 1.7) + math.sin(3.7 * u + 4.1)
        + 0.8 * math.sin(5.9 * u + 0.6) + 0.6 * math.sin(8.3 * u + 2.9)
    )  # fmt: skip
    return max(waves, 0.0)
