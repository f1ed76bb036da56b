"""A seal that bends before it slides.

Dahl's friction: s times the damper's force, after bending by a part of the stroke.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(F_p=s * by.force, x_p=q["x_p"] * by.x)


TWIN = Twin(
    name="presliding_friction",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    shows={"physics.F_p": "N", "physics.x_p": "m"},
    shape={"x_p": (0.03, 0.25)},
)
