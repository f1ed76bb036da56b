"""Corners of a motion, as of a triangle, told from samples of x that stand out of it."""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array, Index

STRAIGHT = 2.5  # variances a sample, which the two lines leave at most
BETTER = 25.0  # variances, by which they leave less than a cubic polynomial
SHARPER = 25.0  # times what they leave, that the polynomial leaves: a corner without more ado
DEGREE = 3


def beyond_corners(t: Array, x: Array, at: Index, offsets: Index, variance: float) -> Array:
    """(k,) by how much x (n,) at some samples is beyond a corner of the motion [m]; inf where
    there is none.

    A velocity that is derived from x rounds a corner, so that x is beyond what the velocity leads
    to, there and back within a few samples, as a spike is. But what a rod does where its speed
    changes lies between the lines on either side and their chord. A corner is where the two lines
    say what a polynomial does not; a bend that is smooth is none.

    t : (n,) [s];  at : (k,) samples;  offsets : of the surroundings of a corner, as many on either
    side, without those within which it is, as the samples are;  variance : of the noise of x [m^2]
    Check: of |k|, and with a spike of -0.7 at its corner, and two samples beside; k^2 has none.
    >>> k, near = np.arange(-12.0, 13.0), np.array([-6, -5, -4, -3, 3, 4, 5, 6])
    >>> values = abs(k), abs(k) - 0.7 * (k == 0), abs(k) - 0.7 * (k == 2), k**2
    >>> at = np.array([12]), np.array([12]), np.array([14]), np.array([12])
    >>> found = (beyond_corners(k, *both, near, 1e-4) for both in zip(values, at))
    >>> [beyond.round(6).tolist() for beyond in found]
    [[0.0], [0.7], [0.7], [inf]]
    """
    out = np.full(len(at), np.inf)
    within = int(np.abs(offsets).min()) - 1
    for shift in range(-within, within + 1):
        middle = at + shift
        sure = (middle + offsets.min() >= 0) & (middle + offsets.max() < len(x))
        if sure.any():
            beyond = _beyond(t, x, at[sure], middle[sure], offsets, variance)
            out[sure] = np.minimum(out[sure], beyond)
    return out


def _beyond(t: Array, x: Array, at: Index, middle: Index, offsets: Index, variance: float) -> Array:
    """The same for corners near the samples in the middle (k,)."""
    around, half = middle[:, None] + offsets, len(offsets) // 2
    u, y = t[around] - t[at, None], x[around] - x[at, None]
    u /= np.abs(u).max()
    slopes, lines, left = [], [], np.zeros(len(at))
    for a, b in ((u[:, :half], y[:, :half]), (u[:, half:], y[:, half:])):
        apart = a - a.mean(axis=1, keepdims=True)
        slope = np.sum(apart * b, axis=1) / np.sum(apart**2, axis=1)
        line = b.mean(axis=1) - slope * a.mean(axis=1)
        left += np.sum((b - line[:, None] - slope[:, None] * a) ** 2, axis=1)
        slopes.append(slope)
        lines.append(line)  # at the sample, from which u and y count
    u_1, u_2 = u[:, half - 1], u[:, half]
    y_1, y_2 = lines[0] + slopes[0] * u_1, lines[1] + slopes[1] * u_2
    chord = (y_1 * u_2 - y_2 * u_1) / (u_2 - u_1)
    sign = np.sign(slopes[1] - slopes[0])
    sharp = np.maximum(sign * lines[0], sign * lines[1])
    beyond = np.maximum(np.maximum(sharp, -sign * chord), 0.0)
    basis = np.linalg.qr(u[:, :, None] ** np.arange(DEGREE + 1))[0]
    smooth = np.sum(y**2, axis=1) - np.sum(np.einsum("kij,ki->kj", basis, y) ** 2, axis=1)
    straight = STRAIGHT * variance * (len(offsets) - 4)
    # Against what is so much more than noise nobody need know the noise well.
    is_one = left < np.maximum(straight, smooth / SHARPER)
    is_one &= smooth - left > BETTER * variance
    return np.where(is_one, beyond, np.inf)
