"""The flow carries charge away: of the duty 1 - s |v|/V is left at the electrodes."""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _voltage(U: Array, grid: FineGrid, p: Values) -> Array:
    return np.asarray(U * np.maximum(1.0 - p["loss"] * np.abs(grid.v) / p["speed"], 0.0))


HOOKS = Hooks("flow_discharge", voltage=_voltage)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, loss=s, speed=by.v)


TWIN = Twin(
    name="flow_discharge",
    family="field and flow",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("duty", ("abs_xdot",), "-s z/V"),
    shows={"own.loss": "1", "own.speed": "m/s"},
)
