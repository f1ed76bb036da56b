"""Gas behind a floating piston.

Eq. 3, its static part tared away: the gas volume vanishes at the rated stroke / s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(closing=s / (1.1 * by.stroke), polytropic=q["exponent"])


def _law(plant: Plant) -> Law:
    a, n = plant.physics.closing, plant.physics.polytropic
    preload = plant.compression.k_nom / (n * a)  # not tared
    return plant.with_physics(preload=preload), {"a": a, "gamma": n, "F_0": preload}


TWIN = Twin(
    name="gas_polytropic",
    family="gas",
    part="gas",
    low=1e-3,
    start=0.3,
    high=0.85,
    build=_build,
    law=_law,
    shows={"physics.closing": "1/m", "physics.polytropic": "1"},
    shape={"exponent": (1.0, 1.4)},
)
