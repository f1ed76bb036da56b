"""The yield force builds up over a speed.

tanh(xdot/v_y), v_y = s times the top speed.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(v_y=s * by.v)


def _law(plant: Plant) -> Law:
    return plant, {"v_y": plant.physics.v_y}


TWIN = Twin(
    name="preyield_viscosity",
    family="sign law",
    part="yielding",
    low=1e-6,
    start=0.05,
    high=2.0,
    build=_build,
    law=_law,
    shows={"physics.v_y": "m/s"},
)
