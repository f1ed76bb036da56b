"""Gaps of a record's time: steps in which samples were lost, and not those of a clock that jitters.

Such a clock makes one step long and its neighbours short, so what is missing is told by all the
samples beside: n lost in a gap move those behind it against those before it by n steps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from erdctl.core.quantiles import median
from erdctl.core.recording import Array, Index

GAP = 1.5  # usual steps; a longer one may have lost samples
BESIDE = 15  # samples on either side whose times say whether it has
JITTER = 6.0  # standard errors of that


class Gaps(NamedTuple):
    """(k,) the sample before the longest step of each, and how many samples each has lost."""

    at: Index
    lost: Index


def gaps_of(t: Array, steps: Array, step: float) -> Gaps:
    """Where a record lost samples.

    t : (n,) its times, increasing [s];  steps : (n - 1,) of these [s];  step : the usual one [s]
    Check: a sample that is 0.7 steps late, and 2 that are lost behind sample 59.
    >>> t = np.arange(100.0)
    >>> t[30], t[60:] = 30.7, t[60:] + 2.0
    >>> found = gaps_of(t, np.diff(t), 1.0)
    >>> found.at.tolist(), found.lost.tolist()
    ([59], [2])
    """
    long = np.flatnonzero(steps > GAP * step)
    if not len(long):
        return Gaps(long, long)
    new = np.append(True, np.diff(long) > BESIDE)
    ends = np.append(np.flatnonzero(new), len(long))
    lost, error = _lost(t, steps, long[new], long[np.append(new[1:], True)])
    told = lost > np.maximum(GAP - 1.0, JITTER * error)
    at, missing = [long[:0]], [long[:0]]
    for k in np.flatnonzero(told):
        own, whole = long[ends[k] : ends[k + 1]], np.round(lost[k : k + 1]).astype(np.intp)
        each = np.round(steps[own] / step - 1.0).astype(np.intp)
        if len(own) <= BESIDE and each.sum() != whole[0]:  # among them are some of the jitter
            own, each = own[[steps[own].argmax()]], whole
        at.append(own)
        missing.append(each)
    return Gaps(np.concatenate(at), np.concatenate(missing))


def _lost(t: Array, steps: Array, first: Index, last: Index) -> tuple[Array, Array]:
    """(k,) how many samples are missing in gaps, and the standard error of that.

    first, last : (k,) the samples before the first and the last step of each that is long
    """
    k = np.arange(np.clip(len(t) // 4, 1, BESIDE))
    step = median(t[len(k) :] - t[: -len(k)]) / len(k)
    before = np.maximum(first[:, None] - k, 0)
    after = np.minimum(last[:, None] + 1 + k, len(t) - 1)
    begins = np.median(t[before] - step * before, axis=1)
    ends = np.median(t[after] - step * after, axis=1)
    scatter = 1.4826 * median(np.abs(steps - step)) / np.sqrt(2.0)
    own = np.minimum(first + 1, len(k)), np.minimum(len(t) - 1 - last, len(k))
    error = scatter * np.sqrt(0.5 * np.pi * (1.0 / own[0] + 1.0 / own[1]))  # of two medians
    return np.asarray((ends - begins) / step), np.asarray(error / step)
