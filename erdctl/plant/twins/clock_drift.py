"""The force has a recorder of its own, whose clock gains or loses on that of the motion.

By s times 10 ms over the longest record, begun together with each record. Between nodes by a cubic
of four where the motion does not turn, and by the nearer node where it does.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    nodes = np.arange(len(F)) - (p["rate"] * grid.t + p["late"]) / grid.h
    nodes = np.clip(nodes, 1.0, len(F) - 3.0)
    i = np.floor(nodes).astype(int)
    d = nodes - i
    a, b, c, e = F[i - 1], F[i], F[i + 1], F[i + 2]
    cubic = b + 0.5 * d * (c - a + d * (2 * a - 5 * b + 4 * c - e + d * (3 * (b - c) + e - a)))
    way = np.signbit(grid.v)
    turns = (way[i - 1] != way[i]) | (way[i] != way[i + 1]) | (way[i + 1] != way[i + 2])
    return np.asarray(np.where(turns, np.where(d < 0.5, b, c), cubic))


HOOKS = Hooks("clock_drift", recorded=_recorded)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    rate = 0.01 * s / by.longest * (1.0 if q["late"] > 0.5 else -1.0)
    return plant.with_own(HOOKS, rate=rate, late=0.0)


def _law(plant: Plant) -> Law:
    return plant, {"tau": 0.0, "r": plant.own_values("clock_drift")["rate"]}


TWIN = Twin(
    name="clock_drift",
    family="time",
    low=1e-4,
    start=0.3,
    high=10.0,
    build=_build,
    law=_law,
    shows={"own.rate": "1", "own.late": "s"},
    shape={"late": (0.0, 1.0)},
)
