"""Stretches of which few samples have weight, and these for their noise.

As where a car comes to rest: left are the samples whose direction of motion seems sure. They show
more speed than there is, and so a loss of force before its time.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array

AROUND, FEW = 10, 0.5  # samples on either side, of which fewer than half as many as usual weigh

Flags = npt.NDArray[np.bool_]


def seldom_weighed(weighed: Flags) -> Flags:
    """(n,) whether few of the samples around one have weight.

    weighed : (n,) whether a sample has;  usual is what lies around those that have
    Check: of 40 samples the first half weigh: so do most around the 20th, and few around the 28th.
    >>> seldom_weighed(np.arange(40) < 20)[[0, 19, 27, 39]].tolist()
    [False, False, True, True]
    """
    if not weighed.any():
        return np.zeros(len(weighed), np.bool_)
    sums, at = np.concatenate([[0.0], np.cumsum(weighed)]), np.arange(len(weighed))
    low, high = np.maximum(at - AROUND, 0), np.minimum(at + AROUND + 1, len(weighed))
    part = (sums[high] - sums[low]) / (high - low)
    return np.asarray(part < FEW * part[weighed].mean())


def moved_on(t: Array, seldom: Flags, end: float, way: int) -> float:
    """An end of an interval of times, moved on over such samples, -1 or 1 along the times (n,).

    >>> moved_on(np.arange(5.0), np.array([False, False, True, True, False]), 1.0, 1)
    3.0
    """
    k = int(np.clip(np.searchsorted(t, end), 0, len(t) - 1))
    while 0 <= k + way < len(t) and seldom[k + way]:
        k += way
    return float(min(end, t[k]) if way < 0 else max(end, t[k]))
