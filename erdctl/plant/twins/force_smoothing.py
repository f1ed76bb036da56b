"""The force was averaged over a part of each record's cycle before it was stored.

    F_rec = F * box(W) * box(W/4),   W = s T,   T = time between every second passage of x's middle

Two averages in a row, as of a converter that integrates and a program that smooths, so that a jump
becomes a slope with rounded ends. By the integral of the integral of straight lines between fine
nodes; towards the ends of a record both windows narrow together.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin

SHORT = 0.25  # of the second window to the first
NARROW = 4.0  # steps below which a window is none


def _recorded(F: Array, grid: FineGrid, p: Values) -> Array:
    at = slice(grid.start, grid.stop)
    y, v, n = F[at], grid.v[at], grid.stop - grid.start
    reach = 0.5 * p["window"] * _cycle(grid.x[at]) * (1.0 + SHORT)  # of both windows, in nodes
    k = np.arange(n, dtype=float)
    reach = np.minimum(reach, np.minimum(k, n - 1 - k))
    A = reach / (1.0 + SHORT)
    B = reach - A
    wide = 2.0 * A > NARROW
    # Where the motion turns inside a step the force may jump there, and not in its middle.
    turns = v[1:] * v[:-1] < 0.0
    before = np.where(turns, v[:-1] / np.where(turns, v[:-1] - v[1:], 1.0), 0.5)
    once = np.concatenate([[0.0], np.cumsum(before * y[:-1] + (1.0 - before) * y[1:])])
    twice = np.concatenate([[0.0], np.cumsum(once[:-1] + y[:-1] / 3.0 + y[1:] / 6.0)])

    def integral(u: Array) -> Array:
        """Of the integral, at node u: exact for straight lines between nodes."""
        i = np.clip(u.astype(int), 0, n - 2)
        d = u - i
        bend = 0.5 * y[i] + (y[i + 1] - y[i]) * d / 6.0
        return np.asarray(twice[i] + d * (once[i] + d * bend))

    k, A, B = k[wide], A[wide], B[wide]
    sums = integral(k + A + B) - integral(k + A - B) - integral(k - A + B) + integral(k - A - B)
    out = F.copy()
    out[at][wide] = sums / (4.0 * A * B)
    return out


def _cycle(x: Array) -> float:
    """Cycle of a motion in nodes, from its passages through the middle; 0 if it has none."""
    above = x > x.mean()
    passed = np.flatnonzero(above[1:] != above[:-1])
    if len(passed) < 2:
        return 0.0
    return 2.0 * float(passed[-1] - passed[0]) / (len(passed) - 1)


HOOKS = Hooks("force_smoothing", recorded=_recorded)


def _once(F: Array, grid: FineGrid, p: Values) -> Array:
    """What is usually fitted: one average, over a part of 2 pi rms(x) / rms(xdot)."""
    at = slice(grid.start, grid.stop)
    y, v, n = F[at], grid.v[at], grid.stop - grid.start
    x, read = grid.x[at][:: grid.every], v[:: grid.every]
    cycle = 2.0 * np.pi * float(np.std(x)) / float(np.sqrt(np.mean(read**2))) / grid.h
    k = np.arange(n, dtype=float)
    half = np.minimum(np.minimum(k, n - 1 - k), 0.5 * p["w"] * cycle)
    wide = 2.0 * half > NARROW
    turns = v[1:] * v[:-1] < 0.0
    before = np.where(turns, v[:-1] / np.where(turns, v[:-1] - v[1:], 1.0), 0.5)
    once = np.concatenate([[0.0], np.cumsum(before * y[:-1] + (1.0 - before) * y[1:])])

    def integral(u: Array) -> Array:
        i = np.clip(u.astype(int), 0, n - 2)
        return np.asarray(once[i] + (u - i) * (once[i + 1] - once[i]))

    k, half = k[wide], half[wide]
    out = F.copy()
    out[at][wide] = (integral(k + half) - integral(k - half)) / (2.0 * half)
    return out


USUAL = Hooks("force_smoothing", recorded=_once)


def _law(plant: Plant) -> Law:
    w = plant.own_values("force_smoothing")["window"]
    return plant.with_own(USUAL, w=w), {"w": w}


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, window=s)


TWIN = Twin(
    name="force_smoothing",
    family="smoothing",
    low=1e-4,
    start=0.05,
    high=0.4,
    build=_build,
    law=_law,
    shows={"own.window": "1"},
)
