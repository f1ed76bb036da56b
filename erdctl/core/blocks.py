"""Stretches of a recording that a fit works on: whole records, bounded pieces, or a sample."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array, Index, Recording
from erdctl.core.signals import Signals

# The state of Eq. 12 before a record or a piece of one is unknown; it has faded after this time
# for every T_d up to 60 ms (to 0.7 %).
SETTLE = 0.3
LONGEST = 50_000  # samples in one piece: its columns fit into a processor's cache


class Block(NamedTuple):
    """A stretch of data: signals, measured force (n,) [N] and weight of each sample (n,) >= 0.

    first : number of its first record, so that pieces of one record are known to be
    """

    signals: Signals
    force: Array
    weight: Array
    first: int = 0


def whole(recording: Recording) -> Block:
    """The recording as one block, its settling samples without weight."""
    if recording.force is None:
        raise ValueError("a fit needs a measured force")
    weight = np.ones(len(recording))
    for part in recording.slices:
        t = recording.t[part]
        # A short record keeps nine tenths of its samples: an unsettled start beats no data.
        settle = min(SETTLE, 0.1 * float(t[-1] - t[0]))
        weight[part][t - t[0] < settle] = 0.0
    if recording.excluded is not None:
        weight[recording.excluded] = 0.0
    return Block(Signals.of(recording), recording.force, weight)


def neighbours_of(starts: Index, longest: int = LONGEST) -> list[int]:
    """First records of runs of whole records, of at most about `longest` samples where they fit.

    starts : (r + 1,) offsets of the records
    """
    firsts, size = [0], 0
    for i, length in enumerate(np.diff(starts).tolist()):
        if size and size + length > longest:
            firsts.append(i)
            size = 0
        size += length
    return firsts


def neighbours(recording: Recording, longest: int = LONGEST) -> list[Recording]:
    """The recording as such runs."""
    bounds = recording.starts.tolist()
    firsts = neighbours_of(recording.starts, longest)
    if len(firsts) == 1:
        return [recording]
    runs = pairwise([*firsts, len(bounds) - 1])
    return [
        recording.window(
            slice(bounds[i], bounds[j]),
            recording.starts[i : j + 1] - bounds[i],
            recording.names[i:j],
        )
        for i, j in runs
    ]


def pieces(recording: Recording, longest: int = LONGEST) -> list[Block]:
    """The recording as blocks of at most about `longest` samples that together weigh each sample.

    Records stay whole where they fit; a longer one is cut, and each cut piece begins with a stretch
    without weight in which its state settles.
    """
    out: list[Block] = []
    first = 0
    for run in neighbours(recording, longest):
        blocks = _cut(run, longest) if len(run) > longest else [whole(run)]
        out += [block._replace(first=first) for block in blocks]
        first += len(run.names)
    return out


def sample(recording: Recording, most: int, length: int = 4000, seed: int = 0) -> Block:
    """At most about `most` samples, in windows spread evenly over a recording, as one block."""
    if len(recording) <= most:
        return whole(recording)
    windows = [
        slice(a, min(a + length, part.stop))
        for part in recording.slices
        for a in range(part.start, part.stop, length)
        # A short end of a record would spoil the evenness; a short record is all there is.
        if a == part.start or min(a + length, part.stop) - a >= length // 4
    ]
    every = len(recording) / most
    count = max(1, int(len(windows) / every))
    rng = np.random.default_rng(seed)
    # One from each of `count` equal groups: even cover, but in step with no periodic test.
    picks = ((np.arange(count) + rng.random(count)) * len(windows) / count).astype(int)
    return _joined(recording, [windows[i] for i in picks])


def thinned(recording: Recording, most: int) -> Recording:
    """At most about `most` samples, evenly from every record, and all next to duty steps.

    The duty is held from sample to sample, so its steps stay where they were.
    """
    every = -(-len(recording) // most)
    if every == 1:
        return recording
    keep = np.zeros(len(recording), dtype=bool)
    for part in recording.slices:
        keep[part][::every] = True
    stepped = np.flatnonzero(np.diff(recording.duty) != 0)
    if len(stepped) < most // 4:  # a duty that changes all the time has no steps to keep
        keep[stepped] = keep[stepped + 1] = True
    rows = np.flatnonzero(keep)
    return recording.take(rows, np.searchsorted(rows, recording.starts), recording.names)


def _cut(record: Recording, longest: int) -> list[Block]:
    out = []
    for a in range(0, len(record), longest):
        b = min(a + longest, len(record))
        begin = int(np.searchsorted(record.t, record.t[a] - SETTLE * 2))
        window = record.window(slice(begin, b))
        block = whole(window)
        if begin < a:
            block.weight[:] = 1.0 if window.excluded is None else ~window.excluded
            block.weight[: a - begin] = 0.0
        out.append(block)
    return out


def _joined(recording: Recording, windows: Sequence[slice]) -> Block:
    starts = np.cumsum([0, *(w.stop - w.start for w in windows)]).astype(np.intp)
    rows = np.concatenate([np.arange(w.start, w.stop) for w in windows])
    return whole(recording.take(rows, starts, [str(i) for i in range(len(windows))]))
