"""A part s of the yield stress has settled when a record begins; travel stirs it up again."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # Stirred up again by a part of the travel of a typical record.
    return plant.with_outside(settled=s, stirring=q["stirring"] * by.v * by.shortest * 0.3)


TWIN = Twin(
    name="sedimentation",
    family="slow loss",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("yield", ("travel",), "-s exp(-z/L)"),
    shows={"outside.settled": "1", "outside.stirring": "m"},
    shape={"stirring": (0.2, 1.0)},
    rigid=True,
)
