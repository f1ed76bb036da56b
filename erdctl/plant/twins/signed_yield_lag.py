"""The lag acts on the yield force with its sign.

T_d dY/dt + Y = sigma v^beta sign(xdot); T_d = s seconds, its ratio between the directions
as drawn.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    up, down = plant.compression, plant.release
    scale = s / (up.T_d * down.T_d) ** 0.5
    return plant._replace(
        compression=up._replace(T_d=up.T_d * scale), release=down._replace(T_d=down.T_d * scale)
    ).with_physics(signed=1.0)


def _law(plant: Plant) -> Law:
    return plant._replace(release=plant.release._replace(T_d=plant.compression.T_d)), {
        "T_s": plant.compression.T_d,
        "compression.T_d": 0.0,
        "release.T_d": 0.0,
    }


TWIN = Twin(
    name="signed_yield_lag",
    family="sign law",
    part="yielding",
    low=1e-5,
    start=0.03,
    high=0.25,
    build=_build,
    law=_law,
    shows={"compression.T_d": "s", "release.T_d": "s"},
)
