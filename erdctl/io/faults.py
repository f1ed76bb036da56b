"""Faults, as a diagnosis writes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypedDict

from erdctl.diagnose.fault_wording import as_fault_text

if TYPE_CHECKING:
    from erdctl.diagnose.diagnosis import Diagnosis


class SetsInOnceDocument(TypedDict):
    """A fault that sets in once, as a search finds where the time of records goes on.

    equivalent : effects from which the data do not tell it
    interval : 95 % of the onset, in the time of its record [s];  f : effectiveness that is left
    in_later_records : whether it stays in those behind;  records : all that have it
    all_along : whether they have it from their beginnings;  beside : other effects then named
    share : part of the misfit's square that all take;  explained : whether the rest, rms, is noise
    """

    effect: str
    equivalent: list[str]
    record: str
    interval: list[float]
    unit: str
    f: float
    in_later_records: bool
    records: list[str]
    all_along: bool
    share: float
    beside: list[str]
    explained: bool
    rms: float


class AsFaultDocument(TypedDict):
    """A fault that does nearly what a new fit of given parameters does, all along the log.

    equivalent : effects from which the data do not tell it;  f : effectiveness that is left
    share : of the square by which the given parameters are worse than fitted ones
    rms : of what it leaves [N]
    """

    effect: str
    equivalent: list[str]
    f: float
    stderr: float
    share: float
    rms: float
    text: str


def as_fault(found: Diagnosis) -> dict[str, Any]:
    """A fault of the damper with the given parameters; nothing where there is none."""
    fault = found.as_fault
    if fault is None:
        return {}
    return {
        "as_fault": {
            "effect": fault.effect.name,
            "equivalent": list(fault.alike),
            "f": fault.f,
            "stderr": fault.stderr,
            "share": fault.share,
            "rms": fault.rms,
            "text": as_fault_text(found),
        }
    }


def sets_in_once(found: Diagnosis) -> dict[str, Any]:
    """A fault from a time in one record on; nothing where there is none."""
    once = found.once
    if once is None or once.confirmed is None:
        return {}
    return {
        "sets_in_once": {
            "effect": once.effect.name,
            "equivalent": list(once.confirmed.alike),
            "record": found.problem.recording.names[once.record],
            "interval": list(once.at),
            "unit": "s",
            "f": once.f,
            "in_later_records": once.stays,
            "records": [found.problem.recording.names[r] for r in once.records],
            "all_along": once.whole,
            "share": once.confirmed.share,
            "beside": list(once.confirmed.beside),
            "explained": once.confirmed.explained,
            "rms": once.confirmed.rms,
        }
    }
