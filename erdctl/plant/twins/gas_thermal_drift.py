"""The gas warms with the damper and pushes harder.

    F + F_g T / T_0,   C dT/dt = F v - C T / tau

All work that the rod does becomes heat but for what the gas gives back within a cycle. F_g and the
heat capacity C are such that the hottest record would gain s times the damper's force uncooled.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin

COLD = 293.0  # K


@njit(cache=True)
def _warmth(F: Array, v: Array, h: float, start: int, heating: float, cooling: float) -> Array:
    """(m,) temperature above the ambient one [K], by the trapezoidal rule; cold at the start."""
    T = np.zeros(len(F))
    for k in range(start + 1, len(F)):
        power = 0.5 * (F[k - 1] * v[k - 1] + F[k] * v[k])
        T[k] = ((1.0 - 0.5 * h * cooling) * T[k - 1] + h * heating * power) / (
            1.0 + 0.5 * h * cooling
        )
    return T


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    T = _warmth(F, grid.v, grid.h, grid.start, p["heating"], p["cooling"])
    return np.asarray(F + p["static"] * T / COLD)


HOOKS = Hooks("gas_thermal_drift", force=_force)


def _by_the_fluid(F: Array, grid: FineGrid, p: Values) -> Array:
    """What is usually fitted: the fluid's work alone becomes heat."""
    fluid = F - np.where(grid.v > 0.0, p["k_c"], p["k_r"]) * grid.x
    T = _warmth(fluid, grid.v, grid.h, grid.start, p["heating"], p["cooling"])
    return np.asarray(F + p["static"] * T / COLD)


USUAL = Hooks("gas_thermal_drift", force=_by_the_fluid)


def _law(plant: Plant) -> Law:
    p = plant.own_values("gas_thermal_drift")
    k_c, k_r = plant.compression.k_nom, plant.release.k_nom
    truth = {"g": p["static"] * p["heating"] / COLD, "tau_g": 1.0 / p["cooling"]}
    return plant.with_own(USUAL, **p, k_c=k_c, k_r=k_r), truth


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    static = q["static"] * by.force
    return plant.with_own(
        HOOKS, static=static, heating=COLD * s / (q["static"] * by.energy),
        cooling=1.0 / (q["cooling"] * by.longest),
    )  # fmt: skip


TWIN = Twin(
    name="gas_thermal_drift",
    family="zero",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"own.static": "N", "own.heating": "K/J", "own.cooling": "1/s"},
    shape={"static": (0.5, 2.0), "cooling": (0.5, 10.0)},
    hidden=True,
    rigid=True,
)
