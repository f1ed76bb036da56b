"""Compiled recurrences of nonlinear effects, where no library has the loop.

Importing a compiler costs 0.3 s, so effects import this inside their functions.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from erdctl.core.recording import Array, Index

# Part of a step over which contact sets in: none at all would leave a search for the play without
# a slope; a whole step costs 1 % of the range of the force in the samples next to contact.
BLUR = 0.2


@njit(cache=True, nogil=True)
def play(
    xdot: Array,
    step: Array,
    starts: Index,
    compressing: npt.NDArray[np.bool_],
    rests: npt.NDArray[np.bool_],
    gap: float,
    blur: float = BLUR,
) -> tuple[Array, Array]:
    """Play operator along a velocity that is a straight line between samples.

        q = rod - piston, held within -gap/2..gap/2:  dq/dt = xdot inside, 0 on the flank

    xdot, step : (n,) [m/s], [s];  starts : (r + 1,);  gap : [m] > 0
    compressing : (n,) direction of motion; a record begins on the flank of its first, or, where
    rests : (r,) says that it begins at rest, in the middle of the play
    blur : part of a step over which contact sets in [1]
    Returns q (n,) [m], and the engaged part of each sample (n,) [1]: 1 on a flank that the motion
    presses on, 0 off it, and from 0 to 1 as contact falls between a tenth of a step after the
    sample, at the speed that the rod has there, and a tenth before; less far before and after where
    the play has lasted for less. So a sample needs nothing that comes after it.
    Check: gap 2.2 m, steps of 1 s, xdot = 1, 1, -1, -1, -1, -1 m/s. The rod turns at 1.5 s,
    is 0.25 m back at 2 s, 1.25 m at 3 s and meets the other flank at 3.95 s: q = 1.1, 1.1, 0.85,
    -0.15, -1.1, -1.1, engaged 1, 1, 0, 0, 0.75, 1.
    >>> s = signals([1.0, 1.0, -1.0, -1.0, -1.0, -1.0], step=1.0)
    >>> found = play(s.xdot, s.step, s.starts, s.compressing, s.rests, 2.2)
    >>> [a.round(9).tolist() for a in found]
    [[1.1, 1.1, 0.85, -0.15, -1.1, -1.1], [1.0, 1.0, 0.0, 0.0, 0.75, 1.0]]
    """
    n = len(xdot)
    lost, engaged = np.empty(n), np.empty(n)
    half = 0.5 * gap
    for r in range(len(starts) - 1):
        first, end = starts[r], starts[r + 1]
        if first == end:
            continue
        q = 0.0 if rests[r] else half if compressing[first] else -half
        lost[first], engaged[first] = q, 0.0 if rests[r] else 1.0
        free = 0.0  # time since the joint left a flank
        for i in range(first, end - 1):
            v0, v1, h = xdot[i], xdot[i + 1], step[i]
            turning = v0 * v1 < 0.0
            before = v0 / (v0 - v1) * h if turning else h
            # Time into the step at which a flank is met, and the time to blur it over.
            contact, edge = -1.0, blur * h
            for leg in range(2 if turning else 1):
                a = v0 if leg == 0 else 0.0
                b = 0.0 if turning and leg == 0 else v1
                span = before if leg == 0 else h - before
                travel = 0.5 * (a + b) * span
                if travel == 0.0:
                    continue
                flank = half if travel > 0.0 else -half
                room = abs(flank - q)
                if room == gap:
                    free = 0.0
                if abs(travel) < room:
                    q += travel
                    free += span
                    continue
                if room > 0.0:
                    u, rate = abs(a), (abs(b) - abs(a)) / span
                    met = 2.0 * room / (u + np.sqrt(max(u * u + 2.0 * rate * room, 0.0)))
                    met = min(met, span)
                    contact = (before if leg == 1 else 0.0) + met
                    edge = max(min(blur * h, 2.0 * (free + met)), 1e-12)
                q = flank
            lost[i + 1] = q
            pressing = (v1 > 0.0 and q == half) or (v1 < 0.0 and q == -half)
            engaged[i + 1] = 1.0 if pressing else 0.0
            if pressing and contact >= 0.0:
                engaged[i + 1] = min(1.0, 0.5 + (h - contact) / edge)
            elif not pressing and v1 != 0.0:
                ahead = abs((half if v1 > 0.0 else -half) - q) / abs(v1)
                edge = max(min(blur * h, 2.0 * (free + ahead)), 1e-12)
                engaged[i + 1] = max(0.0, 0.5 - ahead / edge)
    return lost, engaged


@njit(cache=True, nogil=True)
def rate_limited(target: Array, step: Array, starts: Index, rate: float) -> Array:
    """Mean over each step of what follows a held target no faster than `rate`.

        dy/dt = rate sign(target - y), 0 once there;  y = target at the first sample of a record

    target : (n,) held from its sample to the next;  step : (n,) [s];  starts : (r + 1,)
    rate : [unit of target / s] > 0.  Returns (n,): (1 / step) times the integral of y over it.
    Check: target 0, 1, 1, 1, steps of 1 s, rate 0.4 / s: y begins the last
    three steps at 0, 0.4, 0.8 and is 1 half-way through the last: means 0, 0.2, 0.6 and
    (0.9 + 1) / 2 = 0.95.
    >>> target = np.array([0.0, 1.0, 1.0, 1.0])
    >>> rate_limited(target, np.ones(4), np.array([0, 4]), 0.4).round(9).tolist()
    [0.0, 0.2, 0.6, 0.95]
    """
    out = np.empty(len(target))
    for r in range(len(starts) - 1):
        if starts[r] == starts[r + 1]:
            continue
        y = target[starts[r]]
        for i in range(starts[r], starts[r + 1]):
            off, reach = target[i] - y, rate * step[i]
            if abs(off) <= reach:
                ramp = abs(off) / reach if reach > 0.0 else 0.0
                out[i] = target[i] - 0.5 * off * ramp
                y = target[i]
            else:
                move = reach if off > 0.0 else -reach
                out[i] = y + 0.5 * move
                y += move
    return out


@njit(cache=True, nogil=True)
def fading(
    viscous: Array, yielding: Array, xdot: Array, step: Array, starts: Index,
    a_v: float, a_y: float, tau: float,
) -> tuple[Array, Array]:  # fmt: skip
    """Factors of the viscous and the yield force as their own power heats the fluid.

        dh/dt = P - h / tau,  P = (f_v viscous + f_y yield) xdot,  f_v = exp(-a_v h),  f_y likewise
        h >= 0, and 0 at the first sample of a record

    viscous, yielding : (n,) forces of the cold fluid [N];  xdot, step : (n,) [m/s], [s]
    a_v, a_y : [1/J] >= 0;  tau : [s] > 0.  Returns f_v and f_y, (n,) each. Power is held over a
    step, the decay of h is exact.
    Check: viscous 10 N, no yield force, 1 m/s, a step of 0.1 s, a_v = ln 2 / J, tau very long:
    h = 1 J after one step, f_v = 0.5; 1.5 J after two, f_v = 2^-1.5 = 0.3536.
    >>> s, force, none = signals(np.ones(3), step=0.1), np.full(3, 10.0), np.zeros(3)
    >>> f_v, f_y = fading(force, none, s.xdot, s.step, s.starts, np.log(2.0), 0.0, 1e9)
    >>> f_v.round(4).tolist(), f_y.tolist()
    ([1.0, 0.5, 0.3536], [1.0, 1.0, 1.0])
    """
    n = len(xdot)
    f_v, f_y = np.empty(n), np.empty(n)
    for r in range(len(starts) - 1):
        h = 0.0
        for i in range(starts[r], starts[r + 1]):
            f_v[i], f_y[i] = np.exp(-a_v * h), np.exp(-a_y * h)
            power = (f_v[i] * viscous[i] + f_y[i] * yielding[i]) * xdot[i]
            gone = -np.expm1(-step[i] / tau)
            h = max(h * (1.0 - gone) + power * tau * gone, 0.0)
    return f_v, f_y


@njit(cache=True, nogil=True)
def forming(
    u_c: Array, u_r: Array, compressing: npt.NDArray[np.bool_], before: Array, step: Array,
    starts: Index, T_c: float, T_r: float, rises: Array, falls: Array,
) -> Array:  # fmt: skip
    """Eq. 12 with other time constants while the state rises and while it falls.

        T dF/dt + F = u,   T = rises T_d while |u| >= |F|, falls T_d while |u| < |F|

    u_c, u_r : (n,) steady value in either direction [N];  T_c, T_r : T_d [s] > 0
    compressing : (n,) direction;  before : (n,) part of a step that passes before the turn in it
    step, rises, falls : (n,) [s], [1], [1];  starts : (r + 1,)
    Returns (n,) [N], steady as a record begins.
    Check: u = 1 then 0 N, T_d = 10 ms, falls = 2: exp(-1) = 0.3679 N after 20 ms.
    >>> u, step, falls = np.array([1.0, 0.0, 0.0]), np.full(3, 0.02), np.full(3, 2.0)
    >>> up, none, starts = np.ones(3, dtype=bool), np.zeros(3), np.array([0, 3])
    >>> forming(u, u, up, none, step, starts, 0.01, 0.01, np.ones(3), falls).round(4).tolist()
    [1.0, 1.0, 0.3679]
    """
    out = np.empty(len(u_c))
    # Steps are mostly alike, and an exponential costs more than all the rest.
    exponents, fades = np.full(4, -1.0), np.ones(4)
    for r in range(len(starts) - 1):
        if starts[r] == starts[r + 1]:
            continue
        up = compressing[starts[r]]
        y = u_c[starts[r]] if up else u_r[starts[r]]
        for i in range(starts[r], starts[r + 1]):
            out[i] = y
            if i + 1 == starts[r + 1]:
                break
            turning = compressing[i + 1] != compressing[i]
            for leg in range(2 if turning else 1):
                up = compressing[i] if leg == 0 else compressing[i + 1]
                span = step[i]
                if turning:
                    span *= before[i] if leg == 0 else 1.0 - before[i]
                u = u_c[i] if up else u_r[i]
                T = T_c if up else T_r
                kind = 0 if up else 1
                if abs(u) < abs(y):
                    T *= falls[i]
                    kind += 2
                else:
                    T *= rises[i]
                e = span / T
                if e != exponents[kind]:
                    exponents[kind], fades[kind] = e, np.exp(-e)
                y = u + (y - u) * fades[kind]
    return out
