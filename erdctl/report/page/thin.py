"""Fewer samples for a picture, none of its extremes lost."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.recording import Array, Index


def keep(columns: Sequence[Array], most: int, corners: Index | None = None) -> Index:
    """Samples to draw, ascending: the least and the greatest of every column in equal runs.

    columns : k of (n,);  most : how many samples to keep at most
    corners : samples to keep as well while they are few, such as both sides of a reversal
    All of them where n <= most. What extremes and corners leave of `most` goes to samples at equal
    distances. The first and the last sample are always kept.
    Check: column 0 9 1 1 -5 1 8 1, most 7 is one run: 1 and 4 (9 and -5), the ends 0 and 7, and
    every third besides: 0, 1, 3, 4, 6, 7.
    >>> keep([np.array([0, 9, 1, 1, -5, 1, 8, 1])], 7).tolist()
    [0, 1, 3, 4, 6, 7]
    """
    n = len(columns[0])
    if n <= most:
        return np.arange(n)
    few = corners if corners is not None and len(corners) <= most // 4 else np.arange(0)
    runs = max(1, (most - 2 - len(few)) // (3 * len(columns)))
    size = -(-n // runs)
    whole = n // size * size
    first = np.arange(0, whole, size)
    found = [np.array([0, n - 1]), few]
    for column in columns:
        by_run = column[:whole].reshape(-1, size)
        found += [first + by_run.argmin(axis=1), first + by_run.argmax(axis=1)]
        if whole < n:
            rest = column[whole:]
            found.append(np.array([whole + rest.argmin(), whole + rest.argmax()]))
    rows = np.unique(np.concatenate(found))
    left = most - len(rows)
    if left <= 0:
        return rows
    return np.union1d(rows, np.arange(0, n, -(-n // left)))


def reversals(xdot: Array) -> Index:
    """(k,) samples before and after each change of the direction (n,) [m/s]."""
    after = np.flatnonzero((xdot[1:] > 0) != (xdot[:-1] > 0)) + 1
    return np.union1d(after - 1, after)


def lines(kept: Index, *, t: Array, xdot: Array, level: Index, starts: Index) -> Array:
    """(k,) 1 where a line from the kept sample before is true to the motion, else 0.

    It is where both belong to one record and one duty level and are less than a sixteenth of the
    record's mean period apart. Of a motion that does not reverse the period is its duration.

    t, xdot, level : (n,) [s], [m/s], number of the duty level;  starts : (r + 1,) of the records
    """
    turned = np.zeros(len(t), dtype=np.intp)
    turned[1:] = (xdot[1:] > 0) != (xdot[:-1] > 0)
    turns = np.add.reduceat(turned, starts[:-1])
    period = 2 * (t[starts[1:] - 1] - t[starts[:-1]]) / np.maximum(turns, 2)
    record = np.searchsorted(starts, kept, side="right") - 1
    out = np.zeros(len(kept))
    a, b = kept[:-1], kept[1:]
    near = t[b] - t[a] <= np.maximum(period[record[1:]] / 16, 0.0)
    out[1:] = (record[1:] == record[:-1]) & (level[a] == level[b]) & (near | (b == a + 1))
    return out
