"""Mass of the fluid column and of what moves.

s times the damper's force at the highest acceleration; no more than a damper of its size may
have: 50 kg for 1000 N, with its fixture and the fluid column as felt at the rod.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(mass=by.force * min(s / by.a, 0.05))


def _law(plant: Plant) -> Law:
    return plant, {"m": plant.physics.mass}


TWIN = Twin(
    name="fluid_inertia",
    family="inertia",
    low=1e-4,
    start=0.2,
    high=20.0,
    build=_build,
    law=_law,
    shows={"physics.mass": "kg"},
)
