"""The viscous force grows with less than the speed.

c v_ref |xdot/v_ref|^n with n = 1 - s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(flow_index=1.0 - s, v_ref=by.v)


TWIN = Twin(
    name="shear_thinning",
    family="viscous law",
    part="viscous",
    low=1e-3,
    start=0.3,
    high=0.85,
    build=_build,
    shows={"physics.flow_index": "1", "physics.v_ref": "m/s"},
)
