"""Chains form and dissolve at unlike speeds.

T_d e^s while chains form and T_d e^-s while they dissolve, or the other way round.
"""

from __future__ import annotations

import math

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    slow = s if q["slow_rise"] > 0.4 else -s
    return plant.with_physics(rise=math.exp(slow), decay=math.exp(-slow))


def _law(plant: Plant) -> Law:
    return plant, {
        "r": plant.physics.decay / plant.physics.rise,
        "compression.T_d": plant.compression.T_d * plant.physics.rise,
        "release.T_d": plant.release.T_d * plant.physics.rise,
    }


TWIN = Twin(
    name="rise_decay_asymmetry",
    family="field in time",
    part="yielding",
    low=1e-3,
    start=0.6,
    high=2.0,
    build=_build,
    law=_law,
    shows={"physics.rise": "1", "physics.decay": "1"},
    shape={"slow_rise": (0.0, 1.0)},
)
