"""A leakage current takes a part of the voltage that grows while the voltage is on."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(leakage=s / by.duty, leakage_time=q["time"] * by.shortest)


TWIN = Twin(
    name="electrode_leakage",
    family="field in time",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("duty", ("late_duty",), "-l z", alike=(("yield", ("late_duty",)),)),
    shows={"outside.leakage": "1", "outside.leakage_time": "s"},
    shape={"time": (0.1, 0.5)},
    rigid=True,
)
