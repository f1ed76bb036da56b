"""Slopes next to a corner of a motion, from the side on which it is straight."""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array

BENT = 9.0  # times the variance of the noise, that a window leaves beside its polynomial
STRAIGHT = 3.0  # the same of a line on one side, at most
SURE = 4.0  # standard errors of a slope that is none
FEWEST = 5  # samples on one side


def at_corners(
    x: Array, slope: Array, smooth: Array, width: int, square: float
) -> tuple[Array, bool]:
    """Slopes (n,) of x (n,) a sample, those of a line on one side where a window has a corner.

    A window across the turn of a triangle rounds it: for half its width the speed lies between
    those of its two sides, and near the turn the direction is late or early.

    slope, smooth : (n,) of the polynomials through windows of `width` samples
    square : variance of the noise in x
    Returns the slopes, and whether any is another.

    Check: |k|, whose corner a window makes slopes of k / 8 of, has those of -1 and 1 on its sides.
    >>> k = np.arange(-20.0, 21.0)
    >>> found, changed = at_corners(np.abs(k), k / 8, np.maximum(np.abs(k), 4.0), 17, 1e-6)
    >>> changed, found[[18, 22]].round(6).tolist()
    (True, [-1.0, 1.0])
    """
    m = width // 2 + 1
    if m < FEWEST or len(x) < 2 * width or square <= 0.0:
        return slope, False
    from scipy.ndimage import uniform_filter1d

    bent = uniform_filter1d((x - smooth) ** 2, 2 * m - 1, mode="constant") > BENT * square
    if not bent.any():
        return slope, False
    line, rest = _lines(x - x.mean(), m)
    # Of the line that begins at a sample, and of the one that ends there.
    none = np.full(m - 1, np.inf)
    after, before = np.concatenate([rest, none]), np.concatenate([none, rest])
    ahead, behind = np.concatenate([line, none]), np.concatenate([none, line])
    straight = bent & (np.minimum(after, before) < STRAIGHT * square)
    one_sided = np.where(after < before, ahead, behind)
    # Of noise alone a line has a slope as well, and a rod at rest would get a direction from it.
    error = (square * 12.0 / (m**3 - m)) ** 0.5
    one_sided[np.abs(one_sided) < SURE * error] = 0.0
    return np.where(straight, one_sided, slope), bool(straight.any())


def _lines(x: Array, m: int) -> tuple[Array, Array]:
    """Slope a sample, and mean square rest, of the line through every m samples on end."""
    k = np.arange(m) - (m - 1) / 2.0
    slopes = np.correlate(x, k, "valid") / float(k @ k)
    mean = np.correlate(x, np.ones(m), "valid") / m
    total = np.correlate(x**2, np.ones(m), "valid") - m * mean**2
    return slopes, np.maximum(total - slopes**2 * float(k @ k), 0.0) / (m - 2)
