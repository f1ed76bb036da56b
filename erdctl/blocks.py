"""Stretches of a recording that a fit works on: whole records, bounded pieces, or a sample."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from erdctl.recording import Array, Recording
from erdctl.signals import Signals

# The state of Eq. 12 before a record or a piece of one is unknown; it has faded after this time
# for every T_d up to 60 ms (to 0.7 %).
SETTLE = 0.3
LONGEST = 50_000  # samples in one piece: its columns fit into a processor's cache


class Block(NamedTuple):
    """A stretch of data: signals, measured force (n,) [N] and weight of each sample (n,) >= 0."""

    signals: Signals
    force: Array
    weight: Array


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
    return Block(Signals.of(recording), recording.force, weight)


def pieces(recording: Recording, longest: int = LONGEST) -> list[Block]:
    """The recording as blocks of at most about `longest` samples that together weigh each sample.

    Records stay whole where they fit; a longer one is cut, and each cut piece begins with a stretch
    without weight in which its state settles.
    """
    groups: list[list[slice]] = [[]]
    room = longest
    for part in recording.slices:
        length = part.stop - part.start
        if length > room and groups[-1]:
            groups.append([])
            room = longest
        if length > longest:
            groups[-1].append(part)
            groups.append([])
            room = longest
            continue
        groups[-1].append(part)
        room -= length
    out = []
    for group in groups:
        if not group:
            continue
        if len(group) == 1 and group[0].stop - group[0].start > longest:
            out += _cut(recording, group[0], longest)
        else:
            out.append(whole(_span(recording, group)))
    return out


def sample(recording: Recording, most: int, length: int = 4000, seed: int = 0) -> Block:
    """At most about `most` samples, in windows spread evenly over a recording, as one block."""
    if len(recording) <= most:
        return whole(recording)
    windows = [
        slice(a, min(a + length, part.stop))
        for part in recording.slices
        for a in range(part.start, part.stop, length)
        if min(a + length, part.stop) - a >= length // 4
    ]
    every = len(recording) / most
    count = max(1, int(len(windows) / every))
    rng = np.random.default_rng(seed)
    # One from each of `count` equal groups: even cover, but in step with no periodic test.
    picks = ((np.arange(count) + rng.random(count)) * len(windows) / count).astype(int)
    return _joined(recording, [windows[i] for i in picks])


def _span(recording: Recording, parts: Sequence[slice]) -> Recording:
    """Neighbouring records as a recording that shares their samples."""
    first = int(np.searchsorted(recording.starts, parts[0].start))
    if len(parts) == len(recording.names):
        return recording
    span = slice(parts[0].start, parts[-1].stop)
    starts = recording.starts[first : first + len(parts) + 1] - span.start
    return recording.window(span, starts, recording.names[first : first + len(parts)])


def _cut(recording: Recording, record: slice, longest: int) -> list[Block]:
    out = []
    for a in range(record.start, record.stop, longest):
        b = min(a + longest, record.stop)
        from_t = recording.t[a] - SETTLE * 2
        begin = max(record.start, int(np.searchsorted(recording.t[record], from_t)) + record.start)
        part = recording.window(slice(begin, b))
        block = whole(part)
        if begin < a:
            block.weight[:] = 1.0
            block.weight[: a - begin] = 0.0
        out.append(block)
    return out


def _joined(recording: Recording, windows: Sequence[slice]) -> Block:
    starts = np.cumsum([0, *(w.stop - w.start for w in windows)]).astype(np.intp)
    rows = np.concatenate([np.arange(w.start, w.stop) for w in windows])
    return whole(recording.take(rows, starts, [str(i) for i in range(len(windows))]))
