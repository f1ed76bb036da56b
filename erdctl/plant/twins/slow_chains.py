"""Chains form more slowly in a weak field: T_d times 1 + s (1 - U/U_top).

U_top is the highest duty of the campaign, and above it nothing is slower.

What the state of Eq. 12 would be with that time constant, less what it is with its own.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Lies, Scales, Shape, Twin


@njit(cache=True)
def _more(
    U: Array, v: Array, h: float, start: int, T: Array, sigma: Array, beta: Array, s: float,
    top: float,
) -> Array:  # fmt: skip
    """(m,) yield force more than with T alone [N]; T, sigma, beta : (2,) of either direction."""
    out = np.zeros(len(U))
    side, plain, slow = 0, 0.0, 0.0
    for k in range(start, len(U)):
        if v[k] != 0.0:
            side = 0 if v[k] > 0.0 else 1
        if k == start:
            first = U[min(k + 1, len(U) - 1)]
            plain = slow = sigma[side] * first ** beta[side]
        else:
            goal = sigma[side] * U[k] ** beta[side]
            longer = T[side] * (1.0 + s * max(1.0 - U[k] / top, 0.0))
            plain = goal + (plain - goal) * np.exp(-h / T[side])
            slow = goal + (slow - goal) * np.exp(-h / longer)
        out[k] = (slow - plain) * np.sign(v[k])
    return out


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    T, sigma, beta = (np.array([p[f"{n}_c"], p[f"{n}_r"]]) for n in ("T", "sigma", "beta"))
    more = _more(grid.U, grid.v, grid.h, grid.start, T, sigma, beta, p["slower"], p["top"])
    return np.asarray(F + more)


HOOKS = Hooks("slow_chains", force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    up, down = plant.compression, plant.release
    return plant.with_own(
        HOOKS, slower=s, top=by.duty, T_c=max(up.T_d, by.tick), T_r=max(down.T_d, by.tick),
        sigma_c=up.sigma, sigma_r=down.sigma, beta_c=up.beta, beta_r=down.beta,
    )  # fmt: skip


TWIN = Twin(
    name="slow_chains",
    family="lag",
    part="yielding",
    low=1e-2,
    start=2.0,
    high=6.0,
    build=_build,
    lies=Lies("lag", ("duty",), "s (1 - z/U)"),
    shows={
        "own.slower": "1",
        "own.top": "1",
        "own.T_c": "s",
        "own.T_r": "s",
        "own.sigma_c": "N",
        "own.sigma_r": "N",
        "own.beta_c": "1",
        "own.beta_r": "1",
    },
    rigid=True,
)
