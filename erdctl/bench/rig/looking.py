"""What of a log is looked at, gathered as it goes by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece, looked_at
from erdctl.core.recording import Index, Recording, concatenate
from erdctl.core.stretches import Gathered, Stretch


class Looked:
    """The stretches that are looked at, one after the other, of a log of which nothing else is
    kept.

    starts, names : offsets and names of the log's records
    """

    def __init__(self, starts: Index, names: Sequence[str]) -> None:
        self.chosen = looked_at(starts)
        self.names = names
        self._gathered = Gathered([(a, b) for _, a, b in self.chosen])

    def __len__(self) -> int:
        return sum(b - a for _, a, b in self.chosen)

    def add(self, stretch: Stretch) -> None:
        """The next stretch of the log."""
        self._gathered.add(stretch)

    def recording(self) -> Recording | None:
        """Them, each as a record; None if the log is too short to be told anything of."""
        blocks = self._gathered.blocks()
        return concatenate(blocks) if blocks else None

    def pieces(self, recording: Recording) -> list[Piece]:
        """Them in such a recording."""
        bounds = pairwise(recording.starts.tolist())
        return [
            Piece(recording, record, self.names[record], a, b)
            for (record, _, _), (a, b) in zip(self.chosen, bounds, strict=True)
        ]

    def placed(self, fault: RigFault, recording: Recording) -> RigFault:
        """A fault that was found in it, with the samples of the log in their place."""
        if fault.samples is None or not len(fault.samples):
            return fault
        at = np.searchsorted(recording.starts, fault.samples, side="right") - 1
        firsts = np.array([a for _, a, _ in self.chosen])
        when = recording.t[fault.samples[[0, -1]]].tolist()
        return replace(
            fault,
            samples=fault.samples + (firsts - recording.starts[:-1])[at],
            when=(when[0], when[1]),
        )
