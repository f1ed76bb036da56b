"""What is in a log before anybody fits anything: records, rates, gaps, ranges, noise, coverage."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from erdctl.bench import identifiability as coverage
from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import Cover
from erdctl.bench.rig import Rig, look
from erdctl.core.cache import parts
from erdctl.core.quantiles import median
from erdctl.core.recording import CHANNELS, Array, Recording
from erdctl.model.effect import Effect
from erdctl.score.nrmse import duty_levels

GAP = 1.5  # steps of a record; a longer one has lost samples
PIECE = 4_000  # samples of the stretches that the noise is taken from
STRETCHES = 100
ORDER = 3  # of the differences that take the motion out of the force


@dataclass(frozen=True)
class Span:
    """Lowest and highest value of a channel."""

    low: float
    high: float

    @classmethod
    def of(cls, values: Array) -> Span:
        """The span of (n,) values."""
        return cls(float(values.min()), float(values.max()))


@dataclass(frozen=True)
class RecordSummary:
    """One record: its sampling, and what the motion and the force reached.

    duration : from the first to the last sample [s];  step : the usual one [s]
    jitter : how far steps differ from it, gaps apart [1];  gaps : number of longer steps
    missing : samples that these have lost;  longest_gap : [s];  gap_at : time of its start [s]
    """

    name: str
    samples: int
    duration: float
    step: float
    jitter: float
    gaps: int
    missing: int
    longest_gap: float
    gap_at: float | None
    x: Span
    xdot: Span
    duty: Span
    force: Span | None
    temperature: Span | None

    @property
    def rate(self) -> float:
        """Sampling rate [Hz]."""
        return 1.0 / self.step

    @property
    def speed(self) -> float:
        """Highest speed, in either direction [m/s]."""
        return max(abs(self.xdot.low), abs(self.xdot.high))


@dataclass(frozen=True)
class NoiseFloor:
    """A guess from the force alone, before any model.

    rms : of the part that changes from sample to sample [N], a lower bound of slower noise
    resolution : smallest step between two values of the force [N]
    """

    rms: float
    resolution: float


@dataclass(frozen=True)
class Inspection:
    """Everything that a log says of itself.

    seconds_at : time at each duty level [s], the levels as `validate` groups them
    noise : None without a force;  mass : whose inertia would equal that noise [kg], None for any
    parameters, effects : what the log can and cannot show;  rig : what is wrong with it
    """

    samples: int
    duration: float
    records: tuple[RecordSummary, ...]
    seconds_at: dict[float, float]
    noise: NoiseFloor | None
    mass: float | None
    xdot: str
    parameters: tuple[Cover, ...]
    effects: tuple[Cover, ...]
    rig: Rig


def inspect(recording: Recording, candidates: Sequence[Effect]) -> Inspection:
    """Inspect a recording, with force or without, against a catalogue of effects."""
    survey = Survey.of(recording)
    records = tuple(_records(recording))
    noise = None if recording.force is None else force_noise(recording)
    free = survey.acceleration
    return Inspection(
        samples=len(recording),
        duration=sum(r.duration for r in records),
        records=records,
        seconds_at=_seconds_at(recording),
        noise=noise,
        mass=noise.rms / free if noise and free > 0 else None,
        xdot=recording.xdot_note,
        parameters=tuple(coverage.parameters(survey)),
        effects=tuple(coverage.effects(survey, candidates)),
        rig=look(recording),
    )


def _records(recording: Recording) -> Iterator[RecordSummary]:
    """Every record. Channels are looked at as a whole, since a log may hold many thousand tests."""
    spans = {name: _spans(getattr(recording, name), recording) for name in CHANNELS}
    for i, part in enumerate(recording.slices):
        yield _record(recording, i, part, {name: span[i] for name, span in spans.items()})


def _spans(channel: Array | None, recording: Recording) -> Sequence[Span | None]:
    if channel is None:
        return [None] * len(recording.names)
    first = recording.starts[:-1]
    ends = (ufunc.reduceat(channel, first).tolist() for ufunc in (np.minimum, np.maximum))
    return [Span(low, high) for low, high in zip(*ends, strict=True)]


def _record(
    recording: Recording, index: int, part: slice, span: Mapping[str, Any]
) -> RecordSummary:
    t = recording.t[part]
    steps = recording.step[part][:-1]
    step = median(steps)
    long = steps > GAP * step
    gaps = int(np.count_nonzero(long))
    # Rounded times make no gaps, so most records need no copy of their steps.
    even = steps if gaps == 0 else steps[~long]
    away = max(float(even.max()) - step, step - float(even.min())) / step
    at = int(steps.argmax()) if gaps else None
    length = float(t[-1] - t[0])
    return RecordSummary(
        name=recording.names[index],
        samples=len(t),
        duration=length,
        step=step if gaps else length / len(steps),
        jitter=max(away, 0.0),
        gaps=gaps,
        missing=int((np.round(steps[long] / step) - 1.0).sum()) if gaps else 0,
        longest_gap=float(steps.max()) if gaps else 0.0,
        gap_at=None if at is None else float(t[at]),
        **{name: span[name] for name in CHANNELS if name != "t"},
    )


def _seconds_at(recording: Recording) -> dict[float, float]:
    codes, levels = duty_levels(recording.duty)
    seconds = np.zeros(len(levels))
    for part in parts(len(codes)):
        seconds += np.bincount(codes[part], weights=recording.step[part], minlength=len(levels))
    return dict(zip(levels.tolist(), seconds.tolist(), strict=True))


def force_noise(recording: Recording) -> NoiseFloor | None:
    """Noise of the force that motion cannot make: what third differences hold of it.

        rms = median |d3 F| / (0.6745 sqrt(20)),   d3 F = F_i - 3 F_i-1 + 3 F_i-2 - F_i-3

    A smooth force has third differences of the order of the step cubed; the median does not see
    the jumps at reversals. Exact for white noise; noise slower than a few samples is seen in part,
    and the rounding of the force, step / sqrt(12), is the least that there is.
    Check: white noise of 0.3 N rms on any slow force gives 0.3 N within the scatter of a median.
    >>> noise = np.random.default_rng(1).normal(0.0, 0.3, 20_000)
    >>> slow = 10.0 * np.sin(np.arange(20_000) * 1e-3)
    >>> round(force_noise(recording(np.zeros(20_000), force=slow + noise)).rms, 1)
    0.3
    """
    force = recording.force
    if force is None:
        raise ValueError("the recording has no measured force")
    pieces = [
        slice(a, min(a + PIECE, part.stop))
        for part in recording.slices
        for a in range(part.start, part.stop, PIECE)
        if min(a + PIECE, part.stop) - a > ORDER
    ]
    if not pieces:
        return None
    chosen = pieces[:: -(-len(pieces) // STRETCHES)]
    differences = np.concatenate([np.diff(force[p], ORDER) for p in chosen])
    values = np.sort(np.concatenate([force[p] for p in chosen]))
    between = np.diff(values)
    # Values of one level may differ by the rounding of their binary form.
    apart = between[between > 1e-9 * max(float(np.abs(values[[0, -1]]).max()), 1e-300)]
    resolution = float(apart.min()) if apart.size else 0.0
    rms = median(np.abs(differences)) / (0.6745 * math.sqrt(20.0))
    return NoiseFloor(max(rms, resolution / math.sqrt(12.0)), resolution)
