"""A fault that sets in once, in one of several records, which no law in every record's time says.

The time of a record begins anew with it, and a law in that time sets in in every record. A damper
that fails in the fourth of six drives has failed in the fifth and sixth as well; a fault that was
mimicked in one drive is in no other. Both are sought on what the search leaves: all times of all
records in their order, and all times of the records with most misfit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, running_time
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.estimate.onset_profile import OF_A_STEP, Onset, Profile
from erdctl.estimate.onsets import profile
from erdctl.model.effect import Effect
from erdctl.model.onset import START


@dataclass(frozen=True)
class Confirmed:
    """What is found where records follow one another: other names, and what is left [N rms].

    share : part of the square of what was missing that all of them take [1]
    alike : other faults from which the data do not tell it
    """

    share: float
    alike: tuple[str, ...]
    beside: tuple[str, ...]
    explained: bool
    rms: float


@dataclass(frozen=True, eq=False)
class SetsInOnce:
    """A fault as `effect` describes it, from a time in one record on.

    record : its number;  at : 95 % interval of the onset [s], in the time of that record
    f : effectiveness that is left [1];  stays : whether later records have it from their begin
    kinds : of faults that it may be, `effect` among them
    confirmed : what a search with it says
    """

    effect: Effect
    record: int
    at: tuple[float, float]
    f: float
    stays: bool
    kinds: tuple[Effect, ...]
    confirmed: Confirmed | None = None

    @property
    def when(self) -> str:
        """The time of its onset, in words."""
        low, high = (f"{end:.2f}" for end in self.at)
        return f"{low} s" if low == high else f"{low} to {high} s"


@dataclass(frozen=True, eq=False)
class _Clock:
    """A time in which an onset is sought: (n,) [s] of every sample, and whether a fault stays."""

    t: Array
    stays: bool


@dataclass(frozen=True, eq=False)
class _Seen:
    """What an onset of a fault in a time takes of a residual."""

    effect: Effect
    clock: _Clock
    at: Profile
    onset: Onset

    @property
    def taken(self) -> float:
        """Of the square, weighted [N^2]."""
        return self.at.square - self.onset.square

    @property
    def ratio(self) -> float:
        """Likelihood ratio against none."""
        return self.at.ratio(Onset(1.0, self.onset.t_0, self.onset.t_r, self.at.square), self.onset)


def sets_in_once(
    best: Hypothesis, candidates: Sequence[Effect], misfit_rms: float
) -> SetsInOnce | None:
    """The fault that takes most of what is left, if its time shows, and a second search is due.

    misfit_rms : what is known to be missing [N]; of that it must seem to take a part
    """
    seen = _strongest(best, candidates)
    misfit = misfit_rms**2 * float(best.problem.block.weight.sum())
    if (
        seen is None
        or seen.taken < thresholds.SEEMS_ONCE * misfit
        or seen.ratio < thresholds.ONCE_RATIO
    ):
        return None
    inside = _inside(best.problem.block.signals, seen)
    if inside is None:
        return None
    kinds = _kinds(best, candidates)
    return SetsInOnce(seen.effect, *inside, seen.onset.f, seen.clock.stays, kinds)


def ratio_of_once(best: Hypothesis, candidates: Iterable[Effect]) -> float:
    """The likelihood ratio that decides; 0 where nothing sets in within a record."""
    seen = _strongest(best, candidates)
    inside = seen is not None and _inside(best.problem.block.signals, seen)
    return seen.ratio if seen is not None and inside else 0.0


def _strongest(best: Hypothesis, candidates: Iterable[Effect]) -> _Seen | None:
    s, weight = best.problem.block.signals, best.problem.block.weight
    faults = _kinds(best, candidates)
    if len(best.problem.recording.names) < 2 or not faults:
        return None
    lever = np.sqrt(weight)

    def tried(effect: Effect, clock: _Clock) -> _Seen:
        at = profile(
            best.model, effect, s, best.residual * lever, lever, best.values,
            best.problem.held, clock.t,
        )  # fmt: skip
        return _Seen(effect, clock, at, at.best())

    # All kinds in all times: in the wrong time the right one can take less than another one there.
    clocks = _clocks(s, weight * best.residual**2)
    return max(
        (tried(effect, clock) for clock in clocks for effect in faults), key=lambda seen: seen.taken
    )


def _kinds(best: Hypothesis, candidates: Iterable[Effect]) -> tuple[Effect, ...]:
    found = [e for e in candidates if e.sets_in and e not in best.effects]
    return tuple(sorted(found, key=lambda e: e.name))


def _clocks(s: Signals, square: Array) -> list[_Clock]:
    """The times of all records one after the other, and of single ones after all others."""
    step, firsts, lasts = s.typical_step, s.t[s.starts[:-1]], s.t[s.starts[1:] - 1]
    clocks = []
    if np.any(firsts[1:] < lasts[:-1]):  # else the law in the time of the log says it
        clocks.append(_Clock(running_time(s.t, s.starts), True))
    mean = np.add.reduceat(square, s.starts[:-1]) / np.diff(s.starts)
    for record in np.argsort(-mean)[: thresholds.ONCE_RECORDS]:
        t = np.full(len(s), firsts[record] - step)
        own = slice(s.starts[record], s.starts[record + 1])
        t[own] = s.t[own]
        clocks.append(_Clock(t, False))
    return clocks


def _inside(s: Signals, seen: _Seen) -> tuple[int, tuple[float, float]] | None:
    """Record and interval of an onset that lies in one record, ramp and all; else None."""
    low, high = seen.at.interval(seen.onset, START, OF_A_STEP)
    for record, (a, b) in enumerate(pairwise(s.starts.tolist())):
        first, last = seen.clock.t[a], seen.clock.t[b - 1]
        if first < low and high + seen.onset.t_r < last:
            back = float(s.t[a] - first)
            return record, (low + back, high + back)
    return None
