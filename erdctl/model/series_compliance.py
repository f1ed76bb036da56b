"""A spring in series with the damper, or with its fluid: the force feeds back on the motion.

    de/dt = xdot - v,   F = e / s beyond -g/2..g/2, 0 within, + c de/dt,   x_p = x - e
    F = gas(x_p) + viscous(v) + F_ER sign(v) + friction(v) + m dv/dt + what the rod's motion makes

e is the spring's stretch, c what damps it and g free play in its joint, in which the spring bears
no force: after a reversal it unloads, the play is crossed, and it loads again.

Implicit in v: each sample solves one equation that is monotone in v, with a stick branch (v = 0,
the spring alone moves) where the yield force holds. The rod's travel in a step is the mean of its
speeds. The piston's is to its last speed v as that of a piston would be which is accelerated as the
rod, where the spring is stiff to the step, and as it was in the last step, where it is soft:

    dv = w dv_rod + (1 - w) dv_last,   w = (dt + c s) / (dt + (c + c_v) s)

with c_v the slope of the viscous law. So an error of second order in the step remains in stick,
behind a stiff spring, and behind a soft one, whose piston still moves as the rod turns. It is
stable for every compliance s > 0 and goes over into the model without a spring as s goes to 0.
A mass m takes its acceleration of the rod from the log, and that of the spring's stretch from the
step: what the two ring at must be slow to the samples, as the step damps what is not.
It is simulated free-running: correcting with the measured force would feed its noise back.

Source: return mapping of elasto-viscoplasticity, Simo and Hughes, Computational Inelasticity
(1998), Ch. 1; series compliance of dampers: Maxwell element.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit
from numba.core.cpu import CPUTargetOptions

from erdctl.core.recording import Array, Index
from erdctl.model.at_speed import Leg, Other, SpeedLaws, followed, slid, value

F = TypeVar("F", bound=Callable[..., object])
BEGUN = 0.16  # s that a record's first force has acted before: as in a motion of 1 Hz
LONGEST = 4.0  # of the mean speed in a step over the last one
GONE = 746.0  # times T_d, from which on nothing is left: to compute that 0 costs a fifth of a step
NEARLY = 1e-12  # of the spring's force, by which a piston must be driven to move: above rounding


def _borrowing(function: F) -> F:
    """A compiled function that makes no array and keeps none.

    To count who holds the arrays of its arguments, at every use of one, is half of its time: 0.39
    to 0.22 us a sample with a loop of the fluid. A numba that has no such option counts.
    """
    uncounted: Any = {"_nrt": False} if hasattr(CPUTargetOptions, "_nrt") else {}
    return cast(F, njit(cache=True, **uncounted)(function))


@njit(cache=True, inline="always")
def _held(e: float, half: float, s: float) -> float:
    """Force of the spring at a stretch e, with a free play of 2 half."""
    return (max(e - half, 0.0) + min(e + half, 0.0)) / s


@njit(cache=True, inline="always")
def _excess(
    u: float,
    j: int,
    w: float,
    branch: int,
    span: float,
    e: float,
    i: Leg,
    d: SpeedLaws,
    o: Other | None,
) -> float:
    """Force of the damper beyond that of the spring, at a speed u, a part w of the way from node j
    to the next; e is the stretch that the rod alone would leave."""
    way, k = (1.0, i.k_c) if branch == 0 else (-1.0, i.k_r)
    at = e - way * u * span
    viscous, plastic, friction = d.viscous[branch, j], d.sign[branch, j], d.friction[branch, j]
    if w != 0.0:
        viscous += (d.viscous[branch, j + 1] - viscous) * w
        friction += (d.friction[branch, j + 1] - friction) * w
        plastic += (d.sign[branch, j + 1] - plastic) * w
    plastic *= i.Y
    if o is not None:
        friction += o.F_c * slid(way, u * span, i, o)
        if o.yields:
            plastic = followed(way * u, way, u * span, at, i, d, o)[0]
            here, there = d.factor[branch, j], d.factor[branch, min(j + 1, len(d.grid) - 1)]
            plastic *= here + (there - here) * w
    rest = k * (i.x - at) + i.beside - _held(at, i.half, i.s)
    rest += i.pull * way * u - i.push
    return float(rest + viscous * i.viscous + plastic * i.yields + friction)


@njit(cache=True, inline="always")
def _starting(branch: int, e: float, i: Leg, d: SpeedLaws, o: Other | None) -> float:
    """`_excess` of a piston that is about to move."""
    k, way = (i.k_c, 1.0) if branch == 0 else (i.k_r, -1.0)
    rest = k * (i.x - e) + i.beside - _held(e, i.half, i.s) - i.push
    plastic = i.Y * d.sign[branch, 0]
    if o is not None:
        rest += o.F_c * i.z
        if o.yields:
            plastic = followed(0.0, way, 0.0, e, i, d, o)[0] * d.factor[branch, 0]
    return float(rest + plastic * i.yields + d.friction[branch, 0])


@njit(cache=True, inline="always")
def _mean(first: float, last: float) -> float:
    """Mean speed over the last one of a piston that goes from one to another, as far as they lie in
    the direction of a branch; without a jump but at rest, as rounding must not move the force."""
    if first > 0.0:
        if last > 0.0:
            return min(0.5 * (first + last) / last, LONGEST)
        return max(LONGEST + (LONGEST - 1.0) * last / first, 1.0)
    if last > 0.0:
        return max(1.0 + 0.5 * last / first, 0.5) if first < 0.0 else 0.5
    return 1.0


@_borrowing
def _speed(
    branch: int, span: float, e: float, near: int, i: Leg, d: SpeedLaws, o: Other | None
) -> tuple[float, int]:
    """Last speed of a piston that moves on a branch, and the node of the grid below it.

    H(v) = gas + viscous + yield + friction - F at a stretch of e - v span is increasing in v.
    """
    m, way = len(d.grid), 1.0 if branch == 0 else -1.0
    low, high = 0, m - 1
    a = b = np.nan  # H at these two, where the search has come by
    mid, reach = min(max(near, 1), m - 2), 1
    while high - low > 1:
        h = _excess(d.grid[mid], mid, 0.0, branch, span, e, i, d, o)
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
        a = _excess(d.grid[low], low, 0.0, branch, span, e, i, d, o)
    if high == m - 1:
        b = _excess(d.grid[high], high, 0.0, branch, span, e, i, d, o)
    slow, fast = d.grid[low], d.grid[high]
    if low == 0 and a * way >= 0.0:  # below the first node, where the spring may bend as well
        fast, b, slow = slow, a, 0.0
        a = _excess(0.0, 0, -d.grid[0] / (d.grid[1] - d.grid[0]), branch, span, e, i, d, o)
    if i.half > 0.0 and span > 0.0:
        # The spring bends where it loses or takes up its play, and is far stiffer than the
        # damper beyond: H is straight on either side, not across.
        for side in range(2):
            u = way * (e - (i.half if side == 0 else -i.half)) / span
            if slow < u < fast:
                w = (u - d.grid[low]) / (d.grid[high] - d.grid[low])
                h = _excess(u, low, w, branch, span, e, i, d, o)
                if h * way < 0.0:
                    slow, a = u, h
                else:
                    fast, b = u, h
    part = -a / (b - a) if b != a else 0.0
    return slow + part * (fast - slow), low


@_borrowing
def _moved(
    e: float, mean: float, near: int, i: Leg, d: SpeedLaws, o: Other | None
) -> tuple[float, float, int, float, float, float, float]:
    """As a leg ends: stretch, speed behind the spring, node, signed yield force, smooth part of its
    sign law, hysteretic variable, part of the friction that follows.

    mean : speed of the rod over the leg [m/s];  near : node below the last speed, to search from
    """
    m = len(d.grid)
    e += mean * i.dt
    j, there = min(max(near, 0), m - 2), 0 if i.v > 0.0 else 1
    c = abs(d.viscous[there, j + 1] - d.viscous[there, j]) / (d.grid[j + 1] - d.grid[j])
    stiff = i.dt + i.c * i.s
    w = stiff / max(stiff + c * i.viscous * i.s, 1e-12)
    last = i.kept + (i.level - i.kept) * w
    fastest = max(abs(i.v), abs(i.end), abs(2.0 * mean - i.end), 1e-12)
    # What rounding alone would move rests: it turned round and round, and with it the yield force
    # that the lag goes to, and a gas stiffer in one direction gave a jump of the force.
    to_go, nearly = 0.0, NEARLY * abs(_held(e, i.half, i.s) + i.c * i.end)
    for branch in range(2):
        way = 1.0 if branch == 0 else -1.0
        part = _mean(i.v * way, last * way)
        span = i.dt * part
        start = _starting(branch, e, i, d, o)
        to_go = start if branch == 0 else to_go
        if start * way >= -nearly or (branch == 1 and to_go <= nearly):
            continue
        u, node = _speed(branch, span, e, near, i, d, o)
        least = mean * way / fastest
        if u > fastest and part < least:  # no spring makes the piston outrun the rod
            slower, _ = _speed(branch, i.dt * least, e, near, i, d, o)
            share = (u - fastest) / (u - slower) if slower < fastest else 1.0
            span = i.dt * (part + (least - part) * share)
            u, node = _speed(branch, span, e, near, i, d, o)
        at = e - way * u * span
        if o is None:
            return at, way * u, node, 0.0, 0.0, 0.0, 0.0
        force, smooth, h = followed(way * u, way, u * span, at, i, d, o)
        return at, way * u, node, force, smooth, h, slid(way, u * span, i, o)
    if o is None:
        return e, 0.0, 1, 0.0, 0.0, 0.0, 0.0
    # What sticks is held by as much of what it could take from either side as balances the rest.
    up, smooth, h = followed(0.0, 1.0, 0.0, e, i, d, o)
    down, _, _ = followed(0.0, -1.0, 0.0, e, i, d, o)
    apart = to_go - _starting(1, e, i, d, o)
    part = min(max(to_go / apart, 0.0), 1.0) if apart > 0.0 else 0.5
    return e, 0.0, 1, up + (down - up) * part, smooth, h, i.z


@njit(cache=True, nogil=True)
def march(
    x: Array, rod: Array, xdot: Array, step: Array, rises: Array, falls: Array, starts: Index,
    compressing: npt.NDArray[np.bool_], rests: npt.NDArray[np.bool_], beside: Array, slide: Array,
    unsteady: Array, u_c: Array, u_r: Array, by: Array, g_gas: Array, g_visc: Array,
    g_yield: Array, d: SpeedLaws, o: Other | None, k_c: float, k_r: float, T_c: float, T_r: float,
    s: float, gap: float, mass: float, c: float,
) -> tuple[Array, Array, Array, Array]:  # fmt: skip
    """Force of the spring (n,) [N], its stretch (n,) [m], the speed behind it (n,) [m/s], and (n,)
    what the piston's own motion adds to `beside` [N].

    x : (n,) in place of the deflection in the gas force;  rod, xdot : (n,) motion of the rod
    beside : (n,) forces of the damper that this makes [N];  slide : (n,) part of the friction that
        would follow its direction, of which a record begins with the first
    unsteady : (r,) how far the hysteretic variable is from its law as a record begins
    u_c, u_r : (n,) steady yield force in either direction;  by : (n,) see `SignSlot`
    g_ : (n,) factors of the groups;  k_c, k_r : gas stiffness behind the spring
    s : compliance [m/N] > 0;  gap : free play [m]
    mass : that goes with the piston [kg]; `beside` has it by the acceleration of the rod, and the
        difference of the two is that of their speeds, which noise of the rod's speed leaves alone
    c : damping of the spring [N s/m]
    rests : (r,) records that begin at rest, in the middle of the play

    A step in which the rod turns is made of two legs, before and after: by the mean speed of the
    whole of it the piston would turn up to a step late, however stiff the spring.
    """
    last, fade, half = -1.0, 1.0, 0.5 * gap  # the exponential of the last step: most are alike
    force, stretch, speed, own = np.empty((4, len(x)))
    rubs = 0.0 if o is None else o.F_c
    for r in range(len(starts) - 1):
        first = starts[r]
        up = compressing[first]
        way = 1.0 if up else -1.0
        y = u_c[first] if up else u_r[first]
        # No step lies before it: the record begins with the spring's force steady, as far as its
        # damping lets it be by then.
        v = xdot[first]
        still = v == 0.0 or (rests[r] and gap > 0.0)
        k = (k_c if up else k_r) * g_gas[first]
        z = slide[first]
        other = beside[first] + rubs * z
        sheared = v if o is None else (v + o.lead * rod[first]) / by[first]
        law = value(d.sign, d.grid, sheared, way)
        smooth = law - (1.0 if sheared > 0.0 else -1.0) * 0.5 * (d.sign[0, 0] - d.sign[1, 0])
        h = law + unsteady[r]
        was = y * h
        if still:  # what rubs holds what it can of them
            held = g_yield[first] * d.factor[:, 0] * d.sign[:, 0]
            most, least = u_c[first] * held[0], u_r[first] * held[1]
            most, least = most + d.friction[0, 0], least + d.friction[1, 0]
            other -= min(max(other, least), most)
        else:
            other += value(d.viscous, d.grid, v, way) * g_visc[first]
            other += was * g_yield[first] * value(d.factor, d.grid, v, way)
            other += value(d.friction, d.grid, v, way)
        was, smooth, h = (0.0, 0.0, 0.0) if still else (was, smooth, h)
        soft = s / (1.0 + c * s / BEGUN)
        F = (k * x[first] + other) / (1.0 + k * soft)
        near, rate = np.searchsorted(d.grid, abs(v)) - 1, 0.0
        e = soft * F + (0.0 if still else half if F > 0.0 else -half)
        force[first], stretch[first], speed[first], own[first] = F, e, v, rubs * z
        for i in range(first + 1, starts[r + 1]):
            v0, v1, dt = xdot[i - 1], xdot[i], step[i - 1]
            turning = v0 * v1 < 0.0
            before = v0 / (v0 - v1) if turning else 0.0
            was_v = v
            for leg in range(2 if turning else 1):
                mean, end, span = 0.5 * (v0 + v1), v1, dt
                other, x_end, rod_end, begun = beside[i], x[i], rod[i], v0
                if turning:
                    if leg == 0:
                        mean, end, span = 0.5 * v0, 0.0, before * dt
                        x_end, rod_end = x[i - 1] + mean * span, rod[i - 1] + mean * span
                        other = beside[i - 1] + (other - beside[i - 1]) * before
                    else:
                        mean, span, begun = 0.5 * v1, dt - before * dt, 0.0
                u = u_c[i - 1] if up else u_r[i - 1]
                T = (T_c if up else T_r) * (falls if abs(u) < abs(y) else rises)[i - 1]
                decay = span / T
                if decay != last:
                    last, fade = decay, np.exp(-decay) if decay < GONE else 0.0
                y_0, y = y, u + (y - u) * fade
                pull, level = mass / max(span, 1e-9), end + v - begun
                now = Leg(
                    span, x_end, rod_end, other, y, by[i], k_c * g_gas[i], k_r * g_gas[i],
                    g_visc[i], g_yield[i], half, s, was, y_0, smooth, h, z, c, end,
                    pull + c, pull * level + c * end, v, level, v + rate * span,
                )  # fmt: skip
                e, v, near, was, smooth, h, z = _moved(e, mean, near, now, d, o)
                up = v > 0.0 if abs(v) >= d.grid[0] else up  # rounding turns what comes to rest
                added = rubs * z + pull * (v - level)
            rate = (v - was_v) / max(dt, 1e-9)
            force[i] = _held(e, half, s) + c * (v1 - v)
            stretch[i], speed[i], own[i] = e, v, added
    return force, stretch, speed, own
