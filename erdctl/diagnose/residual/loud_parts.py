"""Records, and stretches of them, in which a model leaves far more than elsewhere, and no faster.

What a record or a place alone holds no regression learns from the others, so that it counts as
noise. But noise of a channel is alike in all of them, or where it is not its third differences are
larger as well. An effect that acts in one record of ten is not: a stroke that no other reaches, a
duty; nor a stop that is touched once.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds


def loud_parts(
    rest: Array, quick: Array, weight: Array, starts: Index, factor: float
) -> tuple[Array, float]:
    """(n,) mean square of a rest (n,) beyond noise in parts unlike the others, and the noise's.

    quick : (n,) squares of its third differences, nan where there is none
    starts : of the parts, and their end;  factor : of mean squares, from which on they are unlike
    Check: of six parts with squares of 1 one has 25 at the same third differences: 24 are beyond.
    >>> starts, ones = np.arange(0, 601, 100), np.ones(600)
    >>> rest = np.where(np.arange(600) < 100, 5.0, 1.0)
    >>> beyond, noise = loud_parts(rest, ones, ones, starts, 9.0)
    >>> beyond[[0, 100]].tolist(), noise
    ([24.0, 0.0], 1.0)
    """
    first = starts[:-1]
    told = np.isfinite(quick) & (weight > 0.0)
    mass, count = (np.add.reduceat(w, first) for w in (weight, told.astype(float)))
    square = np.add.reduceat(weight * rest**2, first) / np.maximum(mass, 1e-300)
    fast = np.add.reduceat(np.where(told, quick, 0.0), first) / np.maximum(count, 1.0)
    known = (count > thresholds.STATE_SAMPLES) & (square > 0.0) & (fast > 0.0)
    own = square.copy()
    if np.count_nonzero(known) >= thresholds.LEVELS_FROM:
        usual = float(np.median(square[known] / fast[known]))
        typical = float(np.median(square[known]))
        noise = usual * fast
        loud = known & (square > factor * np.maximum(noise, typical))
        own[loud] = noise[loud]
    beyond = np.repeat(square - own, np.diff(starts))
    return beyond, float(np.dot(mass, own) / max(float(mass.sum()), 1e-300))
