"""Medians and percentiles of short arrays, at every start of every command.

NumPy's own give the same numbers, but take ten times as long for a short record, and import masked
arrays first, which takes longer than all checks of a usual log.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.recording import Array


def medians(values: Array) -> Array:
    """(...,) median over the last axis of (..., n) finite values.

    Check: the medians of 3, 1, 2, 9 and of 0, 0, 4, 8 are 2.5 and 2.
    >>> medians(np.array([[3.0, 1.0, 2.0, 9.0], [0.0, 0.0, 4.0, 8.0]])).tolist()
    [2.5, 2.0]
    """
    middle = values.shape[-1] // 2
    # Both also where one will do: NumPy selects a pair several times as fast as a single value.
    parted = np.partition(values, (middle - 1, middle))
    if values.shape[-1] % 2:
        return np.asarray(parted[..., middle])
    return np.asarray(parted[..., middle - 1 : middle + 1].mean(axis=-1))


def median(values: Array | Sequence[float]) -> float:
    """Median of (n,) finite values."""
    return float(medians(np.asarray(values)))


def percentiles(values: Array, *wanted: float) -> list[float]:
    """Percentiles of (n,) finite values, between two of them on the straight line.

    Check: 0, 1, 2, 3 has the median 1.5 and the 90th percentile 2.7.
    >>> [round(p, 9) for p in percentiles(np.array([3.0, 0.0, 2.0, 1.0]), 50.0, 90.0)]
    [1.5, 2.7]
    """
    at = [p / 100.0 * (len(values) - 1) for p in wanted]
    low = [int(a) for a in at]
    high = [min(k + 1, len(values) - 1) for k in low]
    parted = np.partition(values, [*low, *high])
    below, above = parted[low].tolist(), parted[high].tolist()
    return [b + (a - k) * (c - b) for a, k, b, c in zip(at, low, below, above, strict=True)]
