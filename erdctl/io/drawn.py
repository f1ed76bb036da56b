"""A sample of a log that is too long to be fitted as a whole, and what there is to say of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from erdctl.bench.rig import Looking, Rig
from erdctl.core.messages import counted
from erdctl.core.recording import Index, Recording, concatenate
from erdctl.core.stretches import Gathered
from erdctl.io.long_logs import LongLog

MOST = 1 << 23  # samples that are fitted; their channels take 0.3 GB
WINDOW = 1 << 17  # samples of a part of a longer record


@dataclass(frozen=True, eq=False)
class Drawn:
    """A sample of a log.

    recording : whole records and windows of longer ones, each as a record
    chosen : record, first and end of each of them in the log
    of : samples, and parts that they were drawn from;  rig : what is wrong with the log
    """

    recording: Recording
    chosen: Sequence[tuple[int, int, int]]
    of: tuple[int, int]
    rig: Rig

    def usable(self, rig: Rig) -> Recording:
        """What of it a fit may use; rig : what counts of the log's own."""
        first = self.recording.starts
        faults = [f for f in rig.faults if f.record is None and f.samples is None]
        for f in rig.faults:
            for k, (record, a, b) in enumerate(self.chosen):
                if f.samples is None and f.record == record:
                    faults.append(replace(f, record=k))
                elif f.samples is not None and f.record in (None, record):
                    inside = f.samples[(f.samples >= a) & (f.samples < b)]
                    if len(inside):
                        faults.append(replace(f, record=k, samples=inside - a + first[k]))
        mine = replace(
            rig, names=self.recording.names, faults=tuple(faults), recording=self.recording
        )
        return mine.usable()

    def __str__(self) -> str:
        samples, parts = self.of
        return (
            f"fitted to a sample: {len(self.chosen)} of {counted(parts, 'record')}, or windows of"
            " long ones,"
            f" with {len(self.recording)} of {samples} samples, one drawn from each of as many"
            " equal groups, the same in every run; standard errors are those of the sample"
        )

    def to_json(self) -> dict[str, Any]:
        """For the provenance of what is fitted to it."""
        samples, parts = self.of
        return {
            "samples": len(self.recording), "of_samples": samples, "parts": len(self.chosen),
            "of_parts": parts, "text": str(self),
        }  # fmt: skip


def draw(log: LongLog, most: int) -> Drawn:
    """At most about `most` samples of a log, which is read, and checked, as a whole.

    Raises what `LongLog.stretches` raises.
    """
    windows = windows_of(log.outline.starts)
    count = max(1, int(len(windows) * most / log.samples))
    rng = np.random.default_rng(0)
    # One from each of `count` equal groups: even cover, but in step with no schedule of a test.
    picks = ((np.arange(count) + rng.random(count)) * len(windows) / count).astype(int).tolist()
    chosen = [windows[i] for i in picks]
    gathered = Gathered([(a, b) for _, a, b in chosen])
    looking = Looking(log.outline.starts, log.outline.names)
    for read in log.stretches():
        gathered.add(read.stretch)
        looking.add(read.stretch)
    names = tuple(_name(log, record, a, b) for record, a, b in chosen)
    recording = replace(concatenate(gathered.blocks()), names=names)
    recording = replace(recording, sources=log.sources, xdot_note=log.xdot_note, labels=log.labels)
    return Drawn(recording, chosen, (log.samples, len(windows)), looking.rig())


def windows_of(starts: Index, length: int | None = None) -> Sequence[tuple[int, int, int]]:
    """Record, first and end of the parts that a log is drawn from: records, or even parts of one.

    starts : (r + 1,) offsets of the records
    Check: records of 4 and 9 samples in windows of 4: record 0 from 0 to 4, record 1 from 4 to 8
    and from 8 to 13.
    >>> windows_of(np.array([0, 4, 13]), 4)
    [(0, 0, 4), (1, 4, 8), (1, 8, 13)]
    """
    length = WINDOW if length is None else length
    out = []
    for record, (a, b) in enumerate(pairwise(starts.tolist())):
        many = max(1, (b - a) // length)
        bounds = [a + (b - a) * k // many for k in range(many + 1)]
        out += [(record, first, end) for first, end in pairwise(bounds)]
    return out


def _name(log: LongLog, record: int, a: int, b: int) -> str:
    name, starts = log.outline.names[record], log.outline.starts
    first, end = int(starts[record]), int(starts[record + 1])
    return name if (a, b) == (first, end) else f"{name} from sample {a - first + 1}"
