"""A new bore drags; the drag fades with the passes over each spot."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(
        wear=s * by.force, wear_travel=q["passes"] * 2 * by.x / 64, wear_span=1.2 * by.stroke
    )


TWIN = Twin(
    name="bore_wear",
    family="wear",
    low=1e-5,
    start=0.2,
    high=10.0,
    build=_build,
    lies=Lies("friction", ("passes",), "W exp(-z)"),
    shows={"outside.wear": "N", "outside.wear_travel": "m", "outside.wear_span": "m"},
    shape={"passes": (1.0, 4.0)},
    rigid=True,
)
