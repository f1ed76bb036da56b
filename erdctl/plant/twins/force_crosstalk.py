"""The force channel picks up the voltage of the electrodes, s times the damper's force at most, of
either sign.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    # At a node the channel shows what is set there, which the supply has from then on.
    return F + p["full"] * np.append(grid.U[1:], grid.U[-1])


HOOKS = Hooks("force_crosstalk", recorded=_recorded)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    full = s * by.force / by.duty
    return plant.with_own(HOOKS, full=full * (1.0 if q["up"] > 0.5 else -1.0))


def _law(plant: Plant) -> Law:
    return plant, {"F_u": plant.own_values("force_crosstalk")["full"]}


TWIN = Twin(
    name="force_crosstalk",
    family="static",
    part="yielding",
    low=1e-5,
    start=0.1,
    high=5.0,
    build=_build,
    law=_law,
    shows={"own.full": "N"},
    shape={"up": (0.0, 1.0)},
)
