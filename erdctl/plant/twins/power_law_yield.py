"""Under the field the fluid is a power-law fluid instead of a plastic one (Carreau).

    F_y -> F_y (v_k / v_0)^n (|v| / v_k) (1 + (v / v_k)^2)^((n - 1) / 2)

Far above the knee v_k that is (|v| / v_0)^n, far below it a viscous creep of the chains; v_0, half
the top speed, is where the yield force is sigma v^beta; n = s.
Source: P. J. Carreau, Rheological equations from molecular network theories, Trans. Soc. Rheology
16 (1972) 99-127.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _yielding(grid: FineGrid, p: Values) -> Array:
    n, knee = p["n"], p["v_k"]
    u = np.abs(grid.v) / knee
    return np.asarray((knee / p["v_0"]) ** n * u * (1.0 + u * u) ** (0.5 * (n - 1.0)))


HOOKS = Hooks("power_law_yield", yielding=_yielding)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # The knee goes with n, or it would be left where the power is gone. It is so low that the creep
    # below it moves the rod by less than bench logs show: it would be a second effect, yielding at
    # that speed.
    return plant.with_own(HOOKS, n=s, v_0=0.5 * by.v, v_k=q["knee"] * s * by.v)


def _law(plant: Plant) -> Law:
    n = plant.own_values("power_law_yield")["n"]
    return plant.with_own(HOOKS, n=n, v_0=0.1, v_k=1e-9), {"n": n}  # without a knee


TWIN = Twin(
    name="power_law_yield",
    family="yield law",
    part="yielding",
    low=1e-3,
    start=0.2,
    high=1.0,
    build=_build,
    law=_law,
    shows={"own.n": "1", "own.v_0": "m/s", "own.v_k": "m/s"},
    shape={"knee": (0.0003, 0.001)},
    rigid=True,
)
