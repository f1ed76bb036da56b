"""Turbulent loss.

s times the damper's force at the top speed.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(turbulent=s * by.force / by.v**2)


TWIN = Twin(
    name="quadratic_damping",
    family="viscous law",
    low=1e-4,
    start=0.3,
    high=20.0,
    build=_build,
    shows={"physics.turbulent": "N s2/m2"},
)
