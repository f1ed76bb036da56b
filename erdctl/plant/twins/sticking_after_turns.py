"""A lip seal rolls over after each turn: friction that dies away, B exp(-t/tau) sign(xdot).

t is the time since the motion turned; none before the first turn of a record.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


@njit(cache=True)
def _since(v: Array, h: float, start: int) -> Array:
    """(m,) time since v last changed its sign [s]."""
    out = np.full(len(v), np.inf)
    way = 0.0
    for k in range(start, len(v)):
        now = np.sign(v[k])
        turned = now != 0.0 and way != 0.0 and now != way
        if turned:
            out[k] = h * abs(v[k]) / (abs(v[k]) + abs(v[k - 1]))
        elif k > start:
            out[k] = out[k - 1] + h
        if now != 0.0:
            way = now
    return out


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    fade = np.exp(-_since(grid.v, grid.h, grid.start) / p["time"])
    return np.asarray(F + p["force"] * fade * np.sign(grid.v))


HOOKS = Hooks("sticking_after_turns", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, force=s * by.force, time=q["time"] * by.x / by.v)


TWIN = Twin(
    name="sticking_after_turns",
    family="seal",
    low=1e-4,
    start=0.2,
    high=10.0,
    build=_build,
    lies=Lies("friction", ("since_reversal",), "B exp(-z/tau)"),
    shows={"own.force": "N", "own.time": "s"},
    shape={"time": (0.2, 1.0)},
    rigid=True,
)
