"""A seal that sticks, stretches and springs back by a part of its stretch, again and again."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    stretch = q["stretch"] * by.x
    return plant.with_outside(
        chatter=s * by.force / stretch, chatter_break=stretch, chatter_slip=q["slip"] * stretch
    )


TWIN = Twin(
    name="stick_slip",
    family="seal",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    shows={"outside.chatter": "N/m", "outside.chatter_break": "m", "outside.chatter_slip": "m"},
    shape={"stretch": (0.05, 0.25), "slip": (0.5, 1.2)},
    rigid=True,
)
