"""Impulses in a residual: innovations far beyond what Gaussian noise of its colour has.

A seal that sticks and slips, or a joint that knocks, moves the force at once by more than noise
ever does, at moments that no state in the log may tell. Noise of any colour is a filtered sequence
of innovations of one size; such a jump is an innovation many times larger, whose trace then fades
with the colour of the residual. A spike, which is gone with the next sample, is no jump.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.estimate.autoregressive import ColouredNoise


def impulse_share(problem: Problem, residual: Array) -> float:
    """The share of a residual's (n,) square [N^2] that impulses hold; 0 if there are none.

    Innovations add to the square of a residual each for itself, so the share is theirs.
    """
    s, block = problem.block.signals, problem.block
    smooth, n, after = _smooth(problem), len(s), thresholds.IMPULSE_AFTER
    values = residual * (block.weight > 0)
    far = np.zeros(n, dtype=np.bool_)
    found, scale = values, 0.0
    for _ in range(3):
        noise = ColouredNoise.of(np.where(far, 0.0, values), s.starts, thresholds.IMPULSE_ORDER)
        found = _innovations(values, noise.coefficients, s.starts)
        scale = 1.4826 * float(np.median(np.abs(found[smooth]))) if smooth.any() else 0.0
        far = smooth & (np.abs(found) > thresholds.IMPULSE_SIGMAS * scale)
    if scale == 0.0:
        return 0.0
    mean = np.convolve(values, np.ones(after) / after)  # of a sample and those before it
    change = np.zeros_like(values)
    change[1 : n - after] = mean[after : n - 1] - mean[: n - after - 1]
    stays = change * found > thresholds.IMPULSE_STAYS * found**2
    impulse = far & stays & (np.abs(found) > thresholds.IMPULSE_QUANTA * _step(block.force))
    groups = len(np.unique(problem.group[impulse]))
    if np.count_nonzero(impulse) < thresholds.IMPULSES_LEAST or groups < thresholds.IMPULSE_GROUPS:
        return 0.0
    all_, sudden, kept = (float(np.sum(found[which] ** 2)) for which in (smooth, far, impulse))
    least = max(thresholds.IMPULSE_SHARE * all_, thresholds.IMPULSE_MOSTLY * sudden)
    return kept / all_ if kept > least else 0.0


def _innovations(values: Array, coefficients: Array, starts: npt.NDArray[np.intp]) -> Array:
    from scipy.signal import lfilter

    ahead = np.concatenate([[1.0], -coefficients])
    parts = [lfilter(ahead, [1.0], values[a:b]) for a, b in pairwise(starts.tolist())]
    return np.concatenate(parts)


def _step(force: Array) -> float:
    """The smallest step of a force channel [N]."""
    levels = np.diff(np.unique(force))
    return float(levels.min()) if levels.size else 0.0


def _smooth(problem: Problem) -> npt.NDArray[np.bool_]:
    """(n,) samples in which no model jumps either: away from reversals, duty steps and starts.

    A sign law that is a little wrong misses by something like a jump wherever the motion is slow.
    """
    s, used = problem.block.signals, problem.block.weight > 0
    steep = np.zeros(len(s), dtype=np.bool_)
    steep[s.starts[:-1]] = True
    steep[1:] |= (s.duty[1:] != s.duty[:-1]) | (used[1:] != used[:-1])
    steep[1:] |= s.compressing[1:] != s.compressing[:-1]
    slow = np.abs(s.xdot) < thresholds.IMPULSE_SLOW * float(np.sqrt(np.mean(s.xdot**2)))
    near = np.ones(2 * thresholds.IMPULSE_NEAR + 1)
    return (np.convolve(steep, near, mode="same") < 0.5) & used & ~slow
