"""A seal that bends before it slides.

Dahl's friction: s times the damper's force, after bending by a part of the stroke.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(F_p=s * by.force, x_p=q["x_p"] * by.x)


def _law(plant: Plant) -> Law:
    return plant, {"F_c": plant.physics.F_p, "x_d": plant.physics.x_p}


TWIN = Twin(
    name="presliding_friction",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"physics.F_p": "N", "physics.x_p": "m"},
    shape={"x_p": (0.03, 0.25)},
)
