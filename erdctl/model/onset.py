"""What sets in at a time in the record, at once or over a ramp, and stays.

    w(t) = mean over its sampling step about t of  min(1, max(0, (t - t_0) / t_r))
    factor of the groups that fail: 1 - (1 - f) w(t)

At a sample the mean over its own step says as much as a log can: between which two samples a step
lies. It also makes the force continuous in t_0, and with t_r = 0 the same as with a short ramp.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals

AMOUNT, START, RAMP = "f", "t_0", "t_r"

ONSET = (
    Quantity(
        symbol=AMOUNT, unit="1", title="effectiveness that is left",
        low=0.0, high=1.0, start=0.7, off=1.0,
    ),
    Quantity(
        symbol=START, unit="s", title="onset, in the time of each record",
        low=-1e6, high=1e6, start=10.0, off=10.0,
    ),
    Quantity(
        symbol=RAMP, unit="s", title="time over which it sets in",
        low=0.0, high=1e6, start=1.0, off=0.0,
    ),
)  # fmt: skip


def anywhere(s: Signals, rest: Array) -> list[dict[str, float]]:
    """The start of a fit, which searches all times itself (`erdctl.estimate.onsets`)."""
    return [{AMOUNT: 0.7, START: float(np.median(s.t)), RAMP: 0.0}]


def onset_weight(t: Array, t_0: float, t_r: float, step: Array | float) -> Array:
    """How far a change has set in at the samples of a log.

    t : (n,) time [s];  t_0 : onset [s];  t_r : ramp [s] >= 0
    step : that a sample stands for, (n,) or one for all [s]; where it is 0, its moment alone
    Returns (n,) w [1] in 0..1.
    Check: t = 9, 10, 11, 12, 13 s, onset at 10.5 s, 1 s between samples. At once: 0, 0, 1, 1, 1.
    Over 2 s: the mean over 10.5 to 11.5 s is 0.25, over 11.5 to 12.5 s 0.75.
    >>> t = np.array([9.0, 10.0, 11.0, 12.0, 13.0])
    >>> onset_weight(t, 10.5, 0.0, 1.0).tolist()
    [0.0, 0.0, 1.0, 1.0, 1.0]
    >>> onset_weight(t, 10.5, 2.0, 1.0).tolist()
    [0.0, 0.0, 0.25, 0.75, 1.0]
    """
    since = t - t_0
    low, high = np.clip(since - 0.5 * step, 0.0, t_r), np.clip(since + 0.5 * step, 0.0, t_r)
    # The area under the ramp, from its foot to each end of the step and beyond its top.
    area = 0.5 * (high**2 - low**2) / (t_r or 1.0) + np.clip(since + 0.5 * step - t_r, 0.0, step)
    if np.all(step):
        return np.clip(area / step, 0.0, 1.0)
    at_once = np.where(since >= t_r, 1.0, np.clip(since, 0.0, t_r) / (t_r or 1.0))
    mean = np.clip(area / np.where(step > 0.0, step, 1.0), 0.0, 1.0)
    return np.where(step > 0.0, mean, at_once)
