"""A validated bench log in memory: immutable, SI units, several records end to end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

COMPRESSION, RELEASE = 0, 1
DIRECTIONS = ("compression", "release")
CHANNELS = ("t", "x", "xdot", "duty", "force", "temperature")
DERIVED = "derived from x"  # how the note of such an xdot begins


@dataclass(frozen=True)
class Source:
    """Where samples came from: file name (or "-"), SHA-256 of its bytes, number of rows."""

    name: str
    sha256: str
    rows: int


@dataclass(frozen=True, eq=False)
class Recording:
    """Samples of one or more records, one after the other.

    t, x, xdot, duty : (n,) time [s], deflection [m], its velocity [m/s], duty cycle [1]
    force : (n,) measured force [N], or None for a drive
    temperature : (n,) [degC], or None
    starts : (r + 1,) offsets; record i is samples starts[i]:starts[i + 1]
    names : (r,) names of the records
    xdot_note : how xdot was obtained
    excluded : (n,) samples that fits and scores leave out, None for none
    labels : date, damper and operator of the test and the like, as far as somebody said
    """

    t: Array
    x: Array
    xdot: Array
    duty: Array
    starts: Index
    names: tuple[str, ...]
    force: Array | None = None
    temperature: Array | None = None
    xdot_note: str = "measured"
    sources: tuple[Source, ...] = ()
    excluded: npt.NDArray[np.bool_] | None = None
    labels: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for channel in (getattr(self, name) for name in (*CHANNELS, "excluded")):
            if channel is not None:
                if channel.shape != (self.starts[-1],):
                    raise ValueError("every channel must have starts[-1] samples")
                channel.setflags(write=False)
        if len(self.names) != len(self.starts) - 1:
            raise ValueError("one name for every record")

    def __len__(self) -> int:
        return int(self.starts[-1])

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """One slice of the samples for every record."""
        bounds = self.starts.tolist()
        return tuple(slice(a, b) for a, b in pairwise(bounds))

    @cached_property
    def step(self) -> Array:
        """(n,) time from each sample to the next [s]; 0 at the last sample of a record."""
        out = np.empty_like(self.t)
        np.subtract(self.t[1:], self.t[:-1], out=out[:-1])
        out[self.starts[1:] - 1] = 0.0
        return out

    def select(self, records: Sequence[int]) -> Recording:
        """The given records, in the given order."""
        chosen = [self.slices[i] for i in records]
        starts = np.cumsum([0, *(p.stop - p.start for p in chosen)]).astype(np.intp)
        rows = np.concatenate([np.arange(p.start, p.stop) for p in chosen])
        return self.take(rows, starts, [self.names[i] for i in records])

    def window(
        self, part: slice, starts: Index | None = None, names: Sequence[str] = ("",)
    ) -> Recording:
        """The samples of one slice (no copy), as one record unless `starts` divides them."""
        whole = np.array([0, part.stop - part.start], dtype=np.intp)
        return self.take(part, whole if starts is None else starts, names)

    def take(self, rows: slice | Index, starts: Index, names: Sequence[str]) -> Recording:
        """Chosen samples, divided into records by the offsets `starts`."""

        def pick(channel: Any) -> Any:
            return None if channel is None else channel[rows]

        taken = (*CHANNELS, "excluded")
        channels: dict[str, Any] = {name: pick(getattr(self, name)) for name in taken}
        return replace(self, starts=starts, names=tuple(names), **channels)


def concatenate(recordings: Sequence[Recording]) -> Recording:
    """Several recordings as one; a channel that one of them lacks is dropped."""
    if len(recordings) == 1:
        return recordings[0]

    def join(name: str) -> Any:
        channels = [getattr(r, name) for r in recordings]
        return None if any(c is None for c in channels) else np.concatenate(channels)

    offsets = np.cumsum([0, *(len(r) for r in recordings)])
    starts = [r.starts[:-1] + o for r, o in zip(recordings, offsets[:-1], strict=True)]
    notes = dict.fromkeys(r.xdot_note for r in recordings)
    channels: dict[str, Any] = {name: join(name) for name in CHANNELS}
    parts = [np.zeros(len(r), np.bool_) if r.excluded is None else r.excluded for r in recordings]
    marked = any(r.excluded is not None for r in recordings)
    return Recording(
        **channels,
        excluded=np.concatenate(parts) if marked else None,
        starts=np.concatenate([*starts, offsets[-1:]]).astype(np.intp),
        names=tuple(name for r in recordings for name in r.names),
        xdot_note="; ".join(notes),
        sources=tuple(s for r in recordings for s in r.sources),
    )


def running_time(t: Array, starts: Index) -> Array:
    """(n,) time that goes on from record to record [s], from that of the first.

    t : (n,) times of records with the offsets `starts` (r + 1,). From the last sample of one to the
    first of the next it is a median step.
    Check: 0 1 2 s and 0 1 s are 0 1 2 3 4 s.
    >>> running_time(np.array([0.0, 1.0, 2.0, 0.0, 1.0]), np.array([0, 3, 5])).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0]
    """
    steps = np.diff(t)
    inner = np.delete(steps, starts[1:-1] - 1)
    first, last = t[starts[:-1]], t[starts[1:] - 1]
    lengths = last - first + (float(np.median(inner)) if inner.size else 0.0)
    begins = t[0] + np.cumsum(lengths) - lengths
    return np.asarray(t + np.repeat(begins - first, np.diff(starts)))
