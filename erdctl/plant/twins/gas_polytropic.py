"""Gas behind a floating piston.

Eq. 3, its static part tared away: the gas volume vanishes at the rated stroke / s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(closing=s / (1.1 * by.stroke), polytropic=q["exponent"])


TWIN = Twin(
    name="gas_polytropic",
    family="gas",
    part="gas",
    low=1e-3,
    start=0.3,
    high=0.85,
    build=_build,
    shows={"physics.closing": "1/m", "physics.polytropic": "1"},
    shape={"exponent": (1.0, 1.4)},
)
