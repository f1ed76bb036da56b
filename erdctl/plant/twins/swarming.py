"""Particles swarm in a slow flow under a field: viscous times 1 + s (U/U_top) exp(-|v|/w)."""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _viscous(grid: FineGrid, p: Values) -> Array:
    slow = np.exp(-np.abs(grid.v) / p["speed"])
    return np.asarray(1.0 + p["growth"] * grid.U / p["top"] * slow)


HOOKS = Hooks("swarming", viscous=_viscous)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, growth=s, top=by.duty, speed=q["speed"] * by.v)


TWIN = Twin(
    name="swarming",
    family="viscous law",
    part="viscous",
    low=1e-3,
    start=1.0,
    high=50.0,
    build=_build,
    # A force that goes with speed, duty and direction, whichever it is a factor of.
    lies=Lies(
        "viscous",
        ("abs_xdot", "duty"),
        "s (y/U) exp(-z/w)",
        alike=(("friction", ("abs_xdot", "duty")), ("yield", ("abs_xdot", "duty"))),
    ),
    shows={"own.growth": "1", "own.top": "1", "own.speed": "m/s"},
    shape={"speed": (0.2, 0.6)},
    rigid=True,
)
