"""The packing loosens with the largest stroke that it has made: yield times 1 - s (m/X)^p.

m is the largest |x| since the record began, X the largest of the campaign.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _yielding(grid: FineGrid, p: Values) -> Array:
    size = np.abs(grid.x)
    size[: grid.start] = 0.0
    return np.asarray(1.0 - p["loss"] * (np.maximum.accumulate(size) / p["span"]) ** p["power"])


HOOKS = Hooks("stroke_softening", yielding=_yielding)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, loss=s, span=by.x, power=q["power"])


TWIN = Twin(
    name="stroke_softening",
    family="slow loss",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("yield", ("largest_x",), "-s (z/X)^p"),
    shows={"own.loss": "1", "own.span": "m", "own.power": "1"},
    shape={"power": (0.7, 2.5)},
    rigid=True,
)
