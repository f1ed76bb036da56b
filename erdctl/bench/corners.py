"""Slopes of a motion with corners, of which a window of the derivation makes bends."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from erdctl.bench.deflection_noise import FEWEST, OF_SIGMA, SURE
from erdctl.core.recording import Array, Index

LENGTHS = (4, 2, 1)  # of the lines beside a corner, in half windows; the longest that are straight
BETTER = 25.0  # variances of the noise, by which two lines leave less than a quartic polynomial
STRAIGHT = 2.5  # variances a sample, which they leave themselves at most
AT_THE_CORNER = 2.0  # standard deviations of what noise leaves beside the corner itself
STEADY = 1.6  # times the change of a slope over a length, over twice as much: 2 if it is steady
BENT = 4.0  # variances a sample, that a window leaves beside its polynomial where it is too wide
NARROWEST = 5  # samples
FINEST = 1e-6  # of the stroke: what is taken for noise of a deflection without any


def at_corners(
    x: Array, slope: Array, smooth: Array, width: int, square: float
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Slopes (n,) of x (n,) a sample, in which corners are no bends.

    A window across the turn of a triangle rounds it: for half its width the speed lies between
    those of its two sides, and near the turn the direction is late or early. Where two lines say
    what a polynomial of their length does not, half a window on each side has the slope of its
    line. Elsewhere, where a window does not hold what it is given, a narrower one is taken.

    slope, smooth : (n,) of the polynomials through windows of `width` samples
    square : variance of the noise in x
    Returns the slopes, and which of them are those of lines (n,).

    Check: |k|, whose corner a window makes slopes of k / 8 of, has those of -1 and 1 on its sides.
    >>> k = np.arange(-40.0, 41.0)
    >>> bend = np.clip(k / 8, -1.0, 1.0)
    >>> found, near = at_corners(np.abs(k), bend, np.maximum(np.abs(k), 4.0), 17, 1e-6)
    >>> found[[38, 42]].round(6).tolist()
    [-1.0, 1.0]
    """
    m = width // 2 + 1
    near = np.zeros(len(x), dtype=np.bool_)
    if m < FEWEST or len(x) < 4 * width:
        return slope, near
    # Noise behind a filter leaves more beside a polynomial than its differences tell.
    left = (float(np.median(np.abs(x - smooth))) / OF_SIGMA) ** 2
    square = max(square, left, (FINEST * float(np.ptp(x))) ** 2)
    out = _narrowed(x, slope, smooth, width, square)
    changes = _changes(slope, m, square)
    for length in LENGTHS:
        reach = length * m
        at = changes[(changes >= reach) & (changes < len(x) - reach) & ~near[changes]]
        for last, before, after in _corners(x, at, reach, m, square):
            sides = (
                (slice(max(last + 1 - m, 0), last + 1), before),
                (slice(last + 1, last + 1 + m), after),
            )
            for side, of_line in sides:
                out[side], near[side] = of_line, True
    return out, near


def _narrowed(x: Array, slope: Array, smooth: Array, width: int, square: float) -> Array:
    """Slopes (n,) by windows of half the width, and of half of that, where x asks for it."""
    from scipy.ndimage import uniform_filter1d
    from scipy.signal import savgol_filter

    out = slope.copy()
    bent = np.ones(len(x), dtype=np.bool_)
    while True:
        bent &= uniform_filter1d((x - smooth) ** 2, width, mode="nearest") > BENT * square
        width = width // 4 * 2 + 1
        if width < NARROWEST or not bent.any():
            return out
        out[bent] = savgol_filter(x, width, 2, deriv=1)[bent]
        smooth = savgol_filter(x, width, 2)


def _changes(slope: Array, m: int, square: float) -> Index:
    """Samples at which the slope (n,) may jump: it changes by most, of all within m of them.

    By far more than noise does, and as of twice the length by no more, as a steady one would.
    """
    from scipy.ndimage import maximum_filter1d

    change = np.abs(slope[2 * m :] - slope[: -2 * m])
    longer = np.abs(np.roll(slope, -2 * m) - np.roll(slope, 2 * m))[m:-m]
    error = np.sqrt(2.0 * square * 12.0 / (2.0 * m) ** 3)
    most = change == maximum_filter1d(change, 2 * m + 1)
    most &= (change > SURE * error) & (longer < STEADY * change)
    return np.asarray(np.flatnonzero(most) + m)


def _corners(
    x: Array, at: Index, reach: int, m: int, square: float
) -> list[tuple[int, float, float]]:
    """Last sample before a corner and the slopes of its sides, for those `at` (p,) that are one."""
    if not at.size:
        return []
    k = np.arange(2 * reach + 1)
    window = x[at[:, None] - reach + k]
    window = window - window.mean(axis=1, keepdims=True)
    split = _split(window, m)
    before, after = k <= split[:, None], k > split[:, None]
    lines, (falls, rises) = np.zeros_like(window), (np.zeros(len(at)), np.zeros(len(at)))
    for side, slopes in ((before, falls), (after, rises)):
        count = side.sum(axis=1, keepdims=True)
        apart = np.where(side, k - (side @ k)[:, None] / count, 0.0)
        square_apart = np.sum(apart**2, axis=1)
        slopes[:] = np.sum(apart * window, axis=1) / square_apart
        # Of noise alone a line has a slope as well, and a rod at rest would get a direction of it.
        slopes[np.abs(slopes) < SURE * np.sqrt(square / square_apart)] = 0.0
        mean = np.sum(side * window, axis=1, keepdims=True) / count
        lines += np.where(side, mean + slopes[:, None] * apart, 0.0)
    rest = (window - lines) ** 2
    basis = np.linalg.qr(np.vander(np.linspace(-1.0, 1.0, len(k)), 5))[0]
    bent = np.sum(window**2, axis=1) - np.sum((window @ basis) ** 2, axis=1)
    beside = max(2, m // 2)
    corner = np.abs(k - split[:, None] - 0.5) < beside
    at_it = np.sum(rest * corner, axis=1) / corner.sum(axis=1)
    total = rest.sum(axis=1)
    is_one = (
        (total < STRAIGHT * square * (len(k) - 4))
        & (bent - total > BETTER * square)
        & (at_it < (1.0 + AT_THE_CORNER / np.sqrt(beside)) * square)
    )
    return [
        (int(at[i] - reach + split[i]), float(falls[i]), float(rises[i]))
        for i in np.flatnonzero(is_one).tolist()
    ]


def _split(window: Array, m: int) -> Index:
    """(p,) last sample of the first of two lines that leave least of windows (p, w).

    Within m of the middle.
    """
    k: Array = np.arange(window.shape[1], dtype=float)
    sums = [np.cumsum(part, axis=-1) for part in (k, k * k, window, window * k, window**2)]
    s = np.arange(len(k) // 2 - m, len(k) // 2 + m + 1)
    s = s[(s >= FEWEST - 2) & (s < len(k) - FEWEST + 1)]
    n: Array = np.asarray(s + 1, dtype=np.float64)
    before = [part[..., s] for part in sums]
    after = [part[..., -1:] - part[..., s] for part in sums]
    rest = _left(n, *before) + _left(len(k) - n, *after)
    return np.asarray(s[rest.argmin(axis=1)])


def _left(n: Array, k: Array, kk: Array, y: Array, ky: Array, yy: Array) -> Array:
    """Sum of squares that lines leave, by the sums of their samples."""
    rest: Array = yy - y * y / n - (n * ky - k * y) ** 2 / (n * (n * kk - k * k))
    return rest
