"""Bump and rebound stops.

Touched over the last part of the stroke; s times the damper's force at its end. Some dampers have
one at one end only, and some lose energy in the contact: k d (1 + loss dd/dt).
"""

from __future__ import annotations

from erdctl.plant.plant import FOREVER, Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    depth = q["depth"] * by.x
    high = by.x - depth
    low = -high * q["rebound"]
    if q["ends"] > 0.75:
        low = -FOREVER
    elif q["ends"] < 0.15:
        # The rebound stop alone, where the motion surely gets.
        high, low = FOREVER, -high
    loss = max(q["loss"], 0.0) / by.v
    return plant.with_physics(
        stop_high=high, stop_low=low, stop_rate=s * by.force / depth, stop_loss=loss
    )


def _law(plant: Plant) -> Law:
    high, low = plant.physics.stop_high, -plant.physics.stop_low
    high, low = (min(high, low) if end == FOREVER else end for end in (high, low))
    # Both ends, and damping that levels off: of Hunt and Crossley's, which does not, nothing tells
    # depth and damping apart.
    depth, loss = 0.1 * high, plant.physics.stop_loss
    return plant.with_physics(stop_high=high, stop_low=-low, stop_depth=depth), {
        "x_stop": high,
        "x_r": low,
        "k_c": plant.physics.stop_rate,
        "k_r": plant.physics.stop_rate,
        "theta": loss * depth,
        "e": depth,
    }


TWIN = Twin(
    name="end_stop",
    family="stop",
    low=1e-4,
    start=0.3,
    high=60.0,
    build=_build,
    law=_law,
    shows={
        "physics.stop_high": "m",
        "physics.stop_low": "m",
        "physics.stop_rate": "N/m",
        "physics.stop_loss": "s/m",
    },
    shape={"depth": (0.15, 0.45), "rebound": (0.9, 1.3), "ends": (0.0, 1.0), "loss": (-2.0, 3.0)},
)
