"""The zero of the force channel was set wrongly.

s times the damper's force, of either sign.
"""

from __future__ import annotations

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    return F + p["zero"]


HOOKS = Hooks("force_offset", recorded=_recorded)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, zero=s * by.force * (1.0 if q["up"] > 0.5 else -1.0))


def _law(plant: Plant) -> Law:
    return plant, {"F_z": plant.own_values("force_offset")["zero"]}


TWIN = Twin(
    name="force_offset",
    family="static",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"own.zero": "N"},
    shape={"up": (0.0, 1.0)},
    equivalents=("gas_preload",),
)
