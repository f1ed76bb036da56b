"""Viscous force times 1 + s sin(2 pi n U), U the duty: no simple function of the field."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(swing=s, swings=q["swings"] / by.duty)


TWIN = Twin(
    name="duty_viscosity",
    family="viscous law",
    part="viscous",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("viscous", ("duty",), "s sin(2 pi n z)"),
    shows={"outside.swing": "1", "outside.swings": "1"},
    shape={"swings": (1.2, 2.6)},
    rigid=True,
)
