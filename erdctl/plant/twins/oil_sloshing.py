"""Free oil sloshes at a frequency of its own: F + A y,  y'' + 2 d w y' + w^2 y = w xdot'/V.

At rest as a record begins.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


@njit(cache=True)
def _sloshing(a: Array, h: float, start: int, w: float, d: float) -> Array:
    """(m,) y for y'' + 2 d w y' + w^2 y = a, semi-implicit in steps far shorter than 1/w."""
    out = np.zeros(len(a))
    y = rate = 0.0
    for k in range(start + 1, len(a)):
        rate += h * (a[k - 1] - 2.0 * d * w * rate - w * w * y)
        y += h * rate
        out[k] = y
    return out


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    w = 2.0 * np.pi * p["rate"]
    y = _sloshing(grid.a / p["speed"] * w, grid.h, grid.start, w, p["damping"])
    return np.asarray(F + p["force"] * y)


HOOKS = Hooks("oil_sloshing", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    rate = q["rate"] * by.v / (2.0 * np.pi * by.x)
    return plant.with_own(HOOKS, force=s * by.force, rate=rate, damping=q["damping"], speed=by.v)


TWIN = Twin(
    name="oil_sloshing",
    family="resonance",
    low=1e-4,
    start=0.1,
    high=10.0,
    build=_build,
    lies=Lies("force", ("ringing_xdot",), "A y"),
    shows={"own.force": "N", "own.rate": "Hz", "own.damping": "1", "own.speed": "m/s"},
    shape={"rate": (1.5, 5.0), "damping": (0.03, 0.2)},
    rigid=True,
)
