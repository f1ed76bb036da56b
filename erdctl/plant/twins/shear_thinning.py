"""The viscous force grows with less than the speed.

c v_ref |xdot/v_ref|^n with n = 1 - s.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(flow_index=1.0 - s, v_ref=by.v)


def _law(plant: Plant) -> Law:
    # At 0.1 m/s, where the law is usually referred to, it has another coefficient.
    n = plant.physics.flow_index
    moved = (plant.physics.v_ref / 0.1) ** (1.0 - n)
    return plant, {
        "n": n,
        "compression.c_vis": plant.compression.c_vis * moved,
        "release.c_vis": plant.release.c_vis * moved,
    }


TWIN = Twin(
    name="shear_thinning",
    family="viscous law",
    part="viscous",
    low=1e-3,
    start=0.3,
    high=0.85,
    build=_build,
    law=_law,
    shows={"physics.flow_index": "1", "physics.v_ref": "m/s"},
)
