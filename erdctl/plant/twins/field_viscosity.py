"""Chains thicken the fluid between them while it flows.

    viscous force times 1 + s (U / U_top)^k, behind the chains' own time constant

The voltage is held over a fine step, and the chains approach it without error.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


@njit(cache=True)
def _grown(U: Array, h: float, start: int, top: float, k: float, T: float) -> Array:
    """(m,) thickness of the chains, 0..1; at rest in the field with which a record begins."""
    out = np.empty(len(U))
    state = (U[0] / top) ** k
    left = math.exp(-h / T)
    for i in range(len(U)):
        goal = (U[i] / top) ** k
        state = goal + (state - goal) * left
        if i == start:  # U is that of the step before a node
            state = (U[min(i + 1, len(U) - 1)] / top) ** k
        out[i] = state
    return out


def _viscous(grid: FineGrid, p: Values) -> Array:
    thick = _grown(grid.U, grid.h, grid.start, p["top"], p["power"], p["chains"])
    return np.asarray(1.0 + p["growth"] * thick)


HOOKS = Hooks("field_viscosity", viscous=_viscous)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    chains = q["chains"] * max(plant.compression.T_d, by.tick)
    return plant.with_own(HOOKS, growth=s, top=by.duty, power=q["power"], chains=chains)


def _law(plant: Plant) -> Law:
    p = plant.own_values("field_viscosity")
    r = p["growth"] * p["top"] ** -p["power"]
    return plant, {"r": r, "m": p["power"], "T_v": p["chains"]}


TWIN = Twin(
    name="field_viscosity",
    family="viscous law",
    part="viscous",
    low=1e-3,
    start=0.5,
    high=30.0,
    build=_build,
    law=_law,
    shows={"own.growth": "1", "own.top": "1", "own.power": "1", "own.chains": "s"},
    shape={"power": (0.6, 1.6), "chains": (0.5, 1.5)},
    rigid=True,
)
