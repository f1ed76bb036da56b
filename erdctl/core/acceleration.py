"""The acceleration of a motion from its sampled speed, which has noise."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index

HALF_WINDOW = 0.010  # s, of the straight line whose slope is the acceleration
HALF_CUBIC = 0.020  # s, of the cubic in its place, at most
NOISE_OF_SLOPE = 0.01  # of the acceleration that may be noise in a narrower window


def acceleration(
    t: Array, xdot: Array, starts: Index, *, common: float | None, finest: float, logged: float
) -> Array:
    """(n,) acceleration [m/s^2]: slope of the cubic through xdot within 20 ms each way.

    It averages the noise of xdot a little more than a straight line over 10 ms would, and
    passes what a damper test moves at: of a sine of 7 Hz it loses 0.12 %, where the line loses
    2 %. A stroke that turns within 20 ms has a sixth less in it: the narrowest window is taken
    that differs from it, in half of a record, by less than a hundredth of the acceleration,
    where noise differs all along. A line stands where samples are not even in time, within the
    window of the ends of a record, and where a step is longer than 10 ms: then through the
    neighbours of a sample. 0 in a record of one sample.
    t, xdot : (n,) time [s] and speed [m/s];  starts : (r + 1,) offsets of the records
    common : step of the whole log [s], None where it has several;  finest : where it is dense
    logged : step of the log between whose samples these were made up [s], 0 where none was
    Source: A. Savitzky, M. J. E. Golay, Analytical Chemistry 36 (1964) 1627-1639.
    """
    slope, step = _slope_of_lines(t, xdot, starts, finest), common
    if step is None or round(HALF_CUBIC / step) < 2:
        return slope
    most = round(HALF_CUBIC / step)
    least = max(2, round(2.0 * logged / step))  # a cubic through logged samples
    reaches = range(min(least, most), most + 1)
    from scipy.signal import savgol_coeffs

    cubics = [savgol_coeffs(2 * r + 1, 3, deriv=1, delta=step) for r in reaches]
    for a, b in pairwise(starts.tolist()):
        if b - a <= 2 * reaches[-1]:
            continue
        v, wide = xdot[a:b], reaches[-1]
        whole = np.convolve(v, cubics[-1], mode="valid")
        noise = NOISE_OF_SLOPE * float(np.sqrt(np.mean(whole**2)))
        for r, weights in zip(reaches, cubics, strict=True):
            inner = np.convolve(v, weights, mode="valid")
            apart = inner[wide - r : len(inner) - (wide - r)] - whole
            if r == wide or np.median(np.abs(apart)) < noise:
                slope[a + r : b - r] = inner
                break
    return slope


def _slope_of_lines(t: Array, xdot: Array, starts: Index, finest: float) -> Array:
    """(n,) slope of the straight line through xdot within 10 ms each way [m/s^2]."""
    reach = max(1, round(HALF_WINDOW / finest)) if finest > 0 else 0
    record = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    count = np.ones(len(t))
    su, sv, suu, suv = np.zeros((4, len(t)))
    for k in range(1, min(reach, len(t) - 1) + 1):
        u, v = t[k:] - t[:-k], xdot[k:] - xdot[:-k]
        near = (record[k:] == record[:-k]) & ((u <= 1.5 * HALF_WINDOW) | (k == 1))
        u, v = np.where(near, u, 0.0), np.where(near, v, 0.0)
        # Each pair serves both of its samples: u and v change sign, their products do not.
        for centre, way in ((slice(None, -k), 1.0), (slice(k, None), -1.0)):
            count[centre] += near
            su[centre] += way * u
            sv[centre] += way * v
            suu[centre] += u * u
            suv[centre] += u * v
    spread = count * suu - su * su
    slope: Array = (count * suv - su * sv) / np.where(spread > 0, spread, 1.0)
    return slope
