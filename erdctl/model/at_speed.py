"""Forces behind a spring at one speed of the piston, compiled for `erdctl.model.series_compliance`.

What is compiled is kept beside each file, and follows the changes of that file alone: after a
change here delete __pycache__.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from erdctl.core.recording import Array


class SpeedLaws(NamedTuple):
    """Forces behind the spring.

    grid : (m,) speeds;  viscous, sign, friction : (2, m) laws on it, for compression and release
    factor : (2, m) of the yield force where that is not F_ER sign(v) alone
    """

    grid: Array
    viscous: Array
    sign: Array
    friction: Array
    factor: Array


class Other(NamedTuple):
    """What no law of the speed alone is.

    yields : whether the yield force is not F_ER sign(v) with that sign alone
    lead : kappa [1/s] of a sign law that is one of v + kappa x_p
    T_s : time over which the force follows it [s];  x_d : travel over which the hysteretic variable
        follows its sign law [m]; 0 at once, and never both
    F_c, x_c : friction [N] that follows the direction over a travel [m]
    """

    yields: bool
    lead: float
    T_s: float
    x_d: float
    F_c: float
    x_c: float


class Leg(NamedTuple):
    """A step, or a part of one, in one direction of the rod, and what is known as it ends.

    dt : its length [s];  x : in place of the deflection in the gas force;  rod : that of the rod
    beside : forces that the rod's motion makes [N]
    Y : F_ER;  by : see `SignSlot`;  k_c, k_r : gas stiffness;  viscous, yields : factors
    half : half of the free play;  s : compliance
    was, Y_0, smooth : signed yield force before the leg, F_ER, and its sign law but for the jump
    h : hysteretic variable before the leg
    z : part of the friction that followed the direction, by then
    c : damping of the spring [N s/m];  end : speed of the rod as the leg ends
    pull, push : slope of mass and damping by the piston's speed [N s/m], and their force at rest
    v : speed of the piston as the leg begins;  level, kept : as it ends, if it is accelerated as
        the rod, or as in its last step
    """

    dt: float
    x: float
    rod: float
    beside: float
    Y: float
    by: float
    k_c: float
    k_r: float
    viscous: float
    yields: float
    half: float
    s: float
    was: float
    Y_0: float
    smooth: float
    h: float
    z: float
    c: float
    end: float
    pull: float
    push: float
    v: float
    level: float
    kept: float


@njit(cache=True, inline="always")
def value(law: Array, grid: Array, v: float, way: float) -> float:
    """A law (2, m) on a grid of speeds at a speed v, at 0 from the side `way`; level beyond."""
    branch, speed = (0 if v > 0.0 or (v == 0.0 and way > 0.0) else 1), abs(v)
    j = min(max(int(np.searchsorted(grid, speed)), 1), len(grid) - 1)
    w = min(max((speed - grid[j - 1]) / (grid[j] - grid[j - 1]), 0.0), 1.0)
    return float(law[branch, j - 1] * (1.0 - w) + law[branch, j] * w)


@njit(cache=True, inline="always")
def followed(
    v: float, way: float, travel: float, e: float, i: Leg, d: SpeedLaws, o: Other
) -> tuple[float, float, float]:
    """Signed yield force at a speed v of the piston, its sign law there but for the jump, and the
    hysteretic variable.

    It follows a straight line from where F_ER sign(v) was. What jumps with the direction has that
    of now from the start, so that it does not matter whether the piston rested or hardly moved.
    """
    sheared = (v + o.lead * (i.rod - e)) / i.by
    law = value(d.sign, d.grid, sheared, way)
    jump = 0.5 * (d.sign[0, 0] - d.sign[1, 0])
    jump *= 1.0 if sheared > 0.0 or (sheared == 0.0 and way > 0.0) else -1.0
    target, smooth = i.Y * law, law - jump
    if o.T_s == 0.0 and o.x_d == 0.0:
        return target, smooth, 0.0
    z = i.dt / o.T_s if o.T_s > 0.0 else travel / o.x_d
    if z == 0.0:
        return i.was if o.T_s > 0.0 else i.Y * i.h, smooth, i.h
    gone = -np.expm1(-z)
    new = 1.0 - gone / z
    before = i.smooth + jump
    if o.T_s > 0.0:
        was, before = (1.0 - gone) * i.was, i.Y_0 * before
        return was + (gone - new) * before + new * target, smooth, 0.0
    h = (1.0 - gone) * i.h + (gone - new) * before + new * law
    return i.Y * h, smooth, h


@njit(cache=True, inline="always")
def slid(way: float, travel: float, i: Leg, o: Other) -> float:
    """Part of the friction that follows the direction, after a travel of the piston."""
    return float(way + (i.z - way) * np.exp(-travel / o.x_c)) if o.F_c > 0.0 else 0.0


@njit(cache=True, nogil=True)
def along(v: Array, grid: Array, law: Array) -> Array:
    """(n,) value of a law (2, m) on a grid of speeds at the speeds v (n,); 0 at rest."""
    out = np.zeros(len(v))
    for i in range(len(v)):
        if v[i] != 0.0:
            out[i] = value(law, grid, v[i], 0.0)
    return out
