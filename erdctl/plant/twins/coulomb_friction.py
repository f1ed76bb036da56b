"""Dry friction of the seal.

F_c = s times the damper's force.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(F_c=s * by.force)


TWIN = Twin(
    name="coulomb_friction",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    shows={"physics.F_c": "N"},
)
