"""A seal that sticks and slides.

Static friction s times the damper's force, kinetic a part of it.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(
        F_s=s * by.force, F_k=q["kinetic"] * s * by.force, v_s=q["v_s"] * by.v
    )


def _law(plant: Plant) -> Law:
    return plant, {
        "F_k": plant.physics.F_k,
        "F_sk": plant.physics.F_s - plant.physics.F_k,
        "v_s": plant.physics.v_s,
    }


TWIN = Twin(
    name="stribeck_friction",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"physics.F_s": "N", "physics.F_k": "N", "physics.v_s": "m/s"},
    shape={"kinetic": (0.1, 0.45), "v_s": (0.05, 0.3)},
)
