"""What a channel was between the samples at which it is read, where each is held until the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.rig.pieces import resolution
from erdctl.core.recording import Array, Index, Recording

LEAST = 20  # runs of equal samples between changes of more than a digit
DIGITS = 1.5  # more than a channel changes by at a time in a slow motion
ONCE = 0.5  # of these runs, that must be those between two of its own samples
ALIKE = 0.9  # of all runs, that must be of such lengths or of multiples
SHORTER = 0.05  # of all runs, that may be shorter
EXACT = 0.95  # of the runs, that must have the same length, for others not to have one more
UNEVEN = 4  # samples of a run, for each of which its length may be one more


def hold(values: Array) -> float:
    """Samples over which a channel (n,) holds each of its values; 1 if it does not.

    A digit that is coarse for a slow motion repeats, too: for long where that is slow, for a short
    time where it is fast, and then goes on by one digit. So the length of a run is told from those
    that begin and end with a change of more than that. What holds has them of the length k, or of k
    and k + 1 where the rates are no multiples; all others, of slow motions too, are multiples of
    that, and hardly any is shorter. A channel that has more than half of the log's rate has single
    samples, too, as noise of a digit has, and is not told.

    Check: of a sine each third sample is held: 3, and 1 of all samples; a sine in 40 digits over
    6000 samples repeats, too.
    >>> sine = np.sin(0.05 * np.arange(600))
    >>> hold(sine[np.arange(600) // 3 * 3]), hold(sine)
    (3.0, 1.0)
    >>> hold(np.round(20.0 * np.sin(0.005 * np.arange(6000))))
    1.0
    """
    at = np.flatnonzero(np.diff(values)) + 1
    length = np.diff(at)
    if len(length) < LEAST or 2 * len(at) > (1.0 + SHORTER) * len(values):
        return 1.0
    change = np.abs(values[at] - values[at - 1]) > DIGITS * resolution(values)
    counts = np.bincount(length[change[1:] & change[:-1]], minlength=2)
    if counts.sum() < LEAST:
        return 1.0
    longest = np.arange(len(counts)) + np.maximum(np.arange(len(counts)) // UNEVEN, 1)
    up_to = np.append(0, np.cumsum(counts))
    once = up_to[np.minimum(longest, len(counts) - 1) + 1] - up_to[:-1]
    k = int(once[1:].argmax()) + 1
    while counts[k] <= (1.0 - EXACT) * once[k]:
        k += 1
    most = k if counts[k] >= EXACT * once[k] else int(longest[k])
    times = length // k
    alike = (times > 0) & (length <= times * most)
    if k == 1 or once[k] < max(LEAST, ONCE * counts.sum()):
        return 1.0
    if np.mean(alike) < ALIKE or np.mean(length < k) > SHORTER:
        return 1.0
    return float(length[(length >= k) & (length <= most)].mean())


def read_at(values: Array, held: float) -> Index:
    """(m,) samples of (n,) at which a channel is read that holds each value for `held` of them.

    Where it has the same value over several of these times, it was read in between as well, as
    also before its first change and behind its last.

    Check: 1 1 2 2 2 2 3 3, each held for 2 samples, is read at samples 0, 2, 4 and 6.
    >>> read_at(np.array([1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0]), 2.0).tolist()
    [0, 2, 4, 6]
    """
    at = np.flatnonzero(np.diff(values)) + 1
    before = at[0] - held * np.arange(int(at[0] / held + 0.5), 0, -1)
    behind = at[-1] + held * np.arange(1, int((len(values) - at[-1]) / held + 0.5))
    length = np.diff(at)
    times = np.maximum(np.rint(length / held).astype(np.intp), 1)
    part = np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times)
    inner = np.repeat(at[:-1], times) + part * np.repeat(length / times, times)
    all_of = np.rint(np.concatenate([before, inner, at[-1:], behind])).astype(np.intp)
    return np.unique(np.clip(all_of, 0, len(values) - 1))


def derives(note: str, xdot: Array) -> bool:
    """Whether a velocity (n,) is to be derived from x anew; note : how it was obtained."""
    return note != "measured" or hold(xdot) > 1.0


def between(recording: Recording) -> Recording:
    """The recording with x, where it is held, as it goes from one of its own samples to the next.

    Slopes there are those of xdot if that is measured and not held; if not, xdot is derived from
    these samples alone, and is a spline through what that gives. Each two samples of x are joined
    by the cubic that has their values and slopes.
    """
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    r = recording
    x, xdot, notes, derived = r.x.copy(), r.xdot.copy(), dict[str, None](), 0
    for part in r.slices:
        held = hold(r.x[part])
        if held == 1.0:
            continue
        at, t = read_at(r.x[part], held), r.t[part]
        slopes = r.xdot[part][at]
        if derives(r.xdot_note, r.xdot[part]):
            starts = np.array([0, len(at)], dtype=np.intp)
            slopes, note = derive_xdot(t[at], r.x[part][at], starts, notes=notes)
            xdot[part] = CubicSpline(t[at], slopes)(t)
            derived += 1
        x[part] = CubicHermiteSpline(t[at], r.x[part][at], slopes)(t)
    if not derived:
        return replace(r, x=x) if (x != r.x).any() else r
    note += ", of the samples at which x is read"
    if derived < len(r.slices):
        note += f"; in other records {r.xdot_note}"
    return replace(r, x=x, xdot=xdot, xdot_note=note)
