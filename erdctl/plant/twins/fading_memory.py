"""A force that remembers the speed: the difference of two lags of xdot |xdot|."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    time = by.x / by.v
    return plant.with_outside(
        memory=s * by.force,
        memory_short=q["short"] * time,
        memory_long=q["long"] * time,
        memory_speed=0.5 * by.v,
    )


TWIN = Twin(
    name="fading_memory",
    family="memory",
    low=1e-4,
    start=0.2,
    high=20.0,
    build=_build,
    lies=Lies("force", ("late_flow",), "A z, less the same over a longer time"),
    shows={
        "outside.memory": "N",
        "outside.memory_short": "s",
        "outside.memory_long": "s",
        "outside.memory_speed": "m/s",
    },
    shape={"short": (0.2, 0.6), "long": (2.0, 6.0)},
    rigid=True,
)
