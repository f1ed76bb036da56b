"""Chains grow thicker while the field stands: yield times 1 + s (1 - exp(-t/tau)).

t is the time since the duty last changed; as a record begins it has stood for long.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


@njit(cache=True)
def _stood(U: Array, h: float, start: int) -> Array:
    """(m,) time since U last changed [s]."""
    out = np.full(len(U), np.inf)
    for k in range(start + 2, len(U)):
        out[k] = h if U[k] != U[k - 1] else out[k - 1] + h
    return out


def _yielding(grid: FineGrid, p: Values) -> Array:
    stood = _stood(grid.U, grid.h, grid.start)
    return np.asarray(1.0 + p["growth"] * -np.expm1(-stood / p["time"]))


HOOKS = Hooks("chain_ageing", yielding=_yielding)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, growth=s, time=q["time"] * by.shortest)


TWIN = Twin(
    name="chain_ageing",
    family="field in time",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=10.0,
    build=_build,
    lies=Lies("yield", ("since_duty_step",), "s (1 - exp(-z/tau))"),
    shows={"own.growth": "1", "own.time": "s"},
    shape={"time": (0.05, 0.3)},
    rigid=True,
)
