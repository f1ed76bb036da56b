"""The forms that a parameter may follow over time, and where one may set in."""

from __future__ import annotations

from enum import Enum

import numpy as np

from erdctl.compare.history import YEAR
from erdctl.core.recording import Array

LEAST = 3  # logs on either side of a change
PLACES = 200  # at which a change is looked for
FINER = 4  # places of a bend to one gap between logs
AROUND = 6  # gaps beyond the interval of a bend in which it is looked for again


class Course(Enum):
    """How a parameter goes over time."""

    CONSTANT = "constant"
    LINEAR = "linear"  # from the first log on
    STEP = "step"
    RAMP = "ramp"  # constant, then growing or falling since a date


def step_edges(t: Array) -> Array:
    """Dates between two logs at which a step may lie, at least `LEAST` logs from either end.

    Check: of days 0 to 6 a step may lie at 2.5 or 3.5.
    >>> step_edges(np.arange(7.0)).tolist()
    [2.5, 3.5]
    """
    middle = 0.5 * (t[1:] + t[:-1])[LEAST - 1 : len(t) - LEAST]
    between = np.unique(middle[(t[1:] > t[:-1])[LEAST - 1 : len(t) - LEAST]])
    if len(between) > PLACES:
        between = between[np.linspace(0, len(between) - 1, PLACES).astype(int)]
    return between


def bend_edges(t: Array) -> Array:
    """Dates between two logs at which a ramp may set in: twice as many logs must follow as after a
    step, since the last of three has most of the say in how steep it is."""
    edges = step_edges(t)
    return edges[edges < t[-2 * LEAST]] if len(t) > 2 * LEAST else edges[:0]


def bends(t: Array, first: float, last: float) -> Array:
    """Dates at which a ramp may set in, around an interval: finer than the logs, since what
    follows tells it."""
    edges = bend_edges(t)
    low = max(int(np.searchsorted(edges, first)) - AROUND, 0)
    high = min(int(np.searchsorted(edges, last)) + AROUND, len(edges) - 1)
    at = low + np.arange((high - low) * FINER + 1) / FINER
    return np.asarray(np.interp(at, np.arange(len(edges)), edges))


def columns(form: Course, t: Array, since: float) -> Array:
    """(n, k) what a form adds to a constant, per year where it grows.

    since : date at which it sets in [days]; without meaning for a constant or a line
    """
    if form is Course.CONSTANT:
        return np.empty((len(t), 0))
    begin = float(t[0]) if form is Course.LINEAR else since
    grown: Array = np.maximum(t - begin, 0.0) / YEAR
    if form is Course.STEP:
        grown = np.asarray(t > since, dtype=np.float64)
    return grown.reshape(-1, 1)
