"""B g(x) sign(xdot), g >= 0 an uneven bore; B = s times the damper's force."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(
        bumps=s * by.force, bump_pitch=q["pitch"] * by.x, bump_phase=q["phase"]
    )


TWIN = Twin(
    name="uneven_bore",
    family="bore",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    lies=Lies("friction", ("x",), "B g(z)"),
    shows={"outside.bumps": "N", "outside.bump_pitch": "m", "outside.bump_phase": "rad"},
    shape={"pitch": (0.5, 1.5), "phase": (0.0, 6.28)},
    rigid=True,
)
