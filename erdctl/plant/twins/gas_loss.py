"""Gas escapes past the separator as the piston travels: gas force times 1 - s (1 - exp(-l/L))."""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    way = np.abs(grid.v) * grid.h
    way[: grid.start] = 0.0
    gone = p["loss"] * -np.expm1(-(np.cumsum(way) - way) / p["travel"])
    k = np.where(grid.v > 0.0, p["k_c"], p["k_r"])
    return np.asarray(F - gone * k * grid.x)


HOOKS = Hooks("gas_loss", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    k_c, k_r = plant.compression.k_nom, plant.release.k_nom
    return plant.with_own(HOOKS, loss=s, travel=q["travel"] * by.v * by.shortest, k_c=k_c, k_r=k_r)


TWIN = Twin(
    name="gas_loss",
    family="gas",
    part="gas",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("gas", ("travel",), "-s (1 - exp(-z/L))"),
    shows={"own.loss": "1", "own.travel": "m", "own.k_c": "N/m", "own.k_r": "N/m"},
    shape={"travel": (0.1, 0.6)},
    rigid=True,
)
