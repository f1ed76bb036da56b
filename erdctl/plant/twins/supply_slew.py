"""The supply is limited in slew rate.

The supply needs s seconds from 0 to the highest duty.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(slew=s / by.duty)


def _law(plant: Plant) -> Law:
    return plant, {"T_full": plant.physics.slew}


TWIN = Twin(
    name="supply_slew",
    family="field in time",
    part="yielding",
    low=1e-4,
    start=0.1,
    high=3.0,
    build=_build,
    law=_law,
    shows={"physics.slew": "s"},
)
