"""A soft mount in series with the whole damper.

Deflects by s times the stroke under the largest force.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(mount=s * by.x / by.force)


def _law(plant: Plant) -> Law:
    return plant, {"s_m": plant.physics.mount}


TWIN = Twin(
    name="mount_compliance",
    family="series",
    low=1e-8,
    start=0.005,
    high=0.5,
    build=_build,
    law=_law,
    shows={"physics.mount": "m/N"},
    soft=True,
    equivalents=("fluid_compressibility",),
)
