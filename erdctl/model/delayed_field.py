"""A field that is held from sample to sample, later or earlier than the log has it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals


def delayed_field(field: Array, s: Signals, late: float) -> Array:
    """(n,) its mean over the step that begins at each sample; late : by so much, < 0 earlier [s].

    Before a record its first value holds, after it its last.
    """
    out = np.empty_like(field)
    for a, b in pairwise(s.starts.tolist()):
        t, step = s.t[a:b] - s.t[a], s.step[a : b - 1]
        area = np.concatenate([[0.0], np.cumsum(field[a : b - 1] * step)])
        at = t - late
        passed = np.interp(at, t, area) + np.minimum(at, 0.0) * field[a]
        passed += np.maximum(at - t[-1], 0.0) * field[b - 1]
        out[a : b - 1] = np.diff(passed) / np.diff(at)
        out[b - 1] = np.interp(at[-1], t, field[a:b])
    return out
