"""Free play between the measured rod and the piston.

Piston within x -+ gap/2; gap = s times the stroke.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(gap=s * by.x)


def _law(plant: Plant) -> Law:
    return plant, {"g": plant.physics.gap}


TWIN = Twin(
    name="backlash",
    family="play",
    low=1e-7,
    start=0.01,
    high=0.5,
    build=_build,
    law=_law,
    shows={"physics.gap": "m"},
)
