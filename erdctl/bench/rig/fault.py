"""What a check of the rig reports, and what a fit may still use of the recording."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.held_duty import held_duty
from erdctl.bench.rig.holding import between
from erdctl.bench.rig.pieces import FEWEST
from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.recording import Index, Recording

CODES = (
    "force_sign", "time_unit", "speed_unit", "stroke_unit", "force_unit", "duty_unit",
    "force_clipped", "x_clipped", "force_frozen", "x_frozen", "force_spikes", "x_spikes",
    "force_burst", "samples_missing", "x_jumps", "velocity_noise", "velocity_lag", "velocity_gain",
    "velocity_offset", "duty_noise", "duty_inverted", "record_gain", "record_offset", "record_lag",
    "record_noise", "record_duty", "record_twice", "record_velocity", "record_deflection",
    "record_turned", "x_held", "force_held",
)  # fmt: skip
REFUSED = 3  # faults that one message tells
VELOCITY_CODES = ("velocity_noise", "velocity_lag", "velocity_gain")


@dataclass(frozen=True, eq=False)
class RigFault:
    """Something in a recording that comes from the rig and not from the damper.

    code : e.g. "force_clipped";  record : its number, None for the log as a whole
    text : what, where and how much;  remedy : what to do about it
    samples : (k,) samples of the log that a fit leaves out, None for none
    when : times of the first and the last of them [s]
    zero : of the velocity, which fits take off [m/s]
    blocks : whether no sample of the record (of the log) can be used
    """

    code: str
    record: int | None
    text: str
    remedy: str
    samples: Index | None = None
    blocks: bool = False
    when: tuple[float, float] | None = None
    zero: float = 0.0


@dataclass(frozen=True, eq=False)
class Rig:
    """Everything that was found wrong with a recording.

    names : of its records;  looked : part of its samples that were looked at [1]
    accepted : codes that the user says are right
    recording : as it was logged, None where it was read in stretches
    """

    names: tuple[str, ...]
    faults: tuple[RigFault, ...]
    looked: float = 1.0
    accepted: tuple[str, ...] = ()
    recording: Recording | None = None

    def accept(self, codes: Collection[str]) -> Rig:
        """Without what the user says is right; UsageProblem for a code that there is not."""
        unknown = [c for c in codes if c not in CODES]
        if unknown:
            raise UsageProblem(f"no rig check '{unknown[0]}'; there are {', '.join(CODES)}")
        kept = tuple(f for f in self.faults if f.code not in codes)
        return replace(self, faults=kept, accepted=tuple(sorted(codes)))

    def beside(self, faults: Iterable[RigFault]) -> Rig:
        """With what a model has shown of the rig."""
        return replace(self, faults=(*self.faults, *faults))

    @property
    def blocking(self) -> tuple[RigFault, ...]:
        """Faults because of which nothing at all of the recording can be used."""
        everywhere = [f for f in self.faults if f.blocks and f.record is None]
        if everywhere:
            return tuple(everywhere)
        lost = [f for f in self.faults if f.blocks]
        return tuple(lost) if len({f.record for f in lost}) == len(self.names) else ()

    @property
    def cut(self) -> tuple[RigFault, ...]:
        """Channels that stop at a limit: what was beyond it is not in the recording."""
        return tuple(f for f in self.faults if f.code in ("force_clipped", "x_clipped"))

    def name_of(self, fault: RigFault) -> str | None:
        """The record of a fault by its name."""
        return None if fault.record is None else self.names[fault.record]

    def lines(self) -> list[str]:
        """One line for each fault, for eyes: where, what, remedy."""
        only = len(self.names) == 1
        out = []
        for f in self.faults:
            where = "" if f.record is None or only else f"record '{self.name_of(f)}': "
            out.append(f"{where}{f.text}; {f.remedy}")
        if self.looked < 1.0:
            part = 100 * min(self.looked, 0.999)  # never all of them by rounding
            out.append(
                f"looked at {part:.3g} % of the samples: of a long log at even stretches, and at no"
                f" record of fewer than {FEWEST} samples"
            )
        return out

    def to_json(self) -> list[dict[str, Any]]:
        """The faults as documents hold them."""
        out = []
        for f in self.faults:
            entry: dict[str, Any] = {
                "code": f.code, "record": self.name_of(f), "text": f.text, "remedy": f.remedy,
                "blocks": f.blocks,
            }  # fmt: skip
            if f.samples is not None and f.when is not None:
                entry |= {"samples": len(f.samples), "first": f.when[0], "last": f.when[1]}
            out.append(entry)
        return out

    def refuse(self) -> None:
        """Raise InputProblem if nothing of the recording can be fitted."""
        if self.blocking:
            sources = () if self.recording is None else self.recording.sources
            raise InputProblem(
                "nothing can be fitted to it: "
                + "; ".join(f"{f.text}; {f.remedy}" for f in self.blocking[:REFUSED]),
                file=sources[0].name if len(sources) == 1 else None,
            )

    def usable(self) -> Recording:
        """What of the recording a fit may use.

        Without the records that cannot be used, unless there are no others; samples at fault are
        marked in `excluded`; a velocity channel at fault is left out for the derivative of x, or
        has its zero taken off; a duty with noise is taken at the levels that it holds, and a held x
        on the curve between the samples at which it is read.
        """
        if self.recording is None:
            raise ValueError("a log that was read in stretches is not there to be used")
        r = sound(self.recording, self.faults)
        out = marked(r, self.faults)
        if r.excluded is not None:
            out |= r.excluded
        if out.any():
            r = replace(r, excluded=out)
        if self.blocking:
            return r
        lost = {f.record for f in self.faults if f.blocks}
        if not lost:
            return r
        return r.select([i for i in range(len(r.names)) if i not in lost])


def sound(recording: Recording, faults: Collection[RigFault]) -> Recording:
    """The recording with the derivative of x in the place of a velocity channel at fault, or with
    that channel less its zero; with the levels of a duty with noise; and with x as it goes between
    the samples at which it is read, where it is held.
    """
    codes = {f.code for f in faults}
    r = recording
    if "duty_noise" in codes and (held := held_duty(r.duty, r.starts)) is not None:
        r = replace(r, duty=held.duty)
    if zero := sum(f.zero for f in faults):
        r = replace(r, xdot=r.xdot - zero)
    elif not codes.isdisjoint(VELOCITY_CODES):
        xdot, note = derive_xdot(r.t, r.x, r.starts)
        r = replace(r, xdot=xdot, xdot_note=f"{note}, the column xdot being left out")
    return between(r) if "x_held" in codes else r


def marked(recording: Recording, faults: Collection[RigFault]) -> npt.NDArray[np.bool_]:
    """(n,) samples that any of some faults leaves out."""
    out = np.zeros(len(recording), dtype=np.bool_)
    for f in faults:
        if f.samples is not None:
            out[f.samples] = True
    return out
