"""The gap closes towards one end of the stroke, the more the stronger the pull of the field.

yield force times 1 + s (x/X) (U/U_top)

X and U_top are the largest of the campaign.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


def _yielding(grid: FineGrid, p: Values) -> Array:
    return np.asarray(1.0 + p["pull"] * grid.x / p["span"] * grid.U / p["top"])


HOOKS = Hooks("eccentric_electrodes", yielding=_yielding)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, pull=s, span=by.x, top=by.duty)


TWIN = Twin(
    name="eccentric_electrodes",
    family="place",
    part="yielding",
    low=1e-3,
    start=0.3,
    high=0.95,
    build=_build,
    lies=Lies("yield", ("x", "duty"), "s (z/X) (y/U)", alike=(("friction", ("x", "duty")),)),
    shows={"own.pull": "1", "own.span": "m", "own.top": "1"},
    rigid=True,
)
