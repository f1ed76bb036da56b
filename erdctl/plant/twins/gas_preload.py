"""Static gas force.

s times the damper's force, mostly outward as a gas pushes.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(preload=s * by.force * (1.0 if q["inward"] < 0.7 else -1.0))


def _law(plant: Plant) -> Law:
    # Inward no gas pushes: what is fitted as one is not below 0.
    F_0 = abs(plant.physics.preload)
    return plant.with_physics(preload=F_0), {"F_0": F_0}


TWIN = Twin(
    name="gas_preload",
    family="static",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"physics.preload": "N"},
    shape={"inward": (0.0, 1.0)},
    equivalents=("force_offset",),
)
