"""Polarisation is exhausted at high fields.

tau_y = alpha E_s^beta tanh((E/E_s)^beta), or with a sharper knee alpha E^beta (1 +
(E/E_s)^(beta n))^(-1/n); E_s = the highest field / s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # Half of the fluids have the smooth knee of the source, others one that is all but a corner.
    knee = 10.0 ** q["knee"] if q["knee"] > 0.4 else 0.0
    return plant.with_physics(screening=s / by.duty, knee=knee)


def _law(plant: Plant) -> Law:
    return plant.with_physics(knee=0.0), {
        "n": 1.0,
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
    shows={"physics.screening": "1", "physics.knee": "1"},
    shape={"knee": (-0.3, 1.1)},
)
