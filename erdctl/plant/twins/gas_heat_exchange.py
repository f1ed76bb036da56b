"""The gas is stiffer fast than slow: heat flows to the wall within a time."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(gas_heat=s * by.force / by.x, gas_heat_time=q["time"] * by.x / by.v)


TWIN = Twin(
    name="gas_heat_exchange",
    family="gas",
    low=1e-4,
    start=0.2,
    high=10.0,
    build=_build,
    lies=Lies("force", ("fresh_x",), "k z"),
    shows={"outside.gas_heat": "N/m", "outside.gas_heat_time": "s"},
    shape={"time": (0.3, 3.0)},
    rigid=True,
)
