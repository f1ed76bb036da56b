"""Yield force times 1 + s sin(2 pi f t): the supply's ripple."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(ripple=s, ripple_rate=q["rate"])


TWIN = Twin(
    name="field_ripple",
    family="ripple",
    part="yielding",
    low=1e-4,
    start=0.1,
    high=0.95,
    build=_build,
    lies=Lies("yield", ("t",), "s sin(2 pi f z)"),
    shows={"outside.ripple": "1", "outside.ripple_rate": "Hz"},
    shape={"rate": (11.0, 47.0)},
    rigid=True,
)
