"""Before it yields the fluid creeps, at a speed that goes with the field.

    sign(xdot) -> erf(sqrt(pi)/2 xdot / v_k),   v_k = s times the top speed (U / U_top)^q

Mostly it yields later in a stronger field, in some dampers earlier.
"""

from __future__ import annotations

import numpy as np
from scipy.special import erf

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin

LOWEST = 0.02  # of the highest duty


def _sign(grid: FineGrid, p: Values) -> Array:
    knee = p["v_k"] * np.maximum(grid.U / p["top"], LOWEST) ** p["q"]
    return np.asarray(erf(0.5 * np.sqrt(np.pi) * grid.v / knee))


HOOKS = Hooks("preyield_field_dependence", sign=_sign)


def _yielding_at_once(grid: FineGrid, p: Values) -> Array:
    """What is usually fitted: tanh(xdot / (v_y U^q)), no field below a hundredth."""
    return np.asarray(np.tanh(grid.v / (p["v_y"] * np.maximum(grid.U, 0.01) ** p["q"])))


USUAL = Hooks("preyield_field_dependence", sign=_yielding_at_once)


def _law(plant: Plant) -> Law:
    p = plant.own_values("preyield_field_dependence")
    values = {"v_y": p["v_k"] * p["top"] ** -p["q"], "q": p["q"]}
    return plant.with_own(USUAL, **values), values


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    power = q["q"] if q["way"] < 0.7 else -0.6 * q["q"]
    return plant.with_own(HOOKS, v_k=s * by.v, top=by.duty, q=power)


TWIN = Twin(
    name="preyield_field_dependence",
    family="sign law",
    part="yielding",
    low=1e-6,
    start=0.1,
    high=2.0,
    build=_build,
    law=_law,
    shows={"own.v_k": "m/s", "own.top": "1", "own.q": "1"},
    shape={"q": (0.7, 1.5), "way": (0.0, 1.0)},
    rigid=True,
)
