"""Noise of a deflection, told from what moves."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array

LOOK, PARTS = 80_000, 8  # samples of a record that are looked at for this, and in how many parts
NOISE_ORDER = 6  # of the differences that tell the noise of x
HIGH_ORDER = 10  # of those that do where a motion has few samples a cycle
OF_SIGMA = 0.6745  # of a normal deviation: the median of its size
ROUNDING = 1e-6  # of the stroke, below which steps of x are no digits of a recorder
OF_A_DIGIT = 0.05  # as near as steps of x are to whole numbers of them
SURE = 4.0  # standard errors of a slope that is none
LEAVES = 2.5  # standard deviations of the noise, that x is off a rest once it is left
FEWEST = 5  # samples of half a window, that sees a motion so much too early; and of a line


def looked_at(x: Array) -> Array:
    """(p, m) all of the values (n,), or of a long record evenly spaced parts."""
    if x.size <= LOOK:
        return x[None]
    length = LOOK // PARTS
    first = np.linspace(0, x.size - length, PARTS).astype(int)
    return np.stack([x[a : a + length] for a in first.tolist()])


def variance(x: Array, order: int = NOISE_ORDER) -> float:
    """Variance of white noise in x, by its sixth differences, which no motion of a bench has.

    By their median: a corner of a triangle has some. At least that of a last digit q, q^2 / 12.
    Noise that is not white, as behind a filter, has fewer.
    Check: noise of 3.0, beside a motion that has no sixth differences.
    >>> noise = 3.0 * np.random.default_rng(0).standard_normal(4000)
    >>> round(variance(noise + np.arange(4000.0) ** 2) ** 0.5, 1)
    3.0
    """
    differences = np.abs(np.diff(x, order))
    if not differences.size:
        return 0.0
    gain = math.comb(2 * order, order)  # sum of the squares of their weights
    return max(float(np.median(differences) / OF_SIGMA) ** 2 / gain, digit(x) ** 2 / 12.0)


def variance_at(t: Array, x: Array, order: int = NOISE_ORDER) -> float:
    """The same by divided differences, of x at uneven times t.

        sum_k x_k / prod over j of (t_k - t_j),   j and k of order + 1 samples on end, j not k

    Check: noise of 3.0, with steps of 0.7 to 1.3 beside a motion of the square of t.
    >>> random = np.random.default_rng(0)
    >>> t = np.cumsum(random.uniform(0.7, 1.3, 4000))
    >>> round(variance_at(t, t**2 + 3.0 * random.standard_normal(4000)) ** 0.5)
    3
    """
    count = t.shape[-1] - order
    if count <= 0:
        return 0.0
    of = range(order + 1)
    ats = [t[..., k : k + count] / float(np.median(np.diff(t))) for k in of]
    weights = [1.0 / math.prod(ats[k] - ats[j] for j in of if j != k) for k in of]
    difference = sum(weights[k] * x[..., k : k + count] for k in of)
    size = np.sqrt(sum(w * w for w in weights))
    noise = float(np.median(np.abs(difference / size))) / OF_SIGMA
    return max(noise**2, digit(x) ** 2 / 12.0)


def digit(x: Array) -> float:
    """The digit q of which all values are multiples; 0 of a channel that is finer than its noise.

    >>> digit(np.array([0.0, 0.25, 1.0, 1.5])), digit(np.array([0.0, 0.25, 1.0, 1.6]))
    (0.25, 0.0)
    """
    steps = np.diff(np.unique(x))  # at one speed those from sample to sample are far larger
    steps = steps[steps > ROUNDING * float(np.ptp(x))]
    if not steps.size:
        return 0.0
    q = float(steps.min())
    off = np.abs(steps / q - np.round(steps / q))
    return q if float(np.quantile(off, 0.9)) < OF_A_DIGIT else 0.0


def slope_errors(n: int, width: int, degree: int) -> Array:
    """(n,) standard errors of slopes a sample, times the noise, by polynomials through `width`.

    Those of the middle of a window, and of the rest of the first and the last at the ends.
    Check: a quadratic through five samples, of slope (-2, -1, 0, 1, 2) / 10 in the middle and
    (-54, 13, 40, 27, -26) / 70 at the end: squares of 0.1 and 1.2429.
    >>> (slope_errors(9, 5, 2)[[4, 0]] ** 2).round(4).tolist()
    [0.1, 1.2429]
    """
    half = width // 2
    u = np.arange(-half, half + 1) / half
    of = np.vander(u, degree + 1, increasing=True)
    derived = np.arange(degree + 1) * np.pad(of, ((0, 0), (1, 0)))[:, :-1]
    square = np.sum(derived @ np.linalg.inv(of.T @ of) * derived, axis=1)
    error = np.sqrt(square) / half
    middle = np.full(n - 2 * half, error[half])
    return np.concatenate([error[:half], middle, error[half + 1 :]])


def at_rest(
    x: Array, slope: Array, error: Array, width: int, noise: float
) -> npt.NDArray[np.bool_]:
    """(n,) whether a slope (n,) of x (n,) with standard errors (n,) is that of noise.

    Noise gives a rod at rest a direction, of which the yield force is a fault of as much again.
    Beside a turn a small slope is one still, as it goes on to larger ones of its direction. What
    is slow moves on through a window; and a rest goes on for as long as x does not leave it, where
    a window sees the motion before or after.

    width : samples of a window;  noise : standard deviation in x
    Check: of a turn and a rest, samples 2, 3, 6 and 7; and of a rest of 20 samples beside a ramp,
    of which the window has a slope at three of them, all of them.
    >>> slope = np.array([9.0, 1.0, -1.0, 1.0, -1.0, -9.0, 0.5, -0.5])
    >>> at_rest(np.zeros(8), slope, np.ones(8), 5, 1.0).nonzero()
    (array([2, 3, 6, 7]),)
    >>> k = np.arange(30.0)
    >>> x, slope = np.maximum(k - 19.0, 0.0), np.maximum(k - 16.0, 0.0)
    >>> int(at_rest(x, slope, np.full(30, 0.01), 11, 0.1).sum())
    20
    """
    way = np.sign(slope)
    first = np.concatenate([[0], np.flatnonzero(way[1:] != way[:-1]) + 1])
    most = np.maximum.reduceat(np.abs(slope) - SURE * error, first)
    still = np.repeat(most <= 0.0, np.diff(first, append=len(slope)))
    half = width // 2
    edges = np.flatnonzero(np.diff(still, prepend=False, append=False)).reshape(-1, 2)
    for a, b in edges[edges[:, 1] - edges[:, 0] >= width].tolist():
        inner = x[a + half : b - half]  # the motion before and after is not seen at once
        if len(inner) >= width:
            gone = float(np.mean(inner[-half:]) - np.mean(inner[:half]))
            if abs(gone) > SURE * noise * (2.0 / half) ** 0.5:
                still[a:b] = False
                continue
        if half < FEWEST:
            continue
        level = np.mean(x[a:b])
        before = _stays(np.abs(x[max(a - half, 0) : a][::-1] - level), noise)
        after = _stays(np.abs(x[b : b + half] - level), noise)
        still[a - before : a] = still[b : b + after] = True
    return still


def _stays(away: Array, noise: float) -> int:
    """Samples before x has left a rest: far by one sample, or by two on end, as noise hardly is."""
    left = away > LEAVES * noise
    left[:-1] &= left[1:]
    left |= away > 2.0 * LEAVES * noise
    return int(np.argmax(np.append(left, True)))
