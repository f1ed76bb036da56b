"""The yield force builds up over speed and deflection.

tanh(k_1 x + c_1 xdot); 1/c_1 = s times the top speed, k_1 x = `loop` at the stroke's end.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    v_y = s * by.v
    return plant.with_physics(v_y=v_y, lead=q["loop"] * v_y / by.x)


def _law(plant: Plant) -> Law:
    return plant, {"v_y": plant.physics.v_y, "kappa": plant.physics.lead}


TWIN = Twin(
    name="yield_hysteresis",
    family="sign law",
    part="yielding",
    low=1e-6,
    start=0.03,
    high=2.0,
    build=_build,
    law=_law,
    shows={"physics.v_y": "m/s", "physics.lead": "1/s"},
    shape={"loop": (1.5, 6.0)},
)
