"""How far logs of one damper scatter beyond their own errors, whatever trend they follow."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from erdctl.core.recording import Array

MEDIAN_CHI2 = 0.4549364231195724  # of one degree of freedom


def extra_scatter(value: Array, stderr: Array) -> float:
    """Standard deviation tau from log to log beyond the standard errors.

        (y_{i+1} - y_i)^2 / (e_i^2 + e_{i+1}^2 + 2 tau^2) has the median of chi2 with 1 degree

    value, stderr : (n,) in the order of time; an error that is not known counts as 0
    A step or a drift moves few of the differences, or all by little, and outliers are few: the
    median does not see them. 0 where the errors alone are enough.
    Check: without errors, equal steps of 1 up and down have tau = sqrt(1/2/0.4549) = 1.0484.
    >>> float(extra_scatter(np.array([0.0, 1.0, 0.0, 1.0, 0.0]), np.full(5, np.nan)).__round__(4))
    1.0484
    """
    e2 = np.nan_to_num(stderr, nan=0.0) ** 2
    steps, both = np.diff(value) ** 2, e2[1:] + e2[:-1]
    if not len(steps) or not steps.any():
        return 0.0

    top = float(steps.max()) / MEDIAN_CHI2

    def beyond(tau2: float) -> float:
        return float(np.median(steps / np.maximum(both + 2 * tau2, 1e-30 * top))) - MEDIAN_CHI2

    if beyond(0.0) <= 0.0:
        return 0.0
    return float(np.sqrt(brentq(beyond, 0.0, top, rtol=1e-10)))


def spread(value: Array, stderr: Array, floor: float = 0.0) -> Array:
    """(n,) standard deviation of each log's value around the damper's own: error and scatter.

    floor : at least that, where values have no error and do not scatter
    """
    tau = extra_scatter(value, stderr)
    return np.maximum(np.sqrt(np.nan_to_num(stderr, nan=0.0) ** 2 + tau**2), floor)


def least(value: Array) -> float:
    """What numbers of that size are rounded to, so that no error is 0."""
    size = float(np.abs(value).max(initial=0.0))
    return max(1e-12 * size, np.finfo(float).tiny)
