"""Recurrences that several physical models share.

NumPy only: `simulate` and `validate` start thousands of times in batch scripts, and importing
scipy.signal or a compiler costs several times what these functions take on a whole log.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index

# exp(LIMIT) stays far from overflow, so a segment may decay by that much before a restart.
LIMIT = 300.0
# Above this decay a step, segments would be so short that doubling costs less.
FAST = 0.5
GONE = 1e-30  # of a decay: lost in any sum, and kept out of slow denormal numbers


def first_order(exponent: Array | float, source: Array, initial: Array, starts: Index) -> Array:
    """Linear first-order recurrence with its own decay at every step.

        y[s] = initial at the first sample s of a record;  y[i+1] = exp(-e[i]) y[i] + source[i]

    exponent : (n,) or one number, e >= 0 [1], the step divided by the time constant
    source : (n,) [unit of y], the last value of each record is not used
    initial : (r,) first value of each record;  starts : (r + 1,) offsets of the records
    Returns (n,).

    With E the running sum of e, y[i] = exp(-E[i]) (y[s] + sum source[j] exp(E[j+1])): a cumulative
    sum, restarted before exp(E) grows too large. The latest terms dominate each sum, so rounding
    stays at machine precision.

    Check: e = ln 2, source = 1, y[0] = 0 gives 0, 1, 1.5, 1.75.
    >>> starts = np.array([0, 4])
    >>> first_order(np.log(2.0), np.ones(4), np.zeros(1), starts).round(9).tolist()
    [0.0, 1.0, 1.5, 1.75]
    """
    out = np.empty_like(source)
    for record, (a, b) in enumerate(pairwise(starts.tolist())):
        out[a] = initial[record]
        if isinstance(exponent, float):
            if exponent < FAST:
                _uniform(exponent, source[a:b], out[a:b])
            else:
                _doubling(np.full(b - a, exponent), source[a:b], out[a:b])
        elif b - a > 1 and exponent[a : b - 1].mean() >= FAST:
            _doubling(exponent[a:b], source[a:b], out[a:b])
        else:
            _varying(exponent[a:b], source[a:b], out[a:b])
    return out


def follow(
    target: Array,
    exponent: Array | float,
    turns: Index,
    before: Array,
    after: Array,
    initial: Array,
    starts: Index,
) -> Array:
    """What follows a target that is a straight line between samples, but jumps in some steps.

        dy/ds + y = target,   s time over a time constant, or travel over a distance

    target : (n,);  exponent : (n,) or one number, the step in s;  initial, starts : as above
    turns : (k,) samples before the steps in which the target jumps, before, after : (k,) parts of
    the exponent on either side of the jump
    Returns (n,), exact.
    Check: target -1, 1, 1, steps of 2 in s, the jump in the middle of the first, y[0] = -1:
    y = -1 + 2 (1 - exp(-1)) = 0.2642 as that step ends.
    >>> target, one = np.array([-1.0, 1.0, 1.0]), np.ones(1)
    >>> y = follow(target, 2.0, np.array([0]), one, one, -one, np.array([0, 3]))
    >>> y[:2].round(4).tolist()
    [-1.0, 0.2642]
    """
    e = np.maximum(exponent, 1e-300)  # the step at the end of a record is 0, and not used
    gone = -np.expm1(-e)
    new = 1.0 - gone / e
    of_old, of_new = np.broadcast_to(gone - new, target.shape), np.broadcast_to(new, target.shape)
    source = np.zeros_like(target)
    source[:-1] = of_old[:-1] * target[:-1] + of_new[:-1] * target[1:]
    first = -np.expm1(-before) * np.exp(-after) * target[turns]
    source[turns] = first - np.expm1(-after) * target[turns + 1]
    return first_order(exponent, source, initial, starts)


def _uniform(e: float, source: Array, out: Array) -> None:
    """Fill out[1:] where every step decays alike: one table of powers serves all segments."""
    n = len(out)
    length = min(n, 4096, int(LIMIT / e) if e > 0 else n)
    growth = np.exp(e * np.arange(1, length + 1))
    decay = np.exp(-e * np.arange(1, length + 1))
    work = np.empty(length)
    for a in range(0, n - 1, length):
        m = min(length, n - 1 - a)
        np.multiply(source[a : a + m], growth[:m], out=work[:m])
        work[0] += out[a]
        np.cumsum(work[:m], out=work[:m])
        np.multiply(work[:m], decay[:m], out=out[a + 1 : a + 1 + m])


def _varying(e: Array, source: Array, out: Array) -> None:
    """Fill out[1:] where steps decay differently (sampling or time constant vary)."""
    n = len(out)
    total = np.cumsum(e)
    a = 0
    while a < n - 1:
        base = float(total[a - 1]) if a else 0.0
        # At least one step, even if that one alone decays by more than LIMIT.
        b = min(max(int(np.searchsorted(total, base + LIMIT)), a + 1), n - 1)
        span = np.minimum(np.cumsum(e[a:b]), 2 * LIMIT)
        growth = np.exp(span)
        work = source[a:b] * growth
        work[0] += out[a]
        np.cumsum(work, out=work)
        np.divide(work, growth, out=out[a + 1 : b + 1])
        a = b


def _doubling(e: Array, source: Array, out: Array) -> None:
    """Fill out[1:] where states fade within few steps: each pass doubles the steps summed."""
    decay, total = np.exp(-e[:-1]), source[:-1].copy()
    if len(total) == 0:
        return
    total[0] += decay[0] * out[0]
    decay[0] = 0.0
    k = 1
    while k < len(total):
        decay[decay < GONE] = 0.0
        if not decay.any():
            break
        total[k:] += decay[k:] * total[:-k]
        decay[k:] = decay[k:] * decay[:-k]
        k *= 2
    out[1:] = total
