"""The force channel is recorded late or early.

Force later (in three of four cases) or earlier by s periods of the motion, 2 pi x/v each;
0.1 s at most. Whole steps of the simulation: no interpolation finds the jump at a reversal.
"""

from __future__ import annotations

import math

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    late = 1.0 if q["early"] < 0.75 else -1.0
    skew = min(s * 2 * math.pi * by.x / by.v, 0.1)
    return plant.with_channel(skew=late * round(skew / by.tick) * by.tick)


def _law(plant: Plant) -> Law:
    return plant, {"tau": plant.channel.skew}


TWIN = Twin(
    name="time_skew",
    family="time",
    low=1e-7,
    start=0.003,
    high=0.3,
    build=_build,
    law=_law,
    shows={"channel.skew": "s"},
    shape={"early": (0.0, 1.0)},
)
