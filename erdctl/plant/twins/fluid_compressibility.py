"""The fluid column gives.

The column gives by s times the stroke under the largest force.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(fluid_spring=s * by.x / by.force)


def _law(plant: Plant) -> Law:
    return plant, {"s_f": plant.physics.fluid_spring}


TWIN = Twin(
    name="fluid_compressibility",
    family="series",
    low=1e-8,
    start=0.005,
    high=0.5,
    build=_build,
    law=_law,
    shows={"physics.fluid_spring": "m/N"},
    soft=True,
    equivalents=("mount_compliance",),
)
