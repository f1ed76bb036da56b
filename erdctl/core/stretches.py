"""A log in stretches, one after the other: the same ones whether it is in memory or is being read.

Records are independent, so a stretch holds as many whole ones as fit. A record that is longer is
cut where the piston moves: its direction is then known on either side, and with the sample ahead
a stretch needs nothing more of its neighbours than a model's state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.blocks import neighbours_of
from erdctl.core.recording import CHANNELS, Array, Index, Recording, concatenate

LONG = 1 << 20  # samples of a stretch, where records allow it
MEASURED = "measured"  # an xdot that was derived takes all of a record


class Extent(NamedTuple):
    """Records from one up to another, and their samples."""

    record: int
    behind: int
    first: int
    end: int

    @property
    def samples(self) -> int:
        """How many."""
        return self.end - self.first


@dataclass(frozen=True, eq=False)
class Stretch:
    """Some records of a log, or a part of one.

    recording : its samples, and where it is `ahead` the first of the next stretch at its end
    first, record : number of its first sample, and of its first record, in the log
    begun : its record began in an earlier stretch;  ahead : it goes on in the next one
    """

    recording: Recording
    first: int = 0
    record: int = 0
    begun: bool = False
    ahead: bool = False

    def __len__(self) -> int:
        return len(self.recording) - self.ahead

    @property
    def own(self) -> Recording:
        """Its samples alone."""
        if not self.ahead:
            return self.recording
        return self.recording.window(slice(0, len(self)), names=self.recording.names)

    def parts(self) -> list[Stretch]:
        """It, cut as a log is: sums over what a model had to take whole round as they do elsewhere.

        A stretch that is a part of a record already is left as it is.
        """
        if self.begun or self.ahead:
            return [self]
        return [
            replace(part, first=self.first + part.first, record=self.record + part.record)
            for part in stretches(self.recording)
        ]


def extents(starts: Index, long: int | None = None) -> Iterator[Extent]:
    """Whole records that make a stretch together; a record longer than `long` is by itself.

    starts : (r + 1,) offsets of the records
    """
    long = LONG if long is None else long
    bounds = starts.tolist()
    firsts = neighbours_of(starts)
    begin = 0
    for i, j in pairwise([*firsts, len(bounds) - 1]):
        # Runs stay whole, so that a model computes the same ones in a stretch as in a whole log.
        if i > begin and bounds[j] - bounds[begin] > long:
            yield Extent(begin, i, bounds[begin], bounds[i])
            begin = i
    yield Extent(begin, len(bounds) - 1, bounds[begin], bounds[-1])


def cut_at(xdot: Array, left: int, long: int | None = None) -> int | None:
    """Samples of a record up to where it is cut next; all that are left where it is not.

    xdot : (n,) of what is there of it, from the last cut on [m/s];  left : samples from there on
    Returns None if the place lies beyond what is there.
    Check: of 10 samples of which the third to fifth are at rest, cut after 2, there are 5.
    >>> cut_at(np.array([1.0, 1, 0, 0, 0, 1, 1, 1, 1, 1]), 10, long=2)
    5
    """
    long = LONG if long is None else long
    if left <= long + long // 2:
        return left
    moving = np.flatnonzero(xdot[long:] != 0.0)
    if moving.size:
        at = long + int(moving[0])
        return left if left - at < 2 else at
    return None if len(xdot) < left else left


def stretches(recording: Recording, *, cut: bool = True, long: int | None = None) -> list[Stretch]:
    """A recording in stretches, as views; cut : whether long records are cut, too."""
    out = []
    for e in extents(recording.starts, long):
        bounds = recording.starts[e.record : e.behind + 1] - e.first
        names = recording.names[e.record : e.behind]
        if not cut or len(names) > 1 or recording.xdot_note != MEASURED:
            part = recording.window(slice(e.first, e.end), bounds, names)
            out.append(Stretch(part, e.first, e.record))
            continue
        a = e.first
        while a < e.end:
            length = cut_at(recording.xdot[a : e.end], e.end - a, long)
            assert length is not None
            ahead = a + length < e.end
            part = recording.window(slice(a, a + length + ahead), names=names)
            out.append(Stretch(part, a, e.record, begun=a > e.first, ahead=ahead))
            a += length
    return out


class Gathered:
    """Chosen samples of a log, kept as they come by.

    extents : first and end of each part, in samples of the log
    """

    def __init__(self, extents: Sequence[tuple[int, int]]) -> None:
        self.extents = extents
        self._parts: list[list[Recording]] = [[] for _ in extents]

    def add(self, stretch: Stretch) -> None:
        """The next stretch of the log."""
        first, end = stretch.first, stretch.first + len(stretch)
        for (a, b), parts in zip(self.extents, self._parts, strict=True):
            low, high = max(a, first), min(b, end)
            if low < high:
                # Copied, so that the stretch itself is let go.
                parts.append(_copied(stretch.recording, slice(low - first, high - first)))

    def blocks(self) -> list[Recording]:
        """Each of the parts, as one record."""
        return [_joined(parts) for parts in self._parts]


def _copied(recording: Recording, part: slice) -> Recording:
    window = recording.window(part)
    copies = {n: c.copy() for n in CHANNELS if (c := getattr(window, n)) is not None}
    return replace(window, **copies)


def _joined(parts: Sequence[Recording]) -> Recording:
    if len(parts) == 1:
        return parts[0]
    whole = concatenate(parts)
    return replace(whole, starts=whole.starts[[0, -1]], names=("",))
