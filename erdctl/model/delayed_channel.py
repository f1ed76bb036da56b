"""A column that a channel shows later, or earlier, than it was."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals


def delayed(column: Array, s: Signals, late: Array) -> Array:
    """(n,) the column as it was (n,) `late` before each sample [s], < 0 for after it.

    Straight lines between samples; beyond the ends of a record its first or last value holds.
    """
    out = np.empty_like(column)
    for a, b in pairwise(s.starts.tolist()):
        t = s.t[a:b] - s.t[a]  # small numbers, whatever the clock says
        out[a:b] = np.interp(t - late[a:b], t, column[a:b])
    return out
