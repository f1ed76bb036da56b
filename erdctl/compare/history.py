"""What the logs of one damper say: each parameter in the order of their dates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index

DAY = 86400.0  # s
MONTH = 365.25 / 12  # days
YEAR = 365.25

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False, kw_only=True)
class Series:
    """One parameter, or one score, of one damper.

    name : as in parameter files, or that of a score;  unit : SI
    at : (n,) which logs of the damper tell it;  t : (n,) their dates [days since 1970], ascending,
    NaN without
    value : (n,) NaN where the effect was looked for and not named
    stderr : (n,) NaN without;  low, high : (n,) ends of the 95 % interval, NaN without
    off : value at which the effect is absent; None of what is no part of an effect
    limit : (n,) size from which the effect would have been named, NaN where that is not known
    """

    name: str
    unit: str
    at: Index
    t: Array
    value: Array
    stderr: Array
    low: Array
    high: Array
    off: float | None = None
    limit: Array = field(default_factory=lambda: np.empty(0))

    @property
    def named(self) -> Flags:
        """(n,) where there is a value."""
        return np.isfinite(self.value)

    @property
    def error(self) -> Array:
        """(n,) standard error; half the interval over 1.96 where an interval stands in for it."""
        half = (self.high - self.low) / (2 * 1.96)
        return np.where(np.isfinite(self.stderr), self.stderr, half)

    def __len__(self) -> int:
        return len(self.value)


@dataclass(frozen=True, eq=False)
class Covariance:
    """How the errors of one fit's parameters go together.

    names : (p,);  correlation : (p, p)
    """

    names: tuple[str, ...]
    correlation: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class History:
    """One damper.

    logs : (n,) names, in the order of their dates, or as given where not all have one
    t : (n,) dates [days since 1970], NaN without
    effects : (n,) names of the effects of each log's model;  searched : (n,) whether a diagnosis
    looked for more of them;  settled : (n,) whether nothing was left that no effect explains
    covariances : by number of the log, where its document tells them
    failed : (log, error) of those that could not be read or fitted
    rig : faults of the recordings, with how many logs have each
    """

    damper: str
    corner: str | None = None
    logs: tuple[str, ...]
    t: Array
    series: Mapping[str, Series]
    effects: tuple[frozenset[str], ...] = ()
    searched: tuple[bool, ...] = ()
    settled: tuple[bool, ...] = ()
    covariances: Mapping[int, Covariance] = field(default_factory=dict)
    failed: tuple[tuple[str, str], ...] = ()
    rig: Mapping[str, int] = field(default_factory=dict)

    @property
    def dated(self) -> bool:
        """Whether every log has a date, and they are not all the same."""
        return bool(np.isfinite(self.t).all()) and len(np.unique(self.t)) > 1
