"""The shape of the manifest of a PWM sequence; `pwm` fills it in."""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict

from erdctl.io.inspection import LogEntry
from erdctl.io.labels import LabelsDocument


class QuantityDocument(TypedDict):
    """A number with its unit."""

    value: float | None
    unit: str


class LimitsDocument(TypedDict):
    """Limits of the amplifier; null where there is none."""

    duty_max: float
    resolution: float
    slew: QuantityDocument | None
    update_rate: QuantityDocument | None


class Hashed(TypedDict):
    """The SHA-256 of a file's bytes."""

    sha256: str


class Emulation(TypedDict):
    """How near one fault can be mimicked on one damper: NRMSE and the force out of reach."""

    channel: str
    fault: str
    nrmse_compensated: float
    nrmse_paper: float
    nrmse_plain: NotRequired[float]
    out_of_reach: float
    missing_rms: QuantityDocument
    missing_max: QuantityDocument


class CorrectionDocument(TypedDict):
    """What the effects beyond the paper are worth for the sequence of one damper."""

    channel: str
    effects: list[str]
    effects_of_the_force_channel: list[str]
    nrmse: float
    nrmse_plain: float
    error_removed: float
    fell_back: bool


class ChannelCheck(TypedDict):
    """How near a channel comes to the limits: highest duty, closest and steepest changes."""

    channel: str
    highest: float
    changes: int
    closest: QuantityDocument | None
    steepest: QuantityDocument | None


class LimitCheck(TypedDict):
    """That every duty keeps the limits, checked after the computation."""

    held: bool
    channels: list[ChannelCheck]


class BreachDocument(TypedDict):
    """A limit that the healthy duty as given breaks: how often, where first, by what value."""

    limit: str
    samples: int
    row: int
    time: QuantityDocument
    value: float
    allowed: float


class HealthyDocument(TypedDict):
    """Samples at which the healthy duty could not go out as given, and why."""

    samples_changed: int
    breaks: list[BreachDocument]


class WayBack(TypedDict):
    """Samples after a fault's end until the amplifier is back at the healthy duty."""

    channel: str
    samples: int


class TemperatureDocument(TypedDict):
    """What held the limit on the temperature: read from a column, declined, or none in the log."""

    guard: Literal["read", "declined", "none"]
    column: str | None
    unit: str | None
    hottest: QuantityDocument | None
    limit: QuantityDocument | None
    not_read: list[str]


class PwmManifest(TypedDict):
    """What whoever pushes a PWM sequence must know."""

    schema: Literal["erdctl.pwm/1"]
    erdctl: str
    carrier: QuantityDocument
    full_scale: QuantityDocument
    channels: list[str]
    limits: LimitsDocument
    check: LimitCheck
    healthy: HealthyDocument
    temperature: TemperatureDocument
    parameters: Hashed
    logs: list[LogEntry]
    samples: int
    sequence: str
    schedule: list[str]
    emulation: list[Emulation]
    way_back: list[WayBack]
    correction: list[CorrectionDocument]
    provenance: NotRequired[LabelsDocument]
