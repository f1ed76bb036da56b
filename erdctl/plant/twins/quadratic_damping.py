"""Turbulent loss.

s times the damper's force at the top speed.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(turbulent=s * by.force / by.v**2)


def _law(plant: Plant) -> Law:
    return plant, {"c_2": plant.physics.turbulent}


TWIN = Twin(
    name="quadratic_damping",
    family="viscous law",
    low=1e-4,
    start=0.3,
    high=20.0,
    build=_build,
    law=_law,
    shows={"physics.turbulent": "N s2/m2"},
)
