"""What a check of the rig reports, and what a fit may still use of the recording."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Index, Recording

VELOCITY_CODES = ("velocity_noise", "velocity_lag", "velocity_gain")


@dataclass(frozen=True, eq=False)
class RigFault:
    """Something in a recording that comes from the rig and not from the damper.

    code : e.g. "force_clipped";  record : its number, None for the log as a whole
    text : what, where and how much;  remedy : what to do about it
    samples : (k,) samples of the recording that a fit leaves out, None for none
    blocks : whether no sample of the record (of the log) can be used
    """

    code: str
    record: int | None
    text: str
    remedy: str
    samples: Index | None = None
    blocks: bool = False


@dataclass(frozen=True, eq=False)
class Rig:
    """Everything that was found wrong with a recording.

    recording : as it was logged;  looked : part of its samples that were looked at [1]
    accepted : codes that the user says are right
    """

    recording: Recording
    faults: tuple[RigFault, ...]
    looked: float = 1.0
    accepted: tuple[str, ...] = ()

    def accept(self, codes: Collection[str]) -> Rig:
        """Without what the user says is right."""
        kept = tuple(f for f in self.faults if f.code not in codes)
        return replace(self, faults=kept, accepted=tuple(sorted(codes)))

    @property
    def blocking(self) -> tuple[RigFault, ...]:
        """Faults because of which nothing at all of the recording can be used."""
        everywhere = [f for f in self.faults if f.blocks and f.record is None]
        if everywhere:
            return tuple(everywhere)
        lost = [f for f in self.faults if f.blocks]
        return tuple(lost) if len({f.record for f in lost}) == len(self.recording.names) else ()

    def name_of(self, fault: RigFault) -> str | None:
        """The record of a fault by its name."""
        return None if fault.record is None else self.recording.names[fault.record]

    def lines(self) -> list[str]:
        """One line for each fault, for eyes: where, what, remedy."""
        only = len(self.recording.names) == 1
        out = []
        for f in self.faults:
            where = "" if f.record is None or only else f"record '{self.name_of(f)}': "
            out.append(f"{where}{f.text}; {f.remedy}")
        if self.looked < 1.0 and self.faults:
            out.append(f"looked at {100 * self.looked:.0f} % of the samples, in even stretches")
        return out

    def usable(self) -> Recording:
        """What of the recording a fit may use.

        Without the records that cannot be used, unless there are no others; samples at fault are
        marked in `excluded`; a velocity channel at fault is left out for the derivative of x.
        """
        r = sound(self.recording, self.faults)
        out = marked(r, self.faults)
        if out.any():
            r = replace(r, excluded=out)
        if self.blocking:
            return r
        lost = {f.record for f in self.faults if f.blocks}
        if not lost:
            return r
        return r.select([i for i in range(len(r.names)) if i not in lost])


def sound(recording: Recording, faults: Collection[RigFault]) -> Recording:
    """The recording with the derivative of x in the place of a velocity channel at fault."""
    if not any(f.code in VELOCITY_CODES for f in faults):
        return recording
    from erdctl.bench.differentiation import derive_xdot

    r = recording
    xdot, note = derive_xdot(r.t, r.x, r.starts)
    return replace(r, xdot=xdot, xdot_note=f"{note}, the column xdot being left out")


def marked(recording: Recording, faults: Collection[RigFault]) -> npt.NDArray[np.bool_]:
    """(n,) samples that any of some faults leaves out."""
    out = np.zeros(len(recording), dtype=np.bool_)
    for f in faults:
        if f.samples is not None:
            out[f.samples] = True
    return out
