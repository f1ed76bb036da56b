"""An inspection as JSON, `"schema": "erdctl.inspection/1"`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, NotRequired, TypedDict, cast

import msgspec

from erdctl.bench.identifiability import Cover
from erdctl.bench.inspection import Inspection, NoiseFloor, RecordSummary, Span
from erdctl.core.recording import Source
from erdctl.io.logs import ColumnMap, Log
from erdctl.io.rig import RigFaultDocument
from erdctl.io.undetected import UndetectedDocument, undetected
from erdctl.io.units import UNITS

if TYPE_CHECKING:
    from erdctl.diagnose.forecast import Forecast

SCHEMA: Final = "erdctl.inspection/1"


class LogEntry(TypedDict):
    """A log file: name as given, SHA-256 of its bytes."""

    name: str
    sha256: str
    rows: int


class ChannelEntry(TypedDict):
    """A column: what the log calls it; times factor plus offset it is in `unit`."""

    name: str
    column: str
    unit: str
    factor: float
    offset: float
    range: list[float] | None


class RecordEntry(TypedDict):
    """One record; lengths in m, times in s, rate in Hz, spans as [lowest, highest]."""

    name: str
    samples: int
    duration: float
    rate: float
    jitter: float
    gaps: int
    missing_samples: int
    longest_gap: float
    longest_gap_at: float | None
    x: list[float]
    speed: float
    duty: list[float]
    force: list[float] | None
    temperature: list[float] | None


class LevelEntry(TypedDict):
    """Time at one duty level [s]."""

    duty: float
    seconds: float


class NoiseEntry(TypedDict):
    """A guess at the force noise [N], and the smallest step of the force [N]."""

    rms: float
    resolution: float


class NeedEntry(TypedDict):
    """A measure of the log, and the least that is needed of it."""

    what: str
    unit: str
    needed: float
    found: float
    met: bool


class CoverEntry(TypedDict):
    """Whether the log can show a parameter or effect; drives : as `simulate --drive` takes them."""

    name: str
    identifiable: bool
    reason: str | None
    needs: list[NeedEntry]
    drives: list[str]


class ForecastEntry(TypedDict):
    """From which size each effect would show, under white noise of so much force, rms [N]."""

    noise_rms: float
    effects: list[UndetectedDocument]


class InspectionFile(TypedDict):
    """What a log holds and what it can show."""

    schema: Literal["erdctl.inspection/1"]
    logs: list[LogEntry]
    channels: list[ChannelEntry]
    other_columns: list[str]
    samples: int
    duration: float
    xdot: str
    records: list[RecordEntry]
    duty_levels: list[LevelEntry]
    noise: NoiseEntry | None
    mass_at_noise: float | None
    parameters: list[CoverEntry]
    effects: list[CoverEntry]
    rig: list[RigFaultDocument]
    forecast: NotRequired[ForecastEntry]
    provenance: NotRequired[dict[str, str]]


@dataclass(frozen=True)
class InspectedLog:
    """The log of an inspection: where it came from, and the ends of each channel, by name."""

    sources: Sequence[Source]
    channels: Sequence[ColumnMap]
    unread: Sequence[str]
    labels: Mapping[str, str]
    ranges: Mapping[str, list[float]]


def subject_of(log: Log) -> InspectedLog:
    """A log that is in memory."""
    ranges = {c.name: found for c in log.channels if (found := _range(log, c.name)) is not None}
    r = log.recording
    return InspectedLog(r.sources, log.channels, log.unread, r.labels, ranges)


def to_json(found: Inspection, log: InspectedLog, ahead: Forecast | None = None) -> InspectionFile:
    """The document of an inspection, with a forecast if one was asked for."""
    document: InspectionFile = {
        "schema": SCHEMA,
        "logs": [{"name": s.name, "sha256": s.sha256, "rows": s.rows} for s in log.sources],
        "channels": [
            {
                "name": c.name,
                "column": c.column,
                "unit": UNITS.get(c.name, "") or "1",
                "factor": c.factor,
                "offset": c.offset,
                "range": log.ranges.get(c.name),
            }
            for c in log.channels
        ],
        "other_columns": list(log.unread),
        "samples": found.samples,
        "duration": found.duration,
        "xdot": found.xdot,
        "records": [_record(r) for r in found.records],
        "duty_levels": [{"duty": d, "seconds": s} for d, s in found.seconds_at.items()],
        "noise": _noise(found.noise),
        "mass_at_noise": found.mass,
        "parameters": covers(found.parameters),
        "effects": covers(found.effects),
        "rig": cast(list[RigFaultDocument], found.rig.to_json()),
    }
    if ahead is not None:
        document["forecast"] = {
            "noise_rms": ahead.noise, "effects": undetected(ahead.effects),
        }  # fmt: skip
    if log.labels:
        document["provenance"] = dict(log.labels)
    return document


def covers(found: Sequence[Cover]) -> list[CoverEntry]:
    """What a log can show, one entry for each parameter or effect."""
    return [
        {
            "name": c.name,
            "identifiable": c.lack is None,
            "reason": None if c.lack is None else c.lack.reason,
            "needs": [
                {
                    "what": n.what,
                    "unit": n.unit,
                    "needed": n.needed,
                    "found": n.found,
                    "met": n.met,
                }
                for n in c.checks
            ],
            "drives": list(c.drives),
        }
        for c in found
    ]


def _record(r: RecordSummary) -> RecordEntry:
    return {
        "name": r.name,
        "samples": r.samples,
        "duration": r.duration,
        "rate": r.rate,
        "jitter": r.jitter,
        "gaps": r.gaps,
        "missing_samples": r.missing,
        "longest_gap": r.longest_gap,
        "longest_gap_at": r.gap_at,
        "x": [r.x.low, r.x.high],
        "speed": r.speed,
        "duty": [r.duty.low, r.duty.high],
        "force": _ends(r.force),
        "temperature": _ends(r.temperature),
    }


def _noise(noise: NoiseFloor | None) -> NoiseEntry | None:
    return None if noise is None else {"rms": noise.rms, "resolution": noise.resolution}


def _ends(span: Span | None) -> list[float] | None:
    return None if span is None else [span.low, span.high]


def _range(log: Log, name: str) -> list[float] | None:
    values = log.force_model if name == "force_model" else getattr(log.recording, name, None)
    return None if values is None else _ends(Span.of(values))


def json_schema() -> dict[str, Any]:
    """The published JSON Schema of an inspection."""
    return msgspec.json.schema(InspectionFile)
