"""Compression leaves a void.

Compression leaves a void of up to s times the stroke, which release must take up first.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


@njit(cache=True)
def _left(x: Array, v: Array, start: int, x_v: float, g: float, lost: float, e: float) -> Array:
    """(m,) part of the fluid's force that is left over a void V, none as a record begins:
    dV = g dx up to x_v in compression, dV = dx down to 0 in release, 1 - lost min(1, V/(e x_v))."""
    out, void = np.ones(len(x)), 0.0
    for k in range(start + 1, len(x)):
        travel = x[k] - x[k - 1]
        void = min(void + g * travel, x_v) if travel > 0.0 else max(void + travel, 0.0)
        if v[k] < 0.0:
            out[k] = 1.0 - lost * min(1.0, void / (e * x_v))
    return out


def _part(grid: FineGrid, p: Values) -> Array:
    """What is usually fitted."""
    return np.asarray(_left(grid.x, grid.v, grid.start, p["x_v"], p["g"], p["lambda"], p["e"]))


USUAL = Hooks("cavitation", viscous=_part, yielding=_part)


def _law(plant: Plant) -> Law:
    p = plant.physics
    truth = {"x_v": p.void, "g": p.void_growth, "lambda": 1.0 - p.bubbles, "e": 2.0 * p.bubbles}
    return plant.with_physics(void=0.0).with_own(USUAL, **truth), truth


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_physics(void=s * by.x, void_growth=q["growth"], bubbles=q["bubbles"])


TWIN = Twin(
    name="cavitation",
    family="void",
    low=1e-7,
    start=0.02,
    high=1.0,
    build=_build,
    law=_law,
    shows={"physics.void": "m", "physics.void_growth": "1", "physics.bubbles": "1"},
    shape={"growth": (0.6, 1.0), "bubbles": (0.02, 0.2)},
)
