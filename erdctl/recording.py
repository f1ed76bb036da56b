"""A validated bench log in memory: immutable, SI units, several records end to end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

COMPRESSION, RELEASE = 0, 1
DIRECTIONS = ("compression", "release")


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

    def __post_init__(self) -> None:
        for channel in (self.t, self.x, self.xdot, self.duty, self.force, self.temperature):
            if channel is not None:
                if channel.shape != (self.starts[-1],):
                    raise ValueError("every channel must have starts[-1] samples")
                channel.setflags(write=False)
        if len(self.names) != len(self.starts) - 1:
            raise ValueError("one name for every record")

    def __len__(self) -> int:
        return int(self.starts[-1])

    @property
    def slices(self) -> list[slice]:
        """One slice of the samples for every record."""
        bounds = self.starts.tolist()
        return [slice(a, b) for a, b in zip(bounds[:-1], bounds[1:], strict=True)]

    @cached_property
    def step(self) -> Array:
        """(n,) time from each sample to the next [s]; 0 at the last sample of a record."""
        out = np.empty_like(self.t)
        np.subtract(self.t[1:], self.t[:-1], out=out[:-1])
        out[self.starts[1:] - 1] = 0.0
        return out

    def select(self, records: Sequence[int]) -> Recording:
        """The given records, in the given order."""
        slices = self.slices
        parts = [slices[i] for i in records]
        return self._gather(parts, [self.names[i] for i in records])

    def window(self, part: slice, name: str = "") -> Recording:
        """The samples of one slice, as a recording of a single record."""
        return self._gather([part], [name])

    def _gather(self, parts: list[slice], names: Sequence[str]) -> Recording:
        def pick(channel: Array | None) -> Array | None:
            if channel is None:
                return None
            return channel[parts[0]] if len(parts) == 1 else np.concatenate([channel[p] for p in parts])

        channels: dict[str, Any] = {
            name: pick(getattr(self, name))
            for name in ("t", "x", "xdot", "duty", "force", "temperature")
        }
        lengths = [p.stop - p.start for p in parts]
        starts = np.concatenate([[0], np.cumsum(lengths)]).astype(np.intp)
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
    return Recording(
        t=join("t"),
        x=join("x"),
        xdot=join("xdot"),
        duty=join("duty"),
        force=join("force"),
        temperature=join("temperature"),
        starts=np.concatenate([*starts, offsets[-1:]]).astype(np.intp),
        names=tuple(name for r in recordings for name in r.names),
        xdot_note="; ".join(notes),
        sources=tuple(s for r in recordings for s in r.sources),
    )
