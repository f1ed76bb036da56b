"""The records of a log: their sampling and what they reach, one stretch after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from erdctl.bench.gaps import gaps_of
from erdctl.core.quantiles import median
from erdctl.core.recording import CHANNELS, Array, Recording
from erdctl.core.stretches import Stretch


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
    usual : median step, of what was seen first [s];  first, last : time of both ends [s]
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
    usual: float = 0.0
    first: float = 0.0
    last: float = 0.0

    @property
    def rate(self) -> float:
        """Sampling rate [Hz]."""
        return 1.0 / self.step

    @property
    def speed(self) -> float:
        """Highest speed, in either direction [m/s]."""
        return max(abs(self.xdot.low), abs(self.xdot.high))


class RecordSummaries:
    """A summary of each record.

    Of one that is cut the usual step is that of its first stretch.
    """

    def __init__(self) -> None:
        self.summaries: list[RecordSummary] = []

    def add(self, stretch: Stretch) -> None:
        """The next stretch; its channels are looked at as a whole, since it may hold many tests."""
        own, steps = stretch.own, stretch.recording.step
        spans = {name: _spans(getattr(own, name), own) for name in CHANNELS if name != "t"}
        for i, part in enumerate(own.slices):
            # The step to the sample ahead is one more.
            inner = steps[part.start : part.stop - (not stretch.ahead)]
            before = self.summaries[-1] if stretch.begun else None
            found = _record(own.names[i], own.t[part], inner, before)
            reached: dict[str, Any] = {name: span[i] for name, span in spans.items()}
            found = replace(found, **reached)
            if before is None:
                self.summaries.append(found)
            else:
                self.summaries[-1] = _joined(before, found)


def _spans(channel: Array | None, recording: Recording) -> Sequence[Span | None]:
    if channel is None:
        return [None] * len(recording.names)
    first = recording.starts[:-1]
    ends = (ufunc.reduceat(channel, first).tolist() for ufunc in (np.minimum, np.maximum))
    return [Span(low, high) for low, high in zip(*ends, strict=True)]


_NONE = Span(0.0, 0.0)


def _record(name: str, t: Array, steps: Array, before: RecordSummary | None) -> RecordSummary:
    """The sampling of a record, or of a part of one that goes on from another."""
    if not len(steps):  # the last sample of a record that was cut
        assert before is not None
        return replace(
            before, samples=1, duration=0.0, jitter=0.0, gaps=0, missing=0, longest_gap=0.0,
            gap_at=None, last=float(t[-1]),
        )  # fmt: skip
    step = median(steps) if before is None else before.usual
    # Of a part the step to the sample ahead is one more.
    found = gaps_of(t if len(t) > len(steps) else np.append(t, t[-1] + steps[-1]), steps, step)
    gaps = len(found.at)
    # Rounded times make no gaps, so most records need no copy of their steps.
    even = np.delete(steps, found.at) if gaps else steps
    away = 0.0
    if len(even):
        away = max(float(even.max()) - step, step - float(even.min())) / step
    at = int(found.at[steps[found.at].argmax()]) if gaps else None
    length = float(np.sum(steps)) if before is not None else float(t[-1] - t[0])
    return RecordSummary(
        name=name,
        samples=len(t),
        duration=length,
        step=step if gaps else length / len(steps),
        jitter=max(away, 0.0),
        gaps=gaps,
        missing=int(found.lost.sum()),
        longest_gap=float(steps[found.at].max()) if gaps else 0.0,
        gap_at=None if at is None else float(t[at]),
        x=_NONE, xdot=_NONE, duty=_NONE, force=None, temperature=None,
        usual=step, first=float(t[0]), last=float(t[-1]),
    )  # fmt: skip


def _joined(a: RecordSummary, b: RecordSummary) -> RecordSummary:
    """Two parts of a record as one."""
    gaps, duration = a.gaps + b.gaps, b.last - a.first
    samples = a.samples + b.samples
    longest = a if a.longest_gap >= b.longest_gap else b
    return replace(
        a,
        samples=samples,
        duration=duration,
        step=a.usual if gaps else duration / (samples - 1),
        jitter=max(a.jitter, b.jitter),
        gaps=gaps,
        missing=a.missing + b.missing,
        longest_gap=longest.longest_gap,
        gap_at=longest.gap_at,
        x=_over(a.x, b.x),
        xdot=_over(a.xdot, b.xdot),
        duty=_over(a.duty, b.duty),
        force=None if a.force is None or b.force is None else _over(a.force, b.force),
        temperature=None
        if a.temperature is None or b.temperature is None
        else _over(a.temperature, b.temperature),
        last=b.last,
    )


def _over(a: Span, b: Span) -> Span:
    return Span(min(a.low, b.low), max(a.high, b.high))
