"""Electrodes stay charged after the highest duty: F + B (m/U) sign(xdot), m the highest so far."""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    U = grid.U.copy()
    U[: grid.start] = U[min(grid.start + 1, len(U) - 1)]
    return np.asarray(F + p["force"] * np.maximum.accumulate(U) / p["top"] * np.sign(grid.v))


HOOKS = Hooks("remanent_field", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, force=s * by.force, top=by.duty)


TWIN = Twin(
    name="remanent_field",
    family="memory of field",
    part="yielding",
    low=1e-4,
    start=0.1,
    high=5.0,
    build=_build,
    lies=Lies("friction", ("largest_duty",), "B z/U"),
    shows={"own.force": "N", "own.top": "1"},
    rigid=True,
)
