"""Play in a joint between stiff flanks, filled with something viscous.

Within the play c (xdot - v) alone is borne. Play = s times the stroke; the flanks give by `soft` of
the stroke under the largest force, and c is `thick` of the largest force over the largest speed.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(
        gap=s * by.x, mount=q["soft"] * s * by.x / by.force, film=q["thick"] * by.force / by.v
    )


def _law(plant: Plant) -> Law:
    p = plant.physics
    return plant, {"g": p.gap, "s_m": p.mount, "c_m": p.film}


TWIN = Twin(
    name="damped_backlash",
    family="series",
    also="play",
    low=1e-7,
    start=0.01,
    high=0.5,
    build=_build,
    law=_law,
    shows={"physics.gap": "m", "physics.mount": "m/N", "physics.film": "N s/m"},
    shape={"soft": (0.1, 0.5), "thick": (0.5, 3.0)},
    soft=True,
)
