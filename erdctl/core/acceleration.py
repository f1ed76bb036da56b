"""The acceleration of a motion from its sampled speed, which has noise."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index

HALF_WINDOW = 0.010  # s, of the straight line whose slope is the acceleration
HALF_CUBIC = 0.020  # s, of the cubic in its place, at most
NOISE_OF_SLOPE = 0.01  # of the acceleration that may be noise in a narrower window
LOST = 1.01  # times as much by a sharper window, from which on the motion is too fast for a cubic


def acceleration(
    t: Array, xdot: Array, starts: Index, *, common: float | None, finest: float, logged: float
) -> Array:
    """(n,) acceleration [m/s^2]: slope of the cubic through xdot within 20 ms each way.

    It averages the noise of xdot a little more than a straight line over 10 ms would, and
    passes what a damper test moves at: of a sine of 7 Hz it loses 0.12 %, where the line loses
    2 %. A stroke that turns within 20 ms has a sixth less in it: the narrowest window is taken
    that differs from it, in half of a record, by less than a hundredth of the acceleration,
    where noise differs all along. Where the motion is so fast all along that a quintic has more
    of it (of a sine of 20 Hz the cubic loses 7 %), `_least_error` chooses. A line stands where
    samples are not even in time, within the window of the ends of a record, and where a step is
    longer than 10 ms: then through the neighbours of a sample. 0 in a record of one sample.
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
    least = max(3, round(3.0 * logged / step))
    sharp = [savgol_coeffs(2 * r + 1, 5, deriv=1, delta=step) for r in _some(least, most)]
    some = sharp + [cubics[r - reaches[0]] for r in _some(reaches[0], most)]
    for a, b in pairwise(starts.tolist()):
        if b - a <= 2 * reaches[-1]:
            continue
        v = xdot[a:b]
        whole = np.convolve(v, cubics[-1], mode="valid")
        noise = NOISE_OF_SLOPE * float(np.sqrt(np.mean(whole**2)))
        for weights in cubics:
            inner = np.convolve(v, weights, mode="valid")
            apart = _common(inner, whole)[0] - whole
            if weights is cubics[-1] or np.median(np.abs(apart)) < noise:
                break
        if len(sharp[0]) < len(v):
            sharper = np.convolve(v, sharp[0], mode="valid")
            inner = _least_error(v, whole, some) if _gain(sharper, inner) > LOST else inner
        r = (len(v) - len(inner)) // 2
        slope[a + r : b - r] = inner
    return slope


def _least_error(v: Array, whole: Array, windows: list[Array]) -> Array:
    """Slopes of v (n,) by the window (k,) of least error, `whole` (m,) being by the usual one.

        e_w = ((g_0 - g_w) |whole|)^2 + |v_w - g_w whole|^2,   g_w = <v_w, whole> / |whole|^2

    over the samples that both have. What a narrower window w has more of the motion is alike in
    both, its gain g_w; what it has more of noise is not: of white noise the slope by the wider
    one is the best estimate, from which that of any other differs by what is uncorrelated with it.
    g_0 : the largest gain
    """
    found = [(1.0, 0.0, whole)]
    for weights in windows:
        if len(weights) < len(v):
            inner = np.convolve(v, weights, mode="valid")
            gain = _gain(inner, whole)
            ours, base = _common(inner, whole)
            found.append((gain, float(np.mean((ours - gain * base) ** 2)), inner))
    most = max(gain for gain, _, _ in found)
    square = float(np.mean(whole**2))
    return min(found, key=lambda f: (most - f[0]) ** 2 * square + f[1])[2]


def _gain(ours: Array, base: Array) -> float:
    """Of some slopes against others, by least squares over the samples that both have."""
    ours, base = _common(ours, base)
    square = float(base @ base)
    return float(ours @ base) / square if square > 0.0 else 1.0


def _common(one: Array, other: Array) -> tuple[Array, Array]:
    """The middle of both (m,), (k,), of so many samples as the shorter has."""
    n = min(len(one), len(other))
    first, second = (len(one) - n) // 2, (len(other) - n) // 2
    return one[first : first + n], other[second : second + n]


def _some(least: int, most: int) -> list[int]:
    """Widths from one to the other, each half as wide again as the one before."""
    out = [least]
    while (more := math.ceil(1.5 * out[-1])) <= most:
        out.append(more)
    return out


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
