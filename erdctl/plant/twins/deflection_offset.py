"""The gas spring is at rest where the deflection is not 0: k_i (x - zero), i by direction.

s times the stroke, of either sign.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    moving = np.flatnonzero(grid.v)
    if len(moving) == 0:
        return F - p["up"] * p["zero"]
    # At rest the spring is that of the way it came, and before the first motion that of the next.
    last = np.searchsorted(moving, np.arange(len(F)), side="right") - 1
    rate = np.where(grid.v[moving[np.maximum(last, 0)]] > 0.0, p["up"], p["down"])
    return np.asarray(F - rate * p["zero"])


HOOKS = Hooks("deflection_offset", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    zero = s * by.stroke * (1.0 if q["side"] > 0.5 else -1.0)
    up, down = plant.compression.k_nom, plant.release.k_nom
    return plant.with_own(HOOKS, zero=zero, up=up, down=down)


def _law(plant: Plant) -> Law:
    return plant, {"x_z": plant.own_values("deflection_offset")["zero"]}


TWIN = Twin(
    name="deflection_offset",
    family="static",
    also="gas",
    part="gas",
    low=1e-4,
    start=0.3,
    high=5.0,
    build=_build,
    law=_law,
    shows={"own.zero": "m", "own.up": "N/m", "own.down": "N/m"},
    shape={"side": (0.0, 1.0)},
    rigid=True,
)
