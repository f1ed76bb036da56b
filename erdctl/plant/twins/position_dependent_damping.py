"""A duct that is tapered or grooved.

Damping times 1 + a x + b x^2: taper and groove, at most s at the end of the rated stroke;
nowhere does it fall below a twentieth.
"""

from __future__ import annotations

import math

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    a, b = math.cos(q["form"]), math.sin(q["form"])
    middle = -a * a / (4 * b) if abs(a) < abs(2 * b) and b > 0 else 0.0
    fall = -min(a + b, b - a, middle)
    most = min(s / (abs(a) + abs(b)), 0.95 / max(fall, 1e-6))
    return plant.with_physics(
        taper=most * a / (1.1 * by.stroke), groove=most * b / (1.1 * by.stroke) ** 2
    )


def _law(plant: Plant) -> Law:
    return plant, {
        "b_1": plant.physics.taper,
        "b_2": plant.physics.groove,
        "e_1": 0.0,
        "e_2": 0.0,
    }


TWIN = Twin(
    name="position_dependent_damping",
    family="bore",
    part="viscous",
    low=1e-3,
    start=0.3,
    high=5.0,
    build=_build,
    law=_law,
    shows={"physics.taper": "1/m", "physics.groove": "1/m2"},
    shape={"form": (0.0, 2 * math.pi)},
)
