"""Fewer samples that draw the same picture: no extreme is lost, no outline changes.

Nothing here knows who draws: pictures and pages thin a log alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import numpy.typing as npt

from erdctl.core.cache import PART, parts
from erdctl.core.recording import Array, Index

COLUMNS = 1500  # pixels across a time series
CELLS = (360, 300)  # of a panel of loops, across and up: a dot covers one

Codes = npt.NDArray[np.int16]


def series(values: Array, starts: Index, columns: int = COLUMNS) -> Index:
    """Samples (k,) that draw a time series as all samples would.

    Of each pixel column the first, the lowest, the highest and the last sample (M4: Jugel,
    Jerzak, Hackenbroich and Markl, VLDB 7 (2014) 797-808), and both ends of each record as long
    as there are no more records than columns.

    values : (n,);  starts : (r + 1,) offsets of the records.  Returns indices, ascending.
    Check: values 2 0 1 5 3 2 and 4 4 9 2 3 3, a column each: the ends 0, 5, 6, 11, the lowest 1, 9
    and the highest 3, 8.
    >>> values = np.array([2, 0, 1, 5, 3, 2, 4, 4, 9, 2, 3, 3])
    >>> series(values, np.array([0, 12]), 2).tolist()
    [0, 1, 3, 5, 6, 8, 9, 11]
    """
    n = len(values)
    per = -(-n // columns)
    if per <= 4:
        return np.arange(n)
    whole = n // per * per
    first = np.arange(0, whole, per)
    body = values[:whole].reshape(-1, per)
    kept = [first, first + per - 1, first + body.argmin(axis=1), first + body.argmax(axis=1)]
    if whole < n:
        tail = values[whole:]
        kept.append(whole + np.array([0, tail.argmin(), tail.argmax(), len(tail) - 1]))
    if len(starts) <= columns:
        kept += [starts[:-1], starts[1:] - 1]
    return np.asarray(np.unique(np.concatenate(kept)), dtype=np.intp)


def gapped(rows: Index, starts: Index, *channels: Array) -> list[Array]:
    """Channels at some samples, with a NaN wherever the record changes, so that a line breaks."""
    record = np.searchsorted(starts, rows, side="right")
    cut = np.flatnonzero(np.diff(record)) + 1
    return [np.insert(c[rows].astype(np.float64), cut, np.nan) for c in channels]


def cloud(
    x: Array, y: Array, codes: Codes, count: int, cells: tuple[int, int] = CELLS
) -> list[Index]:
    """Samples of each group that fill every pixel which any sample of that group fills.

    x, y : (n,) finite;  codes : (n,) group of each sample, 0..count - 1
    Returns for each group the indices (k_g,): one sample, the last, of every occupied cell of a
    grid over the ranges of x and y. The outline of the whole is kept to a cell; `outermost` adds
    the extremes themselves. Work is done in blocks, about 20 ns a sample.
    """
    across, up = cells
    corner = (float(x.min()), float(y.min()))
    scale = (_per(float(x.max()) - corner[0], across), _per(float(y.max()) - corner[1], up))
    table = np.full(count * across * up, -1, dtype=np.intp)
    cell, other = np.empty(PART, dtype=np.int32), np.empty(PART, dtype=np.int32)
    real = np.empty(PART)
    for part in parts(len(x)):
        a, b = part.start, part.stop
        m = b - a
        for values, low, per, out in ((x, corner[0], scale[0], cell),
                                      (y, corner[1], scale[1], other)):  # fmt: skip
            np.subtract(values[a:b], low, out=real[:m])
            np.multiply(real[:m], per, out=out[:m], casting="unsafe")
        cell[:m] *= up
        cell[:m] += other[:m]
        cell[:m] += codes[a:b].astype(np.int32) * (across * up)
        table[cell[:m]] = np.arange(a, b)
    groups = table.reshape(count, -1)
    return [np.sort(row[row >= 0]) for row in groups]


def outline(x: Array, y: Array, codes: Codes, count: int) -> list[Index]:
    """Samples (k_g,) of each group that draw its cloud, with the extremes of x and y in it.

    Two threads: NumPy computes without holding Python's lock.
    """
    with ThreadPoolExecutor(2) as pool:
        kept = pool.submit(cloud, x, y, codes, count)
        ends = outermost(codes, count, x, y)
        return [np.union1d(a, b) for a, b in zip(kept.result(), ends, strict=True)]


def outermost(codes: Codes, count: int, *channels: Array) -> list[Index]:
    """The samples (k,) of each group at which one of the channels (n,) is lowest or highest."""
    low = np.full((count, len(channels)), np.inf)
    rows = np.full((count, 2 * len(channels)), -1, dtype=np.intp)
    high = -low
    for part in parts(len(codes)):
        a = part.start
        groups = np.flatnonzero(np.bincount(codes[part])).tolist()
        for g in groups:
            at = None if len(groups) == 1 else np.flatnonzero(codes[part] == g)
            for j, channel in enumerate(channels):
                values = channel[part] if at is None else channel[part][at]
                i, k = int(values.argmin()), int(values.argmax())
                if values[i] < low[g, j]:
                    low[g, j], rows[g, 2 * j] = values[i], a + (i if at is None else at[i])
                if values[k] > high[g, j]:
                    high[g, j], rows[g, 2 * j + 1] = values[k], a + (k if at is None else at[k])
    return [np.unique(r[r >= 0]) for r in rows]


def joined(pieces: Sequence[Index], *channels: Array) -> list[Array]:
    """Channels along several pieces of a log, one after the other with a NaN in between."""
    out = []
    for channel in channels:
        drawn = [p for piece in pieces for p in (channel[piece], [np.nan])]
        out.append(np.concatenate(drawn[:-1]) if drawn else np.empty(0))
    return out


def _per(span: float, cells: int) -> float:
    # Just below, so that the highest value falls into the last cell.
    return cells * (1.0 - 1e-9) / span if span > 0.0 else 0.0
