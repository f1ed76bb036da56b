"""The fluid heats, thins and weakens.

C dT/dt = power - C T / tau; c and sigma fall as exp(-g T). C is such that the hottest
record would lose s nepers of yield force without cooling.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    weaken = q["weaken"]
    return plant.with_physics(
        thin=q["thin"],
        weaken=weaken,
        heating=s / (weaken * by.energy),
        cooling=1.0 / (q["cooling"] * by.longest),
    )


def _law(plant: Plant) -> Law:
    return plant, {
        "a_v": plant.physics.thin * plant.physics.heating,
        "a_y": plant.physics.weaken * plant.physics.heating,
        "tau": 1.0 / plant.physics.cooling,
    }


TWIN = Twin(
    name="thermal_fade",
    family="slow loss",
    low=1e-3,
    start=0.4,
    high=8.0,
    build=_build,
    law=_law,
    shows={
        "physics.heating": "K/J",
        "physics.cooling": "1/s",
        "physics.thin": "1/K",
        "physics.weaken": "1/K",
    },
    shape={"thin": (0.008, 0.03), "weaken": (0.004, 0.015), "cooling": (1.0, 10.0)},
    hidden=True,
)
