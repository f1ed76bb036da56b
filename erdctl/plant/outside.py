"""Physics that no entry of the contract's table describes, as states and forces.

leakage      U' = U (1 - l),            dl/dt = (leakage [U > 0] U - l) / leakage_time
sediment     yield (1 - s),             ds/dt = -s |v| / stirring
ripple       yield (1 + r sin(2 pi f t))
swing        viscosity (1 + a sin(2 pi n U))
memory       F = A (y_1 - y_2),         dy_i/dt = (v|v|/V^2 - y_i) / tau_i, tau_1 < tau_2
bleed valve  opens above a compression force, leaves a part of what exceeds its closing force
chatter      F = k q,  dq = dx;  at |q| = break the seal springs back by `slip`
wear         F = W exp(-passes(x)) sign(v), passes counted over each spot of the bore
gas heat     F = k (x - y),             dy/dt = (x - y) / tau
bumps        F = B g(x) sign(v), g an uneven bore
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from erdctl.plant.law import bore
from erdctl.plant.plant import Outside

Array = npt.NDArray[np.float64]

SPOTS = 65  # of the bore, over which wear is counted
LEAK, SEDIMENT, SHORT, LONG, VALVE, STRETCH, COLD, MAP = range(8)
STATES = MAP + SPOTS


@njit(cache=True)
def restart(s: Array, x: float, o: Outside) -> None:
    """A record begins: rested, settled, unworn."""
    s[:] = 0.0
    s[SEDIMENT] = o.settled
    s[COLD] = x


@njit(cache=True)
def field_left(s: Array, voltage: float, h: float, o: Outside) -> float:
    """Voltage that leakage leaves at the electrodes."""
    if o.leakage == 0.0:
        return voltage
    s[LEAK] += (1.0 - math.exp(-h / o.leakage_time)) * (o.leakage * voltage - s[LEAK])
    return float(voltage * (1.0 - s[LEAK]))


@njit(cache=True)
def yield_factor(s: Array, t: float, o: Outside) -> float:
    """Of sediment and ripple."""
    return float((1.0 - s[SEDIMENT]) * (1.0 + o.ripple * math.sin(2 * math.pi * o.ripple_rate * t)))


@njit(cache=True)
def viscous_factor(voltage: float, o: Outside) -> float:
    """Of a viscosity that swings with the duty."""
    if o.swing == 0.0:
        return 1.0
    return float(1.0 + o.swing * math.sin(2 * math.pi * o.swings * voltage))


@njit(cache=True)
def bled(s: Array, fluid: float, o: Outside) -> float:
    """Fluid force behind a bleed valve with a spring that snaps."""
    if o.bleed == 0.0:
        return fluid
    if fluid > o.bleed_opens:
        s[VALVE] = 1.0
    elif fluid < o.bleed_closes:
        s[VALVE] = 0.0
    if s[VALVE] == 0.0:
        return fluid
    return o.bleed_closes + o.bleed * (fluid - o.bleed_closes)


@njit(cache=True)
def advance(s: Array, x0: float, x1: float, v0: float, v1: float, h: float, o: Outside) -> None:
    """The states one step later."""
    travel = abs(x1 - x0)
    if o.settled != 0.0:
        s[SEDIMENT] *= math.exp(-travel / o.stirring)
    if o.memory != 0.0:
        mid = 0.5 * (v0 + v1)
        drive = mid * abs(mid) / o.memory_speed**2
        s[SHORT] += (1.0 - math.exp(-h / o.memory_short)) * (drive - s[SHORT])
        s[LONG] += (1.0 - math.exp(-h / o.memory_long)) * (drive - s[LONG])
    if o.chatter != 0.0:
        s[STRETCH] += x1 - x0
        if abs(s[STRETCH]) > o.chatter_break:
            s[STRETCH] -= math.copysign(o.chatter_slip, s[STRETCH])
    if o.gas_heat != 0.0:
        s[COLD] += (1.0 - math.exp(-h / o.gas_heat_time)) * (0.5 * (x0 + x1) - s[COLD])
    if o.wear != 0.0:
        spot = _spot(0.5 * (x0 + x1), o)
        j = min(int(spot), SPOTS - 2)
        part = spot - j
        s[MAP + j] += (1.0 - part) * travel / o.wear_travel
        s[MAP + j + 1] += part * travel / o.wear_travel


@njit(cache=True)
def force(s: Array, x: float, way: float, o: Outside) -> float:
    """All forces from outside the table that act beside the fluid [N]."""
    total = o.memory * (s[SHORT] - s[LONG]) + o.chatter * s[STRETCH] + o.gas_heat * (x - s[COLD])
    if o.bumps != 0.0:
        total += o.bumps * bore(x, o) * way
    if o.wear != 0.0:
        spot = _spot(x, o)
        j = min(int(spot), SPOTS - 2)
        part = spot - j
        passes = (1.0 - part) * s[MAP + j] + part * s[MAP + j + 1]
        total += o.wear * math.exp(-passes) * way
    return float(total)


@njit(cache=True)
def _spot(x: float, o: Outside) -> float:
    place = 0.5 * (x / o.wear_span + 1.0) * (SPOTS - 1)
    return min(max(place, 0.0), SPOTS - 1.0)
