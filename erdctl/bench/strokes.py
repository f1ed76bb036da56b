"""Strokes and cycles of a test: what happens between two reversals of the piston."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index, Recording

REACHED = 0.05  # of the record's highest speed: below it a change of sign may be noise

CLOSED = 0.05  # of its stroke: how far a cycle may end from where it began


@dataclass(frozen=True, eq=False)
class Strokes:
    """Complete strokes, in the order of the log.

    first, end : (k,) sample at which the speed has left rest, and one behind the stroke's last
    close : (k,) first sample of the stroke that follows, complete or not
    compression : (k,);  record : (k,) number of the record
    """

    first: Index
    end: Index
    close: Index
    compression: npt.NDArray[np.bool_]
    record: Index

    def __len__(self) -> int:
        return len(self.first)

    def highest(self, values: Array) -> Array:
        """(k,) highest of values (n,) in each stroke."""
        return self._over(np.maximum, values)

    def lowest(self, values: Array) -> Array:
        """(k,) lowest of values (n,) in each stroke."""
        return self._over(np.minimum, values)

    def _over(self, ufunc: np.ufunc, values: Array) -> Array:
        if not len(self):
            return np.empty(0)
        pairs = np.column_stack([self.first, self.end]).ravel()
        out: Array = ufunc.reduceat(values, pairs)[::2]
        return out


def strokes(recording: Recording) -> Strokes:
    """The complete strokes of a recording; what a record begins and ends with is none.

    A stroke lasts while the speed keeps its sign beyond REACHED of the record's highest, so that
    the noise of a differentiated velocity at a reversal makes no strokes of its own.

    Check: x = sin(2 pi t) over 0..3 s, sampled at 100 Hz, has 5: from each reversal to the next.
    >>> t = np.arange(300) / 100
    >>> len(strokes(recording(np.cos(2.0 * np.pi * t), t=t)))
    5
    """
    starts = recording.starts
    speed = np.abs(recording.xdot)
    least = REACHED * np.maximum.reduceat(speed, starts[:-1])
    moving = np.flatnonzero(speed > np.repeat(least, np.diff(starts)))
    if moving.size == 0:
        none = np.empty(0, dtype=np.intp)
        return Strokes(none, none, none, np.empty(0, dtype=bool), none)
    up = recording.xdot[moving] > 0
    turns = np.flatnonzero(up[1:] != up[:-1]) + 1
    # Where in `moving` each record begins: a stroke ends there, too, and is not complete.
    edges = np.searchsorted(moving, starts[:-1])
    bounds = np.unique(np.concatenate([turns, edges, [len(moving)]]))
    bounds = bounds[bounds <= len(moving)]
    first, last = moving[bounds[:-1]], moving[bounds[1:] - 1]
    record = np.searchsorted(starts, first, side="right") - 1
    inner = np.zeros(len(first), dtype=bool)
    inner[1:-1] = (record[1:-1] == record[:-2]) & (record[1:-1] == record[2:])
    close = np.append(first[1:], 0)
    up = up[bounds[:-1]]
    return Strokes(first[inner], last[inner] + 1, close[inner], up[inner], record[inner])


def cycles(recording: Recording) -> tuple[Index, Index]:
    """First sample (k,) and one behind the last (k,) of each two complete strokes in a row.

    The last sample is the first of the next stroke, so that a steady loop drawn of it closes. Only
    cycles that end within CLOSED of their stroke from where they began, if there are such: others
    are pieces of a wandering motion.
    """
    found = strokes(recording)
    pair, closed = _pairs(recording, found)
    pair = pair[closed] if closed.any() else pair
    return found.first[pair], found.close[pair + 1] + 1


def steady(recording: Recording, found: Strokes) -> npt.NDArray[np.bool_]:
    """(k,) whether a stroke is half of a cycle that ends where it began."""
    pair, closed = _pairs(recording, found)
    out = np.zeros(len(found), dtype=bool)
    out[pair[closed]] = out[pair[closed] + 1] = True
    return out


def _pairs(recording: Recording, found: Strokes) -> tuple[Index, npt.NDArray[np.bool_]]:
    """(k,) strokes that another complete one follows, and whether the two close."""
    pair = np.flatnonzero(found.record[:-1] == found.record[1:])
    if not len(pair):
        return pair, np.empty(0, dtype=bool)
    x, first, last = recording.x, found.first[pair], found.close[pair + 1]
    bounds = np.column_stack([first, last]).ravel()
    span = (np.maximum.reduceat(x, bounds) - np.minimum.reduceat(x, bounds))[::2]
    return pair, np.abs(x[last] - x[first]) <= CLOSED * span


def varied(features: Array, most: int, apart: float = 0.1) -> Index:
    """Rows of features (k, m) that differ most: the largest, then whatever is farthest from those.

    apart : the part of a feature's largest magnitude by which two rows must differ at least
    Check: 1, 1.01, 3, 2 with most = 3 gives rows 2, 0, 3.
    >>> varied(np.array([[1.0], [1.01], [3.0], [2.0]]), 3).tolist()
    [2, 0, 3]
    """
    if not len(features):
        return np.empty(0, dtype=np.intp)
    scale = np.abs(features).max(axis=0)
    unit = features / np.where(scale > 0, scale, 1.0)
    chosen = [int(unit.sum(axis=1).argmax())]
    away = np.abs(unit - unit[chosen[0]]).max(axis=1)
    while len(chosen) < most and away.max() > apart:
        chosen.append(int(away.argmax()))
        away = np.minimum(away, np.abs(unit - unit[chosen[-1]]).max(axis=1))
    return np.array(chosen, dtype=np.intp)


def stretches(flags: npt.NDArray[np.bool_], starts: Index) -> tuple[Index, Index]:
    """First sample (k,) and one behind the last (k,) of each stretch in which a flag (n,) is set.

    A stretch ends with its record.
    Check: 0 1 1 0 1 gives 1, 4 and 3, 5.
    >>> first, end = stretches(np.array([0, 1, 1, 0, 1], dtype=bool), np.array([0, 5]))
    >>> first.tolist(), end.tolist()
    ([1, 4], [3, 5])
    """
    bounds = np.diff(flags.astype(np.int8), prepend=0, append=0)
    first, end = np.flatnonzero(bounds == 1), np.flatnonzero(bounds == -1)
    inside = starts[1:-1][flags[starts[1:-1]] & flags[starts[1:-1] - 1]]
    return np.sort(np.concatenate([first, inside])), np.sort(np.concatenate([end, inside]))
