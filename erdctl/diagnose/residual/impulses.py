"""Sudden jumps in a residual: innovations far beyond what Gaussian noise of its colour has.

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
from erdctl.diagnose.problem import Problem
from erdctl.estimate.autoregressive import ColouredNoise

FAR = 6.0  # times the scale of the middle half of the innovations
FEW = 8  # jumps, in at least
PLACES = 3  # groups
ORDER = 2  # of the residual's colour: more would learn the beat of a regular saw-tooth
NEAR = 4  # samples next to a reversal, a step of the duty or the start of a record, left out
SLOW = 0.2  # of the log's speed, rms: slower samples are left out too
STAYS = 0.5  # of a jump that must be there in the mean of
AFTER = 3  # samples, over that of as many before
SHARE = 0.1  # of the square of all innovations that they must have
MOSTLY = 0.5  # of that of those that are far out: what else is sudden is spikes
QUANTA = 3.0  # steps of the force channel that a jump must be more than


def impulse_share(problem: Problem, residual: Array) -> float:
    """The share of a residual's (n,) square [N^2] that jumps hold; 0 if there are none to speak of.

    Innovations add to the square of a residual each for itself, so the share is theirs.
    """
    s, block = problem.block.signals, problem.block
    lower, n = _quiet(problem), len(s)
    values = residual * (block.weight > 0)
    far = np.zeros(len(values), dtype=np.bool_)
    found = values
    for _ in range(3):
        noise = ColouredNoise.of(np.where(far, 0.0, values), s.starts, ORDER)
        found = _innovations(values, noise.coefficients, s.starts)
        scale = 1.4826 * float(np.median(np.abs(found[lower]))) if lower.any() else 0.0
        far = lower & (np.abs(found) > FAR * scale)
    if scale == 0.0:
        return 0.0
    mean = np.convolve(values, np.ones(AFTER) / AFTER)  # of a sample and those before it
    change = np.zeros_like(values)
    change[1 : n - AFTER] = mean[AFTER : n - 1] - mean[: n - AFTER - 1]
    jump = far & (change * found > STAYS * found**2) & (np.abs(found) > QUANTA * _step(block.force))
    if np.count_nonzero(jump) < FEW or len(np.unique(problem.group[jump])) < PLACES:
        return 0.0
    all_, sudden, in_impulses = (float(np.sum(found[which] ** 2)) for which in (lower, far, jump))
    return in_impulses / all_ if in_impulses > max(SHARE * all_, MOSTLY * sudden) else 0.0


def _innovations(values: Array, coefficients: Array, starts: npt.NDArray[np.intp]) -> Array:
    from scipy.signal import lfilter

    ahead = np.concatenate([[1.0], -coefficients])
    parts = [lfilter(ahead, [1.0], values[a:b]) for a, b in pairwise(starts.tolist())]
    return np.concatenate(parts)


def _step(force: Array) -> float:
    """The smallest step of a force channel [N]."""
    levels = np.diff(np.unique(force))
    return float(levels.min()) if levels.size else 0.0


def _quiet(problem: Problem) -> npt.NDArray[np.bool_]:
    """(n,) samples in which no model jumps either: away from reversals, duty steps and starts.

    A sign law that is a little wrong misses by something like a jump wherever the motion is slow.
    """
    s, used = problem.block.signals, problem.block.weight > 0
    upper = np.zeros(len(s), dtype=np.bool_)
    upper[s.starts[:-1]] = True
    upper[1:] |= (s.duty[1:] != s.duty[:-1]) | (used[1:] != used[:-1])
    upper[1:] |= s.compressing[1:] != s.compressing[:-1]
    slow = np.abs(s.xdot) < SLOW * float(np.sqrt(np.mean(s.xdot**2)))
    return (np.convolve(upper, np.ones(2 * NEAR + 1), mode="same") < 0.5) & used & ~slow
