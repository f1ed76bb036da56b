"""Dead time between duty and voltage.

Dead time of s seconds.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(dead_time=s)


def _law(plant: Plant) -> Law:
    return plant, {"tau": plant.physics.dead_time}


TWIN = Twin(
    name="input_delay",
    family="field in time",
    part="yielding",
    low=1e-5,
    start=0.02,
    high=0.25,
    build=_build,
    law=_law,
    shows={"physics.dead_time": "s"},
)
