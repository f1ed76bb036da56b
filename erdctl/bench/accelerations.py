"""Accelerations of a log that a spring and a damper would not take up."""

from __future__ import annotations

import math

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.stretches import Stretch

PIECE = 50_000  # samples of a stretch over which accelerations are taken
ACCELERATION_SAMPLES = 1_000_000  # stretches of a longer log stand for the whole
SHARE = 0.05  # of the acceleration; less that no spring makes is what the slope leaves of a sine


class Accelerations:
    """Sums of them over one stretch of a log after the other.

    starts : offsets of its records
    """

    def __init__(self, starts: Index) -> None:
        self._every = -(-int(starts[-1]) // ACCELERATION_SAMPLES)
        self._pieces = self._samples = 0
        self._normal = np.zeros((7, 7))

    def add(self, stretch: Stretch) -> None:
        """The next stretch."""
        r = stretch.own
        for part in r.slices:
            for a in range(part.start, part.stop, PIECE):
                if self._pieces % self._every == 0:
                    b = min(a + PIECE, part.stop)
                    rows = _against_acceleration(r.t[a:b], r.x[a:b], r.xdot[a:b])
                    if rows is not None:
                        self._normal += rows @ rows.T
                        self._samples += rows.shape[1]
                self._pieces += 1

    def beyond_a_spring(self) -> float:
        """Effective value of what is no multiple of deflection or speed, see `Survey` [m/s^2]."""
        normal = self._normal
        if not self._samples or normal[6, 6] == 0.0:
            return 0.0
        known = np.flatnonzero(np.diag(normal)[:6] > 0)
        scale = np.sqrt(np.diag(normal)[known])
        cross = normal[known, 6] / scale
        gram = normal[np.ix_(known, known)] / np.outer(scale, scale)
        left = normal[6, 6] - float(cross @ np.linalg.lstsq(gram, cross, rcond=1e-10)[0])
        if left < SHARE**2 * normal[6, 6]:
            return 0.0
        return float(np.sqrt(left / self._samples))


def _against_acceleration(t: Array, x: Array, xdot: Array) -> Array | None:
    """(7, m) x, xdot and 1 in either direction, and the acceleration; None if too short for it.

    The acceleration is the mean velocity of a twelfth of a period ahead less that of one behind,
    over the time between: it follows the motion (3 % low at its own frequency), and averages the
    noise of xdot over as long as the motion allows.
    """
    swing, speed = float(x.std()), float(xdot.std())
    if len(x) < 8 or swing == 0.0 or speed == 0.0:
        return None
    step = float(t[-1] - t[0]) / (len(t) - 1)
    reach = max(1, round(2.0 * math.pi * swing / speed / 12.0 / step))
    if len(x) < 4 * reach:
        return None
    sums = [np.concatenate([[0.0], np.cumsum(c)]) for c in (t - t[0], xdot)]
    n = len(x) - 2 * reach
    ahead, behind = (
        [(c[i + reach : i + reach + n] - c[i : i + n]) / reach for c in sums]
        for i in (reach + 1, 0)
    )
    span = ahead[0] - behind[0]
    # Windows that hold a gap of the sampling say nothing of the acceleration.
    use = span < 2.0 * (reach + 1) * step
    inside = slice(reach, reach + n)
    x, xdot = x[inside], xdot[inside]
    up = xdot > 0
    ones = np.ones(n)
    rows = np.array([c * way for c in (x, xdot, ones) for way in (up, ~up)])
    return np.vstack([rows, (ahead[1] - behind[1]) / span])[:, use]
