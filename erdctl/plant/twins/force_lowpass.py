"""The force channel is behind an amplifier's low-pass filter.

A first pole of s times 0.1 s, and a second, faster by the drawn ratio, as the filter before a
converter has. Each is an average of the past under an exponential, node by node.
"""

from __future__ import annotations

from math import exp

import numpy as np
from scipy.signal import lfilter

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _one_pole(F: Array, kept: float) -> Array:
    """y[k] = kept y[k-1] + (1 - kept) F[k], settled before the first node."""
    out, _ = lfilter([1.0 - kept], [1.0, -kept], F, zi=[kept * F[0]])
    return np.asarray(out)


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    for pole in (p["slow"], p["fast"]):
        if pole > 0.0:
            F = _one_pole(F, exp(-grid.h / pole))
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
