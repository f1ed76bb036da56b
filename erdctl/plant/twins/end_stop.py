"""Bump and rebound stops.

Touched over the last part of the stroke; s times the damper's force at its end.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    depth = q["depth"] * by.x
    high = by.x - depth
    low = -high * q["rebound"]
    return plant.with_physics(stop_high=high, stop_low=low, stop_rate=s * by.force / depth)


def _law(plant: Plant) -> Law:
    return plant.with_physics(stop_low=-plant.physics.stop_high), {
        "x_stop": plant.physics.stop_high,
        "k_c": plant.physics.stop_rate,
        "k_r": plant.physics.stop_rate,
    }


TWIN = Twin(
    name="end_stop",
    family="stop",
    low=1e-4,
    start=0.3,
    high=60.0,
    build=_build,
    law=_law,
    shows={"physics.stop_high": "m", "physics.stop_low": "m", "physics.stop_rate": "N/m"},
    shape={"depth": (0.15, 0.45), "rebound": (0.9, 1.3)},
)
