"""The linkage gives the damper another stroke: x + s X sin(pi x/(2 X)) as gas and fluid see it."""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    angle = 0.5 * np.pi * grid.x / p["span"]
    more = p["bend"] * p["span"] * np.sin(angle)
    faster = p["bend"] * 0.5 * np.pi * np.cos(angle) * grid.v
    up = grid.v > 0.0
    k, c = np.where(up, p["k_c"], p["k_r"]), np.where(up, p["c_c"], p["c_r"])
    return np.asarray(F + k * more + c * faster)


HOOKS = Hooks("bent_linkage", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    up, down = plant.compression, plant.release
    return plant.with_own(
        HOOKS, bend=s, span=q["span"] * by.x, k_c=up.k_nom, k_r=down.k_nom, c_c=up.c_vis,
        c_r=down.c_vis,
    )  # fmt: skip


TWIN = Twin(
    name="bent_linkage",
    family="linkage",
    low=1e-3,
    start=0.3,
    high=3.0,
    build=_build,
    lies=Lies("deflection", ("x",), "s X sin(pi z/(2 X))"),
    shows={
        "own.bend": "1",
        "own.span": "m",
        "own.k_c": "N/m",
        "own.k_r": "N/m",
        "own.c_c": "N s/m",
        "own.c_r": "N s/m",
    },
    shape={"span": (0.4, 0.7)},
    rigid=True,
)
