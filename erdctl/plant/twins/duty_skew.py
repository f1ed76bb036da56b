"""The duty channel is recorded late: the supply follows what the log shows s times 0.1 s later.

Whole steps of the simulation.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _voltage(U: Array, grid: FineGrid, p: Values) -> Array:
    early = min(round(p["late"] / grid.h), len(U) - 1)
    return np.concatenate([U[early:], np.full(early, U[-1])])


HOOKS = Hooks("duty_skew", voltage=_voltage)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, late=round(0.1 * s / by.tick) * by.tick)


def _law(plant: Plant) -> Law:
    return plant, {"tau": plant.own_values("duty_skew")["late"]}


TWIN = Twin(
    name="duty_skew",
    family="field in time",
    part="yielding",
    low=1e-4,
    start=0.1,
    high=1.0,
    build=_build,
    law=_law,
    shows={"own.late": "s"},
)
