"""Deflection velocity from deflection, for logs that were recorded without it."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from erdctl.bench.corners import at_corners
from erdctl.bench.deflection_noise import (
    HIGH_ORDER,
    NOISE_ORDER,
    at_rest,
    digit,
    looked_at,
    slope_errors,
    variance,
    variance_at,
)
from erdctl.core.errors import InputProblem
from erdctl.core.messages import duration
from erdctl.core.recording import DERIVED, Array, Index

WINDOW = 0.020  # s: passes what a damper test moves at (below 20 Hz), averages sensor noise
WIDEST = 8.0  # times that, where the noise of x asks for it
STEP = math.sqrt(2.0)  # from a width to the next
WORTH = 0.5  # of the mean square error of the velocity: what another window must leave at most
DEGREES = {2: "quadratic", 4: "quartic"}
FEWEST = 5  # samples of a window; three would let the noise through unfiltered
JITTER = 1e-3  # of the step, and so of xdot: below it the times count as evenly spaced
CLOCK_DIGITS = 9  # of seconds, in which steps of a rounded clock are alike
OF_A_STEP = 0.75  # of a step, which the last digit is below: else a lost sample would be rounding
NOTHING = 1e-12  # of x, below which what it changes by in a step is rounding
GAP = 10.0  # steps; across a longer pause there is no local polynomial


def derive_xdot(
    t: Array,
    x: Array,
    starts: Index,
    *,
    file: str | None = None,
    row_of: Callable[[int], int] = lambda sample: sample + 1,
    notes: dict[str, None] | None = None,
) -> tuple[Array, str]:
    """Derivative of a local quadratic, or quartic, record by record.

        xdot_i = a_1,   min over a of  sum_k (a_0 + a_1 u_k + a_2 u_k^2 - x_k)^2,  u_k = t_k - t_i

    over the samples k of a window of about 20 ms, at least 5 samples, centred on sample i (at
    the ends of a record: the first or the last window). Evenly spaced, this is the
    Savitzky-Golay filter; where x is noisy the window is wider, up to 160 ms, and where it moves
    fast the polynomial of degree 4, as long as that halves the error (`_window`); and next to a
    corner of the motion it is the line of either side (`at_corners`). Otherwise the quadratic is
    fitted at the actual times. Where a slope is that of noise, xdot is 0 (`at_rest`).

    t : (n,) strictly increasing within a record [s];  x : (n,) [m];  starts : (r + 1,) offsets
    file, row_of : for messages; row of a sample
    notes : of the parts of a log before this one, to which it adds its own; None if it is all
    Returns (n,) xdot [m/s] and a note: method, window, and where the response has fallen by 3 dB
    against an ideal differentiator. Exact for x quadratic in t; x = t^2 gives 2 t.
    Raises InputProblem at a pause of more than 10 steps, or for a record of one sample.
    Source: A. Savitzky, M. J. E. Golay, Analytical Chemistry 36 (1964) 1627-1639; O. V. Lepskii,
    Theory of Probability and Its Applications 35 (1990) 454-466 (widths by differences of fits).
    """
    xdot = np.empty_like(x)
    notes = {} if notes is None else notes
    for first, end in pairwise(starts.tolist()):
        part = slice(first, end)
        steps = np.diff(t[part])
        if not steps.size:
            raise InputProblem(
                "a record of one sample has no velocity; remove it", file=file, row=row_of(first)
            )
        step = float(np.median(steps))
        if steps.max() > GAP * step:
            at = int(steps.argmax())
            raise InputProblem(
                f"t pauses for {steps[at]:.4g} s where its step is {step:.4g} s, and xdot cannot"
                " be derived across it; give a column xdot, or begin a new record here",
                file=file,
                row=row_of(first + at + 1),
                column="t",
            )
        even = bool(max(steps.max() - step, step - steps.min()) <= JITTER * step)
        even = even or _rounded(t[part], steps)
        del steps
        slope, note = _record(t[part], x[part], step, even)
        # A rod at rest has no direction; rounding, as noise, would give it one at random.
        xdot[part] = np.where(np.abs(slope) * step > NOTHING * np.abs(x[part]).max(), slope, 0.0)
        notes[note] = None
    kinds = list(notes)
    more = f"; and {len(kinds) - 3} other windows" if len(kinds) > 3 else ""
    return xdot, f"{DERIVED} by " + "; ".join(kinds[:3]) + more


def bandwidth(width: int, step: float, degree: int = 2) -> float:
    """Frequency at which the derivative has fallen by 3 dB against an ideal differentiator [Hz].

        |H| / omega = 2 sum_k a_k sin(k theta) / theta = 1 / sqrt(2),  theta = omega step

    with the weights a_k of the slope, k from 1 to (width - 1) / 2; of degree 2 k / (2 sum k^2).
    width : odd number of samples;  step : [s]
    Check: for a long window u = theta k_max solves 3 (sin u - u cos u) / u^3 = 1/sqrt(2), which
    is u = 1.8148: 1.8148 / (2 pi 10 ms) = 28.9 Hz for 20 ms.
    >>> round(bandwidth(2001, 1e-5), 1)
    28.9
    """
    from scipy.signal import savgol_coeffs

    k = np.arange(1, width // 2 + 1)
    weights = savgol_coeffs(width, degree, deriv=1, use="dot")[width // 2 + 1 :]
    theta = np.linspace(0.0, math.pi, 2049)[1:] * min(1.0, degree / k[-1])
    response = 2.0 * np.sin(np.outer(theta, k)) @ weights / theta
    fallen = int(np.argmax(response < math.sqrt(0.5)))
    two = slice(fallen - 1, fallen + 1)
    at = np.interp(-math.sqrt(0.5), -response[two], theta[two])
    return float(at) / (2.0 * math.pi * step)


def _record(t: Array, x: Array, step: float, even: bool) -> tuple[Array, str]:
    most = (t.size - 1) // 2 * 2 + 1
    width = min(max(2 * round(WINDOW / 2.0 / step) + 1, FEWEST), most)
    if width < FEWEST:
        return np.gradient(x, t), "differences of neighbours (fewer than 5 samples in a record)"
    width, degree = _window(x, width, most) if even else (width, 2)
    looked = looked_at(x)
    # What of a motion of few samples a cycle is in differences falls with their order.
    orders = (NOISE_ORDER, HIGH_ORDER)
    square = min(
        variance(looked, order) if even else variance_at(looked_at(t), looked, order)
        for order in orders
    )
    noise = square**0.5
    error = noise * slope_errors(x.size, width, degree)
    span = f"{width} samples = {duration((width - 1) * step)}"
    fallen = f"{bandwidth(width, step, degree):.3g} Hz"
    if not even:
        note = f"local quadratic fits at the uneven times ({span}; -3 dB near {fallen})"
        slope = _at_actual_times(t, x, width)
        return np.where(at_rest(x, slope * step, error, width, noise), 0.0, slope), note
    from scipy.signal import savgol_filter

    # The mean step: the median of times rounded to a few digits is off by the rounding.
    mean = float(t[-1] - t[0]) / (t.size - 1)
    slope = savgol_filter(x, width, degree, deriv=1, mode="interp")
    smooth = savgol_filter(x, width, degree, mode="interp")
    slope, lines = at_corners(x, slope, smooth, width, square)
    slope[at_rest(x, slope, error, width, noise) & ~lines] = 0.0
    note = f"a Savitzky-Golay filter ({DEGREES[degree]}, {span}; -3 dB at {fallen})"
    return slope / mean, note + ", next to corners the line of either side" * bool(lines.any())


def _rounded(t: Array, steps: Array) -> bool:
    """Whether times (n,) are those of an even clock, rounded to a last digit q when logged.

    Check: every 3.333 ms, in whole ms; and with one sample 2 ms late.
    >>> t = np.round(np.arange(100) / 0.3) * 1e-3
    >>> late = np.where(np.arange(100) == 50, t + 0.002, t)
    >>> [_rounded(clock, np.diff(clock)) for clock in (t, late)]
    [True, False]
    """
    q = digit(np.unique(np.round(steps, CLOCK_DIGITS)))
    even = np.linspace(t[0], t[-1], t.size)
    fine = 0.0 < q < OF_A_STEP * float(even[1] - even[0])
    return fine and float(np.abs(t - even).max()) <= q


def _window(x: Array, least: int, most: int) -> tuple[int, int]:
    """Samples of the window, and the degree of the polynomial, that leave the least error.

    Of each degree the window is wider by steps while each halves the mean square error e_w of the
    slope; a higher degree is taken where it halves it, too.

        e_w = s^2 |a_w|^2 + b_w^2,   b_w ~ w^degree
        mean (v_w - v_n)^2 = s^2 |a_w - a_n|^2 + (b_w - b_n)^2

    v_w, a_w, b_w : slopes by a window w, its weights and its bias, n being the next narrower one
    Check: noise alone wants the widest quadratic, of degree 2 and 35 samples; a motion alone the
    narrowest quartic, of degree 4 and 5 samples.
    >>> noise = np.random.default_rng(0).standard_normal(4000)
    >>> _window(noise, 5, 999), _window(np.sin(0.1 * np.arange(4000)), 5, 999)
    ((35, 2), (5, 4))
    """
    looked = looked_at(x)
    square, most = variance(looked), min(most, looked.shape[-1])
    found = [(*_widened(looked, least, most, degree, square), degree) for degree in DEGREES]
    error, width, degree = found[0]
    for other in found[1:]:
        if other[0] < WORTH * error:
            error, width, degree = other
    return width, degree


def _widened(x: Array, least: int, most: int, degree: int, square: float) -> tuple[float, int]:
    """Mean square error of the slope per step, and the window; see `_window`.

    x : (p, m) parts of a record, each filtered by itself
    """
    from scipy.signal import savgol_coeffs, savgol_filter

    width, slopes = least, savgol_filter(x, least, degree, deriv=1)
    weights = savgol_coeffs(least, degree, deriv=1)
    error = square * float(weights @ weights)
    while True:
        wider = 2 * math.ceil(0.5 * STEP * (width - 1)) + 1
        if wider > min(most, WIDEST * least):
            return error, width
        more, own = savgol_filter(x, wider, degree, deriv=1), savgol_coeffs(wider, degree, deriv=1)
        change = own - np.pad(weights, (wider - width) // 2)
        bent = max(float(np.mean((more - slopes) ** 2)) - square * float(change @ change), 0.0)
        growth = ((wider - 1) / (width - 1)) ** degree
        bias = bent / (growth - 1.0) ** 2
        error = square * float(weights @ weights) + bias
        after = square * float(own @ own) + growth**2 * bias
        if after >= WORTH * error:
            return error, width
        width, slopes, weights, error = wider, more, own, after


def _at_actual_times(t: Array, x: Array, width: int) -> Array:
    """Slope at every sample of the quadratic fitted to the window around it; see `derive_xdot`."""
    n, half = t.size, width // 2
    out = np.empty_like(x)
    times = np.lib.stride_tricks.sliding_window_view(t, width)
    values = np.lib.stride_tricks.sliding_window_view(x, width)
    block = max(1, 2**19 // width)
    for begin in range(0, n, block):
        centre = np.arange(begin, min(begin + block, n))
        window = np.clip(centre - half, 0, n - width)
        u = times[window] - t[centre, None]
        scale = np.abs(u).max()  # powers of u stay near 1
        u /= scale
        y = values[window] - x[centre, None]
        uu = u * u
        s0, s1, s2 = float(width), u.sum(1), uu.sum(1)
        s3, s4 = np.einsum("ij,ij->i", uu, u), np.einsum("ij,ij->i", uu, uu)
        y0, y1, y2 = y.sum(1), np.einsum("ij,ij->i", u, y), np.einsum("ij,ij->i", uu, y)
        # Second row of the inverse of the normal equations (Cramer's rule)
        a, b, c = s2 * s3 - s1 * s4, s0 * s4 - s2 * s2, s1 * s2 - s0 * s3
        determinant = s0 * (s2 * s4 - s3 * s3) + s1 * a + s2 * (s1 * s3 - s2 * s2)
        out[centre] = (a * y0 + b * y1 + c * y2) / (determinant * scale)
    return out
