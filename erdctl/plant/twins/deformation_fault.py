"""Deformation (Eq. 23).

Yield and viscous force times 1 - s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(deformation=1.0 - s, onset=q["onset"] * by.shortest)


def _law(plant: Plant) -> Law:
    return plant, {"f": plant.physics.deformation, "t_0": plant.physics.onset}


TWIN = Twin(
    name="deformation_fault",
    family="slow loss",
    low=1e-3,
    start=0.2,
    high=0.98,
    build=_build,
    law=_law,
    shows={"physics.deformation": "1", "physics.onset": "s"},
    shape={"onset": (0.2, 0.75)},
    hidden=True,
)
