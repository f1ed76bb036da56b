"""What is in a log before anybody fits anything: records, rates, gaps, ranges, noise, coverage."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from erdctl.bench import identifiability as coverage
from erdctl.bench.accelerations import Accelerations
from erdctl.bench.counts import Counts
from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import Cover
from erdctl.bench.records import RecordSummaries, RecordSummary, Span
from erdctl.bench.rig import Looking, Rig
from erdctl.core.cache import parts
from erdctl.core.quantiles import median
from erdctl.core.recording import Array, Index, Recording
from erdctl.core.stretches import Gathered, Stretch, stretches
from erdctl.model.effect import Effect
from erdctl.score.nrmse import BINS, bins, bins_of, levels_of, percents

__all__ = ["Inspecting", "Inspection", "NoiseFloor", "RecordSummary", "Span", "inspect"]

PIECE = 4_000  # samples of the stretches that the noise is taken from
STRETCHES = 100
ORDER = 3  # of the differences that take the motion out of the force


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
    inspecting = Inspecting(recording.starts, recording.names)
    for part in stretches(recording):
        inspecting.add(part)
    found = inspecting.found(candidates, recording.xdot_note)
    return replace(found, rig=replace(found.rig, recording=recording))


class Inspecting:
    """The same over one stretch of a log after the other.

    starts, names : offsets and names of its records
    """

    def __init__(self, starts: Index, names: tuple[str, ...]) -> None:
        self.samples = int(starts[-1])
        self._counts, self._accelerations = Counts(starts), Accelerations(starts)
        self._looking = Looking(starts, names)
        self._noise = Gathered(noise_extents(starts))
        self._records = RecordSummaries()
        self._percents, self._bins = np.zeros(101), np.zeros(len(BINS))
        self._force = False

    def add(self, stretch: Stretch) -> None:
        """The next stretch."""
        self._counts.add(stretch)
        self._accelerations.add(stretch)
        self._looking.add(stretch)
        self._records.add(stretch)
        own, step = stretch.own, stretch.recording.step[: len(stretch)]
        self._force = own.force is not None
        if self._force:
            self._noise.add(stretch)
        for part in parts(len(own)):
            duty, seconds = own.duty[part], step[part]
            self._percents += np.bincount(percents(duty)[0], seconds, len(self._percents))
            self._bins += np.bincount(bins(duty), seconds, len(self._bins))

    def found(self, candidates: Sequence[Effect], xdot: str) -> Inspection:
        """What there is to say of all of it; xdot : how that was obtained."""
        survey = Survey(lambda: self._counts, self._accelerations.beyond_a_spring)
        records = tuple(self._records.summaries)
        noise = None
        if self._force:
            noise = noise_floor([b.force for b in self._noise.blocks() if b.force is not None])
        free = survey.acceleration
        return Inspection(
            samples=self.samples,
            duration=sum(r.duration for r in records),
            records=records,
            seconds_at=self._seconds_at(),
            noise=noise,
            mass=noise.rms / free if noise and free > 0 else None,
            xdot=xdot,
            parameters=tuple(coverage.parameters(survey)),
            effects=tuple(coverage.effects(survey, candidates)),
            rig=self._looking.rig(),
        )

    def _seconds_at(self) -> dict[float, float]:
        seen = self._counts.percents
        seconds: Array = self._percents
        levels, present = levels_of(seen)
        if present is None:
            # A last sample may be alone in its bin, and have no time.
            (levels, present), seconds = bins_of(self._counts.bins), self._bins
        return dict(zip(levels.tolist(), seconds[present].tolist(), strict=True))


def noise_extents(starts: Index) -> list[tuple[int, int]]:
    """The samples that the noise of the force is taken from."""
    pieces = [
        (a, min(a + PIECE, end))
        for first, end in pairwise(starts.tolist())
        for a in range(first, end, PIECE)
        if min(a + PIECE, end) - a > ORDER
    ]
    return pieces[:: -(-len(pieces) // STRETCHES)] if pieces else []


def force_noise(recording: Recording) -> NoiseFloor | None:
    """Noise of the force of a recording; see `noise_floor`."""
    force = recording.force
    if force is None:
        raise ValueError("the recording has no measured force")
    return noise_floor([force[a:b] for a, b in noise_extents(recording.starts)])


def noise_floor(pieces: Sequence[Array]) -> NoiseFloor | None:
    """Noise of the force that motion cannot make: what third differences hold of it.

        rms = median |d3 F| / (0.6745 sqrt(20)),   d3 F = F_i - 3 F_i-1 + 3 F_i-2 - F_i-3

    A smooth force has third differences of the order of the step cubed; the median does not see
    the jumps at reversals. Exact for white noise; noise slower than a few samples is seen in part,
    and the rounding of the force, step / sqrt(12), is the least that there is.

    pieces : (n,) of the force each, of more than 3 samples [N]
    Check: white noise of 0.3 N rms on any slow force gives 0.3 N within the scatter of a median.
    >>> noise = np.random.default_rng(1).normal(0.0, 0.3, 20_000)
    >>> slow = 10.0 * np.sin(np.arange(20_000) * 1e-3)
    >>> round(noise_floor([slow + noise]).rms, 1)
    0.3
    """
    if not pieces:
        return None
    differences = np.concatenate([np.diff(p, ORDER) for p in pieces])
    values = np.sort(np.concatenate(pieces))
    between = np.diff(values)
    # Values of one level may differ by the rounding of their binary form.
    apart = between[between > 1e-9 * max(float(np.abs(values[[0, -1]]).max()), 1e-300)]
    resolution = float(apart.min()) if apart.size else 0.0
    rms = median(np.abs(differences)) / (0.6745 * math.sqrt(20.0))
    return NoiseFloor(max(rms, resolution / math.sqrt(12.0)), resolution)
