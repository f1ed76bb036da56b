"""The zero of the force channel drifts.

s times the damper's force over the longest record.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    up = 1.0 if q["up"] > 0.5 else -1.0
    return plant.with_channel(drift=up * s * by.force / by.longest)


def _law(plant: Plant) -> Law:
    return plant, {"d_1": plant.channel.drift, "d_2": 0.0}


TWIN = Twin(
    name="force_drift",
    family="zero",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"channel.drift": "N/s"},
    shape={"up": (0.0, 1.0)},
)
