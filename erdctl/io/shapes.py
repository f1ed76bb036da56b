"""The shapes of the JSON documents that erdctl writes for others to read, and their JSON Schemas.

Parameter and geometry files, which erdctl reads as well, have theirs with their readers; the
manifest of a PWM sequence is in `manifest`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NotRequired, TypedDict

import msgspec

from erdctl.io import geometry, inspection, parameters
from erdctl.io.faults import AsFaultDocument, SetsInOnceDocument
from erdctl.io.labels import LabelsDocument
from erdctl.io.manifest import PwmManifest
from erdctl.io.parameters import ParameterFile
from erdctl.io.project import shape as project
from erdctl.io.rig import RigFaultDocument
from erdctl.io.undetected import Limit, UndetectedDocument
from erdctl.io.unlogged import UnloggedStrokes


class Measured(TypedDict):
    """An estimate with its standard error, which is null where there is none, as at a bound.

    interval : 95 %, where it is not value +- 1.96 stderr: one-sided at a bound, or skew
    reason, assumed : why there is no value, and what a simulation uses
    """

    value: float | None
    unit: str
    stderr: float | None
    at_bound: NotRequired[bool]
    interval: NotRequired[tuple[float, float]]
    reason: NotRequired[str]
    assumed: NotRequired[float | None]


class IntervalDocument(TypedDict):
    """Where: xdot, x, duty, t, since_reversal, since_duty_step or dissipated_energy, in SI; or
    record, by its number from 1."""

    variable: str
    low: float
    high: float


class AtDuty(TypedDict):
    """NRMSE and rms [N] at one PWM level."""

    duty: float
    nrmse: float
    rms: NotRequired[float]


class Scores(TypedDict):
    """Error of a model over a log: NRMSE over the range of the force, rms [N]."""

    nrmse: float
    nrmse_by_duty: list[AtDuty]
    rms: float


class Baseline(Scores):
    """Error of the model that was to be answered for; `of` says which that is."""

    of: str
    params: NotRequired[ParameterFile]


class Corrected(Scores):
    """Error of the best model found, and its parameter file."""

    params: ParameterFile


class Mismatch(TypedDict):
    """A region in which misfit gathers; share : part of the misfit energy that lies there.

    time : part of the samples that lies there
    """

    where: IntervalDocument
    share: float
    time: NotRequired[float]
    text: str


class Evidence(TypedDict):
    """Gain on data that the fit had not seen, over its scatter; the next best name."""

    gain_unseen: float
    gain_over_scatter: float
    gain_over_scatter_of_groups: float
    runner_up: str | None


class Heldout(TypedDict):
    """NRMSE on groups left out of the fit, without and with the effect."""

    nrmse_before: float
    nrmse_after: float


class ToTell(TypedDict):
    """A drive, as `simulate --drive` takes it, on which two look-alikes differ [N rms]."""

    drive: str
    difference: float
    unit: str
    against: str


class FindingDocument(TypedDict):
    """One effect that the model had left out."""

    effect: str
    equivalent: list[str]
    text: str
    equation: str
    source: str
    parameters: dict[str, Measured]
    where: IntervalDocument | None
    evidence: Evidence
    heldout: Heldout
    test: NotRequired[ToTell]


class LawCoordinateDocument(TypedDict):
    """What a law depends on, and what of it the log spans."""

    name: str
    unit: str
    low: float
    high: float


class CurveDocument(TypedDict):
    """A law as a table: f [unit], of a factor less 1, over z, or over z and y."""

    z: list[float]
    y: NotRequired[list[float]]
    f: list[float | list[float]]
    unit: str


class LikeLaw(TypedDict):
    """A law that would do as well."""

    slot: str
    coordinates: list[str]


class LearnedDocument(TypedDict):
    """A law that the catalogue does not hold, learned from what no effect explains."""

    slot: str
    coordinates: list[LawCoordinateDocument]
    form: str
    equation: str
    text: str
    parameters: dict[str, Measured]
    curve: CurveDocument
    evidence: Evidence
    heldout: Heldout
    equivalent: list[LikeLaw]
    test: NotRequired[ToTell]


class Remaining(TypedDict):
    """What is left: rms and what of it can be predicted [N], rms over the noise."""

    rms: float
    over_noise: float
    misfit_rms: float
    unlogged: NotRequired[list[UnloggedStrokes]]
    text: str


class PerRecord(TypedDict):
    """Gain and zero of one record, where they were free."""

    name: str
    gain: NotRequired[Measured]
    offset: NotRequired[Measured]


class HeldoutScores(TypedDict):
    """Scores on groups left out of the fit, before and after the correction."""

    groups: int
    before: Scores
    after: Scores


class LeftOut(TypedDict):
    """NRMSE on what was left out of a fit; left_out : what, in so many parts.

    records : that neither fit nor search has seen;  seen_by_search : whether the choice rests on it
    """

    left_out: str
    parts: int
    records: list[str]
    seen_by_search: bool
    nrmse_before: float
    nrmse_after: float
    text: str


class DiagnosisFile(TypedDict):
    """A diagnosis; verdict : adequate, explained or unexplained.

    cannot_tell : whether it is unexplained because so few duties and motions cannot tell what it
        is, or because a channel that stops at a limit cannot tell whether the model holds beyond
    """

    schema: Literal["erdctl.diagnosis/1"]
    verdict: str
    cannot_tell: NotRequired[bool]
    noise_rms: float
    baseline: Baseline
    refitted: NotRequired[Scores]
    mismatch: list[Mismatch]
    findings: list[FindingDocument]
    learned: NotRequired[list[LearnedDocument]]
    corrected: Corrected
    heldout: NotRequired[HeldoutScores]
    unseen: NotRequired[list[LeftOut]]
    withdrawn: NotRequired[list[str]]
    remaining: Remaining
    records: NotRequired[list[PerRecord]]
    sets_in_once: NotRequired[SetsInOnceDocument]
    as_fault: NotRequired[AsFaultDocument]
    with_records: NotRequired[Scores]
    rig: NotRequired[list[RigFaultDocument]]
    not_testable: dict[str, str]
    undetected: NotRequired[list[UndetectedDocument]]
    limits: NotRequired[dict[str, Limit]]
    provenance: dict[str, Any]


class ScoreDocument(TypedDict):
    """Misfit of a group of samples; NRMSE is null for an error on a force without range."""

    nrmse: float | None
    rms: float
    samples: int


class DutyScore(ScoreDocument):
    """Score at one PWM level."""

    duty: float


class DirectionScore(ScoreDocument):
    """Score of compression or release."""

    direction: str


class RecordScore(ScoreDocument):
    """Score of one record."""

    record: str


class DirectionUnknown(TypedDict):
    """Shares of samples and squared error where xdot is noise; the NRMSE of all others."""

    samples: float
    squared_error: float
    nrmse_of_others: float


class ValidationFile(ScoreDocument):
    """Scores of a model on logs.

    normalise : the denominator of the NRMSE
    direction_unknown : where the rod rests or turns, if most of the squared error lies there
    """

    schema: Literal["erdctl.validation/1"]
    normalise: str
    nrmse_by_duty: list[DutyScore]
    nrmse_by_direction: list[DirectionScore]
    nrmse_by_record: list[RecordScore]
    direction_unknown: NotRequired[DirectionUnknown]
    rig: NotRequired[list[RigFaultDocument]]
    provenance: NotRequired[LabelsDocument]


def _of(shape: type) -> Callable[[], dict[str, Any]]:
    return lambda: msgspec.json.schema(shape)


def _comparison() -> dict[str, Any]:
    from erdctl.io.compared import json_schema  # statistics are imported with it

    return json_schema()


SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "parameters": parameters.json_schema,
    "geometry": geometry.json_schema,
    "inspection": inspection.json_schema,
    "validation": _of(ValidationFile),
    "diagnosis": _of(DiagnosisFile),
    "pwm": _of(PwmManifest),
    "project": project.json_schema,
    "comparison": _comparison,
}
