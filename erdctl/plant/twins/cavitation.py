"""Compression leaves a void.

Compression leaves a void of up to s times the stroke, which release must take up first.
"""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(void=s * by.x, void_growth=q["growth"], bubbles=q["bubbles"])


TWIN = Twin(
    name="cavitation",
    family="void",
    low=1e-7,
    start=0.02,
    high=1.0,
    build=_build,
    shows={"physics.void": "m", "physics.void_growth": "1", "physics.bubbles": "1"},
    shape={"growth": (0.6, 1.0), "bubbles": (0.02, 0.2)},
)
