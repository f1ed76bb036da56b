"""Dry friction of the seal.

F_c = s times the damper's force.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(F_c=s * by.force)


def _law(plant: Plant) -> Law:
    return plant, {"F_c": plant.physics.F_c}


TWIN = Twin(
    name="coulomb_friction",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"physics.F_c": "N"},
)
