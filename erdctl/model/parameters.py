"""Parameters of a damper as they travel between commands: values, errors, what is not known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

from erdctl.core.recording import Recording
from erdctl.core.version import __version__
from erdctl.model.composed import Model

NORMAL_95 = 1.96  # standard errors to either side that hold 95 %


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """One parameter.

    value : None when the data do not identify it; `assumed` is then what a simulation uses, and
    `reason` says in plain words why
    at_bound : the value is a bound of the parameter, where a standard error says nothing
    within : 95 % interval where it is not value +- 1.96 stderr: one-sided at a bound, or skew
    """

    value: float | None
    unit: str
    stderr: float | None = None
    assumed: float | None = None
    reason: str | None = None
    at_bound: bool = False
    within: tuple[float, float] | None = None

    @property
    def identified(self) -> bool:
        """Whether there is a value."""
        return self.value is not None

    @property
    def interval(self) -> tuple[float, float] | None:
        """95 % interval; None without a value or an error."""
        if self.within is not None or self.value is None or self.stderr is None:
            return self.within
        return self.value - NORMAL_95 * self.stderr, self.value + NORMAL_95 * self.stderr

    @property
    def used(self) -> float:
        """The value, or what a simulation uses in its place."""
        chosen = self.assumed if self.value is None else self.value
        return 0.0 if chosen is None else chosen


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Every parameter of a model by its full name, and where they came from."""

    model: Model
    estimates: Mapping[str, Estimate]
    provenance: Mapping[str, Any] = field(default_factory=dict)
    fits: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @cached_property
    def values(self) -> dict[str, float]:
        """What a simulation uses for every parameter."""
        return {name: e.used for name, e in self.estimates.items()}

    def caveats(self) -> list[str]:
        """One line for every reason why some parameters have no value."""
        by_reason: dict[str, list[str]] = {}
        for name, e in self.estimates.items():
            if not e.identified:
                by_reason.setdefault(e.reason or "no value given", []).append(name)
        return [f"not identified: {', '.join(names)}: {why}" for why, names in by_reason.items()]


def provenance(
    recording: Recording, noise_rms: float, rig: Sequence[Mapping[str, Any]] = ()
) -> dict[str, Any]:
    """Where an estimate comes from: version, logs, what they covered, noise, labels of the test.

    No date but one that was given, so that the same logs give the same file.

    rig : what is wrong with the recording, as documents say it
    """

    def ends(channel: str) -> list[float]:
        values = getattr(recording, channel)
        return [float(values.min()), float(values.max())]

    return {
        "erdctl": __version__,
        "logs": [asdict(source) for source in recording.sources],
        "records": len(recording.names),
        "samples": len(recording),
        "ranges": {name: ends(name) for name in ("x", "xdot", "duty")},
        "xdot": recording.xdot_note,
        "noise_rms": noise_rms,
        **({"rig": [*rig]} if rig else {}),
        **recording.labels,
    }
