"""What there is to draw: a recording, forces over it, and what was found out about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from erdctl.bench.strokes import cycles
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Index, Recording
from erdctl.score.nrmse import Codes, duty_levels

if TYPE_CHECKING:
    from erdctl.diagnose.residual.localisation import Region
    from erdctl.model.parameters import Parameters

Flags = npt.NDArray[np.bool_]

# What a picture can need, and how a user can give it.
NEEDS = {
    "measured": "a measured force (column force)",
    "modelled": "a modelled force: give a parameter file, or a log with a column force_model",
    "before": "a second model to compare with: give it as --before",
    "parameters": "a parameter file",
    "cases": "faults: give them as --fault",
    "acting": "faults that are mimicked: it is drawn by erdctl mimic",
    "programme": "a mimic sequence: columns duty_healthy and out_of_reach, as erdctl mimic writes",
}


@dataclass(frozen=True, eq=False)
class Programme:
    """A duty sequence that mimics faults.

    healthy : (n,) duty that it replaces [1];  out_of_reach : (n,) no duty gives the faulty force
    """

    healthy: Array
    out_of_reach: Flags


@dataclass(frozen=True, eq=False)
class Overlay:
    """Several logs in one picture, or several groups of logs.

    code : (n,) which of them a sample is of;  names : of each;  title : what they are
    ordered : whether their order means something, as that of dates does
    """

    code: Codes
    names: tuple[str, ...]
    title: str = "log"
    ordered: bool = False


@dataclass(frozen=True, eq=False, kw_only=True)
class Subject:
    """One thing to draw; whatever is None or empty is not there.

    modelled : (n,) [N];  before : (n,) of the model before a correction [N]
    cases : (n,) force of the healthy damper first, then with each fault alone [N]
    acting : (n,) when each mimicked fault acts
    regions : where a misfit was located, the sharpest first
    names : of the measured and of the modelled force, and of the model before
    about : a line on where this comes from
    overlay : several logs to tell apart; None for one
    """

    recording: Recording
    modelled: Array | None = None
    before: Array | None = None
    parameters: Parameters | None = None
    cases: Mapping[str, Array] = field(default_factory=dict)
    acting: Mapping[str, Flags] = field(default_factory=dict)
    programme: Programme | None = None
    regions: tuple[Region, ...] = ()
    names: tuple[str, str, str] = ("measured", "model", "model before")
    about: str = ""
    overlay: Overlay | None = None

    @property
    def measured(self) -> Array | None:
        """(n,) force of the log [N]."""
        return self.recording.force

    @property
    def force(self) -> Array:
        """(n,) the measured force, or else the modelled one [N]."""
        found = self.measured if self.measured is not None else self.modelled
        if found is None:
            raise ValueError("nothing to draw: no force at all")
        return found

    @property
    def residual(self) -> Array:
        """(n,) measured less modelled force [N]."""
        if self.measured is None or self.modelled is None:
            raise ValueError("a residual needs a measured and a modelled force")
        return self.measured - self.modelled

    @cached_property
    def codes(self) -> Codes:
        """(n,) number of the PWM level of each sample."""
        return self._levels[0]

    @cached_property
    def levels(self) -> Array:
        """(l,) PWM levels [1]."""
        return self._levels[1]

    @cached_property
    def _levels(self) -> tuple[Codes, Array]:
        return duty_levels(self.recording.duty)

    @cached_property
    def cycles(self) -> tuple[Index, Index]:
        """First sample (k,) and one behind the last (k,) of every cycle."""
        return cycles(self.recording)

    def lacks(self, needs: tuple[str, ...]) -> str | None:
        """The first of some needs that is not met, in words; None if all are."""
        for need in needs:
            if need == "force":
                if self.measured is None and self.modelled is None:
                    return f"{NEEDS['measured']} or {NEEDS['modelled']}"
                continue
            found = getattr(self, need)
            if found is None or (isinstance(found, Mapping) and not found):
                return NEEDS[need]
        return None


def cut(subject: Subject, rows: Index) -> Subject:
    """Some samples (k,) of a subject, ascending; records of which nothing is left are dropped."""
    r = subject.recording
    starts, first = np.unique(np.searchsorted(rows, r.starts), return_index=True)
    names = [r.names[i] for i in np.maximum(first[1:] - 1, 0).tolist()]

    def of(values: Array | None) -> Array | None:
        return None if values is None else values[rows]

    p, several = subject.programme, subject.overlay
    return replace(
        subject,
        recording=r.take(rows, starts.astype(np.intp), names),
        modelled=of(subject.modelled),
        before=of(subject.before),
        cases={name: force[rows] for name, force in subject.cases.items()},
        acting={name: flags[rows] for name, flags in subject.acting.items()},
        programme=None if p is None else Programme(p.healthy[rows], p.out_of_reach[rows]),
        overlay=None if several is None else replace(several, code=several.code[rows]),
    )


def part(
    subject: Subject, records: Sequence[str] = (), window: tuple[float, float] | None = None
) -> Subject:
    """Some records of a subject, or a time window [s] of each; all of it where neither is given.

    Raises UsageProblem for a record that is not there, and if next to nothing is left.
    """
    r = subject.recording
    if not records and window is None:
        return subject
    unknown = [name for name in records if name not in r.names]
    if unknown:
        some = ", ".join(r.names[:8]) + (", ..." if len(r.names) > 8 else "")
        raise UsageProblem(f"no record '{unknown[0]}' in the log; it has {some}")
    keep = np.ones(len(r), dtype=bool)
    if records:
        chosen = np.array([name in records for name in r.names])
        keep &= np.repeat(chosen, np.diff(r.starts))
    if window is not None:
        keep &= (r.t >= window[0]) & (r.t <= window[1])
    rows = np.flatnonzero(keep)
    if len(rows) < 2:
        raise UsageProblem("span and records leave fewer than two samples")
    # What it is about is the whole log, and its number of samples not that of the picture.
    drawn = f"{subject.about}; {len(rows):,} drawn" if subject.about else ""
    return replace(cut(subject, rows), about=drawn)
