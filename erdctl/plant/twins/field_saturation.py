"""Polarisation is exhausted at high fields.

tau_y = alpha E_s^beta tanh((E/E_s)^beta); E_s = the highest field / s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(screening=s / by.duty)


def _law(plant: Plant) -> Law:
    return plant, {
        "a_c": plant.physics.screening**plant.compression.beta,
        "a_r": plant.physics.screening**plant.release.beta,
    }


TWIN = Twin(
    name="field_saturation",
    family="top of field",
    part="yielding",
    low=0.02,
    start=1.5,
    high=12.0,
    build=_build,
    law=_law,
    shows={"physics.screening": "1"},
)
