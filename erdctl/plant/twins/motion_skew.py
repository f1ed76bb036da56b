"""The motion is recorded late, or early: on its clock force and supply are early, or late, by s
times 0.1 s.

Whole steps of the simulation.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _voltage(U: Array, grid: FineGrid, p: Values) -> Array:
    shift = round(p["late"] / grid.h)
    nodes = np.clip(np.arange(len(U)) - shift, 0, len(U) - 1)
    return U[nodes]


HOOKS = Hooks("motion_skew", voltage=_voltage)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    late = round(0.1 * s / by.tick) * by.tick * (1.0 if q["early"] < 0.75 else -1.0)
    return plant.with_channel(skew=-late).with_own(HOOKS, late=late)


def _law(plant: Plant) -> Law:
    return plant, {"tau": plant.own_values("motion_skew")["late"]}


TWIN = Twin(
    name="motion_skew",
    family="time",
    also="field in time",
    low=1e-4,
    start=0.03,
    high=1.0,
    build=_build,
    law=_law,
    shows={"own.late": "s", "channel.skew": "s"},
    shape={"early": (0.0, 1.0)},
)
