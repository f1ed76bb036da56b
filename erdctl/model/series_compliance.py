"""A spring in series with the damper, or with its fluid: the force feeds back on the motion.

    de/dt = xdot - v,   s F = e beyond -g/2..g/2, 0 within,   x_p = x - e
    F = gas(x_p) + viscous(v) + F_ER sign(v) + friction(v)

e is the spring's stretch and g free play in its joint, which bears no force: after a reversal the
spring unloads, the play is crossed, and it loads again.

Implicit in v: each sample solves one equation that is monotone in v, with a stick branch (v = 0,
the spring alone moves) where the yield force holds. The rod's travel in a step is the mean of its
speeds; where the piston moves with it, its own is to its last speed v as the rod's is to xdot. So
an error of second order in the step remains both in stick and when the spring is stiff. It is
stable for every compliance s > 0 and goes over into the model without a spring as s goes to 0.
It is simulated free-running: correcting with the measured force would feed its noise back.

Source: return mapping of elasto-viscoplasticity, Simo and Hughes, Computational Inelasticity
(1998), Ch. 1; series compliance of dampers: Maxwell element.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numba import njit

from erdctl.core.recording import Array, Index

NODES = 192  # of the speed grid: laws between nodes are straight lines
SLOWEST = 0.25  # of the speed in a step that the end of it may have in the rule below


@lru_cache(maxsize=64)
def speed_grid(fastest: float) -> Array:
    """(NODES,) speeds [m/s] on which laws are tabulated, well beyond the fastest recorded one."""
    return np.geomspace(1e-7, 4.0 * max(fastest, 1e-3), NODES)


def level_beyond(law: Array) -> Array:
    """A law (2, m) on a grid of speeds, so that beyond it what falls goes on as it is there.

    A spring lets a piston slip faster than the grid goes. On its last line a friction that falls
    would turn round there, and drive the piston ever faster.
    Check: 3, 2 falls and becomes 3, 3; -1, -2 grows and stays.
    >>> level_beyond(np.array([[3.0, 2.0], [-1.0, -2.0]])).tolist()
    [[3.0, 3.0], [-1.0, -2.0]]
    """
    out = law.copy()
    falls = np.abs(law[:, -1]) < np.abs(law[:, -2])
    out[falls, -1] = law[falls, -2]
    return out


@njit(cache=True)
def _held(e: float, half: float, s: float) -> float:
    """Force of the spring at a stretch e, with a free play of 2 half."""
    return (max(e - half, 0.0) + min(e + half, 0.0)) / s


@njit(cache=True)
def _excess(
    at: float, x: float, k: float, half: float, s: float, viscous: float, plastic: float,
    friction: float,
) -> float:  # fmt: skip
    """Force of the damper beyond that of the spring at a stretch."""
    return k * (x - at) - _held(at, half, s) + viscous + plastic + friction


@njit(cache=True)
def _moved(
    e: float, mean: float, end: float, dt: float, s: float, x: float, Y: float, k_c: float,
    k_r: float, g_visc: float, half: float, near: int, grid: Array, viscous: Array, sign: Array,
    friction: Array,
) -> tuple[float, float, int]:  # fmt: skip
    """Stretch of the spring and speed behind it at the end of a leg in one direction of the rod.

    near : node of the grid below the last speed, where the search begins; the new one is returned

    mean, end : speed of the rod [m/s], over the leg of dt [s] and as it ends;  x : deflection then
    Y : magnitude of the yield force then;  k_c, k_r : gas stiffness
    """
    m = len(grid)
    e += mean * dt
    ahead = min(max(end / mean, SLOWEST), 2.0) if mean * end > 0.0 else 1.0
    for branch in range(2):
        k = k_c if branch == 0 else k_r
        way = 1.0 if branch == 0 else -1.0
        # H(v) = gas + viscous + yield + friction - F at a stretch of e - v span; increasing in v.
        span = dt / (ahead if mean * way > 0.0 else 1.0)
        rest = k * (x - e) - _held(e, half, s)
        if (rest + Y * sign[branch, 0] + friction[branch, 0]) * way >= 0.0:
            continue
        low, high = 0, m - 1
        a = b = np.nan  # H at these two, where the search has come by
        mid, reach = min(max(near, 1), m - 2), 1
        while high - low > 1:
            h = _excess(
                e - way * grid[mid] * span, x, k, half, s, viscous[branch, mid] * g_visc,
                Y * sign[branch, mid], friction[branch, mid],
            )  # fmt: skip
            if h * way < 0.0:
                low, a = mid, h
            else:
                high, b = mid, h
            # Speeds change little from sample to sample: outwards from the last in growing steps,
            # and by halves once there is a bracket.
            if low > 0 and high < m - 1:
                mid = (low + high) // 2
            elif high == m - 1:
                mid = min(low + reach, m - 2) if low + reach < high else (low + high) // 2
                reach *= 4
            else:
                mid = max(high - reach, 1) if high - reach > low else (low + high) // 2
                reach *= 4
        if low == 0:
            a = _excess(
                e - way * grid[low] * span, x, k, half, s, viscous[branch, low] * g_visc,
                Y * sign[branch, low], friction[branch, low],
            )  # fmt: skip
        if high == m - 1:
            b = _excess(
                e - way * grid[high] * span, x, k, half, s, viscous[branch, high] * g_visc,
                Y * sign[branch, high], friction[branch, high],
            )  # fmt: skip
        slow, fast = grid[low], grid[high]
        if half > 0.0 and span > 0.0:
            # The spring bends where it loses or takes up its play, and is far stiffer than the
            # damper beyond: H is straight on either side, not across.
            for side in range(2):
                edge = half if side == 0 else -half
                u = way * (e - edge) / span
                if slow < u < fast:
                    w = (u - grid[low]) / (grid[high] - grid[low])
                    h = _excess(
                        edge, x, k, half, s,
                        (viscous[branch, low] * (1.0 - w) + viscous[branch, high] * w) * g_visc,
                        Y * (sign[branch, low] * (1.0 - w) + sign[branch, high] * w),
                        friction[branch, low] * (1.0 - w) + friction[branch, high] * w,
                    )  # fmt: skip
                    if h * way < 0.0:
                        slow, a = u, h
                    else:
                        fast, b = u, h
        part = -a / (b - a) if b != a else 0.0
        v = way * (slow + part * (fast - slow))
        return e - v * span, v, low
    return e, 0.0, 1


@njit(cache=True)
def march(
    x: Array, xdot: Array, step: Array, rises: Array, falls: Array, starts: Index,
    compressing: npt.NDArray[np.bool_], rests: npt.NDArray[np.bool_],
    u_c: Array, u_r: Array, g_gas: Array, g_visc: Array, g_yield: Array,
    grid: Array, viscous: Array, sign: Array, friction: Array,
    k_c: float, k_r: float, T_c: float, T_r: float, s: float, gap: float,
) -> tuple[Array, Array, Array]:  # fmt: skip
    """Force of the spring (n,) [N], its stretch (n,) [m] and the speed behind it (n,) [m/s].

    u_c, u_r : (n,) steady yield force in either direction;  g_ : (n,) factors of the groups
    viscous, sign, friction : (2, m) laws on `grid`, for compression and release
    k_c, k_r : gas stiffness behind the spring;  s : compliance [m/N] > 0;  gap : free play [m]
    rests : (r,) records that begin at rest, in the middle of the play

    A step in which the rod turns is made of two legs, before and after: by the mean speed of the
    whole of it the piston would turn up to a step late, however stiff the spring.
    """
    n, m, half = len(x), len(grid), 0.5 * gap
    last, fade = -1.0, 1.0  # the exponential of the last step: most are alike
    force, stretch, speed = np.empty(n), np.empty(n), np.empty(n)
    for r in range(len(starts) - 1):
        first = starts[r]
        up = compressing[first]
        y = u_c[first] if up else u_r[first]
        # No step lies before it: the record begins with the spring's force steady.
        way = 0 if up else 1
        j = min(max(np.searchsorted(grid, abs(xdot[first])), 1), m - 1)
        w = min(max((abs(xdot[first]) - grid[j - 1]) / (grid[j] - grid[j - 1]), 0.0), 1.0)
        law = viscous[way] * g_visc[first] + y * g_yield[first] * sign[way] + friction[way]
        still = xdot[first] == 0.0 or (rests[r] and gap > 0.0)
        moving = 0.0 if still else law[j - 1] * (1.0 - w) + law[j] * w
        k = (k_c if up else k_r) * g_gas[first]
        F = (k * x[first] + moving) / (1.0 + k * s)
        near = j - 1
        e = s * F + (0.0 if still else half if F > 0.0 else -half)
        force[first], stretch[first], speed[first] = F, e, xdot[first]
        for i in range(first + 1, starts[r + 1]):
            a, b, dt = xdot[i - 1], xdot[i], step[i - 1]
            turning = a * b < 0.0
            v = 0.0
            for leg in range(2 if turning else 1):
                mean, end, span, x_end = 0.5 * (a + b), b, dt, x[i]
                if turning:
                    before = a / (a - b) * dt
                    if leg == 0:
                        mean, end, span = 0.5 * a, 0.0, before
                        x_end = x[i - 1] + mean * span
                    else:
                        mean, span = 0.5 * b, dt - before
                u = u_c[i - 1] if up else u_r[i - 1]
                T = (T_c if up else T_r) * (falls if abs(u) < abs(y) else rises)[i - 1]
                decay = span / T
                if decay != last:
                    last, fade = decay, np.exp(-decay)
                y = u + (y - u) * fade
                e, v, near = _moved(
                    e, mean, end, span, s, x_end, y * g_yield[i], k_c * g_gas[i], k_r * g_gas[i],
                    g_visc[i], half, near, grid, viscous, sign, friction,
                )  # fmt: skip
                if v != 0.0:
                    up = v > 0.0
            force[i], stretch[i], speed[i] = _held(e, half, s), e, v
    return force, stretch, speed


@njit(cache=True)
def along(v: Array, grid: Array, law: Array) -> Array:
    """(n,) value of a law (2, m) on a grid of speeds at the speeds v (n,); 0 at rest."""
    out = np.zeros(len(v))
    for i in range(len(v)):
        if v[i] == 0.0:
            continue
        branch, speed = (0 if v[i] > 0.0 else 1), abs(v[i])
        j = min(max(np.searchsorted(grid, speed), 1), len(grid) - 1)
        w = min(max((speed - grid[j - 1]) / (grid[j] - grid[j - 1]), 0.0), 1.0)
        out[i] = law[branch, j - 1] * (1.0 - w) + law[branch, j] * w
    return out
