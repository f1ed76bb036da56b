"""Chains stretch before they break: springs with sliders beside each other (Iwan).

    sign(xdot) -> mean of q_j,   dq_j = dx / d_j, kept within -1..1,   d_j = x_y (2 j - 1) / N

Chains of N lengths carry equal parts of the yield force; each breaks at its own stretch d_j, and
their mean is x_y = s times the stroke. Modulus and yield stress both follow the field, so that a
stretch d_j is the same at all fields.
Check: N = 1, x_y = 1 mm, a turn at q = 1 and 0.5 mm back gives 0.5.
>>> x, v = np.array([0.0, 0.0, -0.0005]), np.array([1.0, 0.0, -1.0])
>>> float(_stretched(x, v, 1.0, np.array([0.001]))[2])
0.5

Source: W. D. Iwan, A distributed-element model for hysteresis and its steady-state dynamic
response, J. Applied Mechanics 33 (1966) 893-900.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin

LENGTHS = 10


@njit(cache=True)
def _stretched(x: Array, v: Array, h: float, breaks: Array) -> Array:
    """(m,) mean of the chains' parts; what moves at the start has broken them all."""
    q, out = np.full(len(breaks), np.sign(v[0])), np.empty(len(x))
    out[0] = np.mean(q)
    for k in range(1, len(x)):
        there, back = x[k] - x[k - 1], 0.0
        if v[k - 1] * v[k] < 0.0:  # a turn inside the step: as far as it went, and back from there
            far = 0.5 * h * v[k - 1] ** 2 / (v[k - 1] - v[k])
            there, back = far, there - far
        for j in range(len(breaks)):
            q[j] = min(max(q[j] + there / breaks[j], -1.0), 1.0)
            q[j] = min(max(q[j] + back / breaks[j], -1.0), 1.0)
        out[k] = np.mean(q)
    return out


def _sign(grid: FineGrid, p: Values) -> Array:
    breaks = p["x_y"] * (2.0 * np.arange(1, LENGTHS + 1) - 1.0) / LENGTHS
    return np.asarray(_stretched(grid.x, grid.v, grid.h, breaks))


HOOKS = Hooks("preyield_elasticity", sign=_sign)


@njit(cache=True)
def _rebuilt(Y: Array, x: Array, v: Array, h: float, start: int, x_d: float) -> Array:
    """(m,) x_d dy/d|x| + y = Y, steady as a record begins."""
    out = Y.copy()
    for k in range(start + 1, len(Y)):
        there, back, goal = x[k] - x[k - 1], 0.0, 0.5 * (Y[k - 1] + Y[k])
        if v[k - 1] * v[k] < 0.0:
            far = 0.5 * h * v[k - 1] ** 2 / (v[k - 1] - v[k])
            there, back, goal = far, there - far, Y[k - 1]
        at = goal + (out[k - 1] - goal) * np.exp(-abs(there) / x_d)
        out[k] = at if back == 0.0 else Y[k] + (at - Y[k]) * np.exp(-abs(back) / x_d)
    return out


def _as_one(grid: FineGrid, p: Values) -> Array:
    """What is usually fitted: chains of one length, exponentially (Bouc-Wen)."""
    way = np.sign(grid.v)
    return np.asarray(_rebuilt(way, grid.x, grid.v, grid.h, grid.start, p["x_d"]))


USUAL = Hooks("preyield_elasticity", sign=_as_one)


def _law(plant: Plant) -> Law:
    x_d = 0.5 * plant.own_values("preyield_elasticity")["x_y"]
    return plant.with_own(USUAL, x_d=x_d), {"x_d": x_d}


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, x_y=s * by.x)


TWIN = Twin(
    name="preyield_elasticity",
    family="sign law",
    part="yielding",
    low=1e-9,
    start=0.03,
    high=1.0,
    build=_build,
    law=_law,
    shows={"own.x_y": "m"},
    rigid=True,
)
