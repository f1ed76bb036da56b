"""The levels that a control holds, out of a duty that was read back with noise."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.quantiles import median, percentiles
from erdctl.core.recording import Array, Index

LARGEST = 0.02  # of the duty: beyond that a control moves by itself
SIGMAS = 6.0  # of a difference, from which the control stepped
WINDOWS = (8, 32)  # samples on either side, whose means tell small steps from noise
SHORTEST = 16  # samples of a level, in the mean over a record
WHITE = 0.3  # correlation from sample to sample of what is noise, at most
FEWEST = 40  # samples of a record that can be told
FLICKERS = 0.02  # of the steps from sample to sample, from which a channel is noisy
CUT = 0.02  # of the samples of a level at 0, from which its noise was cut off below
SURE = 5.0  # standard errors from 0, within which such a level is none


@dataclass(frozen=True, eq=False)
class HeldDuty:
    """What of a duty is held, and what is noise.

    duty : (n,) the levels;  noise : rms of the rest, in the records that have one [1]
    before, after : steps of the duty within these as it was read, and of the levels
    """

    duty: Array
    noise: float
    before: int
    after: int


def held_duty(duty: Array, starts: Index) -> HeldDuty | None:
    """The levels of a duty (n,) that is held from step to step and read back with noise.

        u_i = U_k + e_i,   e white, small against a step that a force answers

    None if no record is so. A duty that moves by itself (a ramp, a sine, a closed loop) leaves a
    rest that is no noise, and stays as it is; so does one that is held exactly.

    starts : (r + 1,) offsets of the records

    Check: 0.2 and 0.5, each for 200 samples and read to +- 0.001, make 399 steps as read, and 1.
    >>> u = np.repeat([0.2, 0.5], 200) + 1e-3 * np.random.default_rng(1).standard_normal(400)
    >>> found = held_duty(u, np.array([0, 400]))
    >>> found.before, found.after, [round(level, 3) for level in np.unique(found.duty).tolist()]
    (399, 1, [0.2, 0.5])
    """
    noisy = [
        (slice(a, b), levels)
        for a, b in pairwise(starts.tolist())
        if (levels := _levels(duty[a:b])) is not None
    ]
    if not noisy:
        return None
    squares = sum(float(np.sum((duty[at] - levels) ** 2)) for at, levels in noisy)
    noise = (squares / sum(len(levels) for _, levels in noisy)) ** 0.5
    out, before, after = duty.copy(), 0, 0
    for at, levels in noisy:
        out[at] = levels
        before += int(np.count_nonzero(np.diff(duty[at])))
        after += int(np.count_nonzero(np.diff(out[at])))
    return HeldDuty(out, noise, before, after)


def _levels(duty: Array) -> Array | None:
    """(n,) what a record's duty holds; None if it holds it as it is, or nothing."""
    n = len(duty)
    if n < FEWEST or np.ptp(duty) == 0.0:
        return None
    d = np.diff(duty)
    small = np.abs(d[np.abs(d) < LARGEST])
    if np.count_nonzero(small) < max(FLICKERS * n, 2.0):
        return None
    # Of a normal difference 50, 90 and 99 % are below 0.674, 1.645 and 2.576 deviations; noise that
    # is cut off at 0, or in whole counts of a converter, has many that are none.
    half, most, all_but = percentiles(small, 50.0, 90.0, 99.0)
    noise = max(half / 0.6745, most / 1.6449, all_but / 2.5758) / 2.0**0.5
    noise = noise or float(np.sqrt(0.5 * np.mean(small**2)))
    edges = np.flatnonzero(np.abs(d) > SIGMAS * 2.0**0.5 * noise) + 1
    # A single sample that is off by little is noise as well, and steps there and back.
    across = np.minimum(
        np.abs(duty[np.minimum(edges + 1, n - 1)] - duty[edges - 1]),
        np.abs(duty[edges] - duty[np.maximum(edges - 2, 0)]),
    )
    size = np.abs(d[edges - 1])
    edges = edges[(size >= LARGEST) | (across > 0.5 * size)]
    for window in WINDOWS:
        edges = np.union1d(edges, _small_steps(duty, edges, noise, window))
    if len(edges) * SHORTEST > n:
        return None
    bounds = [0, *edges.tolist(), n]
    levels = [duty[a:b] for a, b in pairwise(bounds)]
    samples = np.diff(bounds)
    rest = duty - np.repeat([float(level.mean()) for level in levels], samples)
    square = float(np.mean(rest**2))
    if not 0.0 < square < LARGEST**2:
        return None
    inner = np.ones(n - 1, dtype=np.bool_)
    inner[edges - 1] = False
    memory = float(np.mean((rest[1:] * rest[:-1])[inner])) / square
    if abs(memory) >= WHITE:
        return None
    return np.repeat([_level(level, square**0.5) for level in levels], samples)


def _level(duty: Array, noise: float) -> float:
    """The mean of samples (n,) of one level, or their median where noise was cut off below.

    The cut moves a mean up to 0.4 of the noise; the median has 1.25 times its error.
    """
    if np.mean(duty == 0.0) < CUT:
        return float(duty.mean())
    middle = median(duty)
    return middle if middle > SURE * 1.25 * noise / len(duty) ** 0.5 else 0.0


def _small_steps(duty: Array, edges: Index, noise: float, window: int) -> Index:
    """(k,) samples before which the mean of the next `window` is another than that of the last.

    edges : samples before which the duty is known to step
    """
    n, w = len(duty), window
    if n < 2 * w:
        return np.zeros(0, dtype=np.intp)
    total = np.concatenate([[0.0], np.cumsum(duty)])
    mean = (total[w:] - total[:-w]) / w
    apart = np.zeros(n)
    apart[w : n - w + 1] = np.abs(mean[w:] - mean[:-w])
    for edge in edges.tolist():  # a known step shows for `window` samples about it
        apart[max(edge - w + 1, 0) : edge + w] = 0.0
    high = np.flatnonzero(apart > SIGMAS * noise * (2.0 / w) ** 0.5)
    if not len(high):
        return high
    # One step shows as a run of such samples, highest where it is.
    runs = np.split(high, np.flatnonzero(np.diff(high) > 1) + 1)
    return np.array([run[np.argmax(apart[run])] for run in runs])
