"""Deflection velocity from deflection, for logs that were recorded without it."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Index

WINDOW = 0.020  # s: passes what a damper test moves at (below 20 Hz), averages sensor noise
FEWEST = 5  # samples of a window; three would let the noise through unfiltered
JITTER = 1e-3  # of the step, and so of xdot: below it the times count as evenly spaced
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
    """Derivative of a local quadratic, record by record.

        xdot_i = a_1,   min over a of  sum_k (a_0 + a_1 u_k + a_2 u_k^2 - x_k)^2,  u_k = t_k - t_i

    over the samples k of a window of about 20 ms, at least 5 samples, centred on sample i (at
    the ends of a record: the first or the last window). Evenly spaced, this is the
    Savitzky-Golay filter; otherwise the same fit is made at the actual times.

    t : (n,) strictly increasing within a record [s];  x : (n,) [m];  starts : (r + 1,) offsets
    file, row_of : for messages; row of a sample
    notes : of the parts of a log before this one, to which it adds its own; None if it is all
    Returns (n,) xdot [m/s] and a note: method, window, and where the response has fallen by 3 dB
    against an ideal differentiator. Exact for x quadratic in t; x = t^2 gives 2 t.
    Raises InputProblem at a pause of more than 10 steps, or for a record of one sample.
    Source: A. Savitzky, M. J. E. Golay, Analytical Chemistry 36 (1964) 1627-1639.
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
        del steps
        xdot[part], note = _record(t[part], x[part], step, even)
        notes[note] = None
    kinds = list(notes)
    more = f"; and {len(kinds) - 3} other windows" if len(kinds) > 3 else ""
    return xdot, "derived from x by " + "; ".join(kinds[:3]) + more


def bandwidth(width: int, step: float) -> float:
    """Frequency at which the derivative has fallen by 3 dB against an ideal differentiator [Hz].

        |H| / omega = sum_k k sin(k theta) / (theta sum_k k^2) = 1 / sqrt(2),  theta = omega step

    with k from 1 to (width - 1) / 2.  width : odd number of samples;  step : [s]
    Check: for a long window u = theta k_max solves 3 (sin u - u cos u) / u^3 = 1/sqrt(2), which
    is u = 1.8148: 1.8148 / (2 pi 10 ms) = 28.9 Hz for 20 ms.
    >>> round(bandwidth(2001, 1e-5), 1)
    28.9
    """
    k = np.arange(1, width // 2 + 1)
    theta = np.linspace(0.0, math.pi, 2049)[1:] * min(1.0, 1.0 / k[-1] * 2.0)
    response = np.sin(np.outer(theta, k)) @ k / (theta * (k @ k))
    fallen = int(np.argmax(response < math.sqrt(0.5)))
    two = slice(fallen - 1, fallen + 1)
    at = np.interp(-math.sqrt(0.5), -response[two], theta[two])
    return float(at) / (2.0 * math.pi * step)


def _record(t: Array, x: Array, step: float, even: bool) -> tuple[Array, str]:
    width = max(2 * round(WINDOW / 2.0 / step) + 1, FEWEST)
    width = min(width, (t.size - 1) // 2 * 2 + 1)
    if width < FEWEST:
        return np.gradient(x, t), "differences of neighbours (fewer than 5 samples in a record)"
    span = f"{width} samples = {1e3 * (width - 1) * step:.3g} ms"
    if not even:
        return _at_actual_times(t, x, width), (
            f"local quadratic fits at the uneven times ({span};"
            f" -3 dB near {bandwidth(width, step):.3g} Hz)"
        )
    from scipy.signal import savgol_filter

    # The mean step: the median of times rounded to a few digits is off by the rounding.
    mean = float(t[-1] - t[0]) / (t.size - 1)
    xdot = savgol_filter(x, width, 2, deriv=1, delta=mean, mode="interp")
    note = f"a Savitzky-Golay filter (quadratic, {span}; -3 dB at {bandwidth(width, step):.3g} Hz)"
    return xdot, note


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
