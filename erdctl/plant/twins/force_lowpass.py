"""The force channel is behind an amplifier's low-pass filter.

A first pole of s times 0.1 s, and a second, faster by the drawn ratio, as the filter before a
converter has. Each is an average of the past under an exponential, exact for straight lines from
node to node.
"""

from __future__ import annotations

from math import exp

import numpy as np
from scipy.signal import lfilter

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _one_pole(F: Array, v: Array, steps: float) -> Array:
    """Of a time constant of so many steps, settled before the first node.

    Where the motion turns inside a step the force may jump there, and not in its middle.
    """
    kept = exp(-1.0 / steps)
    now = 1.0 - (1.0 - kept) * steps
    source = (1.0 - kept - now) * F[:-1] + now * F[1:]
    turns = np.flatnonzero(v[1:] * v[:-1] < 0.0)
    before = v[turns] / (v[turns] - v[turns + 1])
    until, since = np.exp(-before / steps), np.exp((before - 1.0) / steps)
    source[turns] = (1.0 - until) * since * F[turns] + (1.0 - since) * F[turns + 1]
    out, _ = lfilter([1.0], [1.0, -kept], source, zi=[kept * F[0]])
    return np.append(F[0], out)


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    v = grid.v
    for pole in (p["slow"], p["fast"]):
        if pole > 0.0:
            F, v = _one_pole(F, v, pole / grid.h), np.ones_like(v)  # a filtered force has no jump
    return F


HOOKS = Hooks("force_lowpass", recorded=_recorded)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, slow=0.1 * s, fast=0.1 * s * q["ratio"])


def _law(plant: Plant) -> Law:
    p = plant.own_values("force_lowpass")
    tau = p["slow"] + p["fast"]
    return plant.with_own(HOOKS, slow=tau, fast=0.0), {"tau": tau}


TWIN = Twin(
    name="force_lowpass",
    family="time",
    also="smoothing",
    low=1e-4,
    start=0.03,
    high=1.0,
    build=_build,
    law=_law,
    shows={"own.slow": "s", "own.fast": "s"},
    shape={"ratio": (0.0, 0.1)},
)
