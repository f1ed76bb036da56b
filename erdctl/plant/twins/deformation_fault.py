"""Deformation (Eq. 23).

Yield and viscous force times 1 - s, from its onset on. In half of the draws at once, else
over a ramp.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    ramp = max(q["ramp"], 0.0) * by.shortest
    return plant.with_physics(deformation=1.0 - s, onset=q["onset"] * by.shortest, ramp=ramp)


def _law(plant: Plant) -> Law:
    return plant, {
        "f": plant.physics.deformation,
        "t_0": plant.physics.onset,
        "t_r": plant.physics.ramp,
    }


TWIN = Twin(
    name="deformation_fault",
    family="slow loss",
    low=1e-3,
    start=0.2,
    high=0.98,
    build=_build,
    law=_law,
    shows={"physics.deformation": "1", "physics.onset": "s", "physics.ramp": "s"},
    shape={"onset": (0.2, 0.75), "ramp": (-0.25, 0.25)},
    hidden=True,
)
