"""No chains form below a critical field.

tau_y = alpha (E - E_c)^beta above E_c = s times the highest field.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(threshold=s * by.duty)


def _law(plant: Plant) -> Law:
    return plant, {"v_c": plant.physics.threshold}


TWIN = Twin(
    name="field_threshold",
    family="onset of field",
    part="yielding",
    low=1e-3,
    start=0.2,
    high=0.9,
    build=_build,
    law=_law,
    shows={"physics.threshold": "1"},
)
