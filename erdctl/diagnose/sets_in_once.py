"""A fault that sets in once, which no law in every record's own time says.

The time of a record begins anew with it, and a law in that time sets in in every record. A damper
that fails in the fourth of six drives has failed in the fifth and sixth as well; a fault that was
mimicked in one drive is in no other; and one that was there from the beginning of some drives is in
these all along. All are sought on what the search leaves: all times of all records in their order,
all times of the records with most misfit, and the records whose gains set them apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import Array, Index, Recording, running_time
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.records_with_a_fault import apart, is_no_law, seems_no_scatter, telling
from erdctl.estimate.onset_profile import OF_A_STEP, ROUNDED, Onset, Profile
from erdctl.estimate.onsets import profile
from erdctl.model.checked import GROUPS
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

    order : records in that order in which it sets in once, those without it first
    first : the place in it of the record in which it sets in
    whole : whether that record has it from its beginning
    at : 95 % interval of the onset [s], in the time of that record;  f : effectiveness left [1]
    kinds : of faults that it may be, `effect` among them
    silent : records that would show no fault if they had it, as an electrical one at no duty
    confirmed : what a search with it says
    """

    effect: Effect
    order: tuple[int, ...]
    first: int
    whole: bool
    at: tuple[float, float]
    f: float
    kinds: tuple[Effect, ...]
    silent: frozenset[int] = frozenset()
    confirmed: Confirmed | None = None

    @property
    def record(self) -> int:
        """The record in which it sets in."""
        return self.order[self.first]

    @property
    def records(self) -> tuple[int, ...]:
        """All that have it, the one in which it sets in first."""
        return self.order[self.first :]

    def in_order(self, recording: Recording) -> Recording:
        """Its records in that order, in a time that goes on over them."""
        ordered = recording.select(self.order)
        return replace(ordered, t=running_time(ordered.t, ordered.starts))

    @property
    def stays(self) -> bool:
        """Whether it is in all records behind that, of which there are some."""
        records, last = self.records, len(self.order) - 1
        return len(records) > 1 and records == tuple(range(records[0], last + 1))

    @property
    def odd(self) -> tuple[int, ...]:
        """Records to look at: those that have it, or the few that have not, whatever the reason."""
        without = tuple(r for r in self.order[: self.first] if r not in self.silent)
        few = self.whole and not self.stays and 0 < len(without) < len(self.records)
        return without if few else self.records

    @property
    def may_be_a_gain(self) -> bool:
        """Whether it, or what the data do not tell from it, takes a part of all forces alike."""
        return any(set(GROUPS) <= {*e.sets_in} for e in self._alike)

    @property
    def may_be_a_duty(self) -> bool:
        """The same of the yield force alone, as another duty than is logged does."""
        return any(e.sets_in == ("yield",) for e in self._alike)

    @property
    def _alike(self) -> list[Effect]:
        names = (self.effect.name, *(self.confirmed.alike if self.confirmed else ()))
        return [e for e in self.kinds if e.name in names]

    def of_those(self, telling: Iterable[int], begins: Array) -> SetsInOnce:
        """The same of the records that tell of it alone; where it stays, from the first that does.

        begins : (r,) time of each record's first sample [s]
        """
        told = {*telling}
        having = tuple(r for r in self.records if r in told)
        if self.stays and having:
            having = self.records[self.records.index(having[0]) :]
        if having in ((), self.records):
            return self
        order = (*sorted({*self.order} - {*having}), *having)
        whole, begin = self.whole or having[0] != self.record, float(begins[having[0]])
        at = (begin, begin) if whole else self.at
        return replace(self, order=order, first=len(order) - len(having), whole=whole, at=at)

    def named(self, names: Sequence[str]) -> str:
        """The records to look at, in words."""
        own = ", ".join(repr(names[r]) for r in self.odd)
        return f"record{'s' * (len(self.odd) > 1)} {own}"

    @property
    def when(self) -> str:
        """The time of its onset, in words."""
        low, high = (f"{end:.2f}" for end in self.at)
        return f"{low} s" if low == high else f"{low} to {high} s"

    def set_in(
        self, recording: Recording, t: Array, at: Profile, onset: Onset
    ) -> SetsInOnce | None:
        """The same with the record of an onset and its interval there; None if all have it.

        Between two records more faults begin than between two samples: an onset is that of a
        record unless it is as unlikely as one of all samples would have to be.
        t : (n,) time of the samples of `order` in which it sets in once [s];  at : its profile
        """
        lengths = np.diff(recording.starts)[list(self.order)]
        ends = np.cumsum(lengths)
        begins, last = t[ends - lengths], t[ends - 1]
        between = 0.5 * (last[:-1] + begins[1:])
        even = ROUNDED * at.step
        first = int(np.searchsorted(between - even, onset.t_0, "right"))
        most = OF_A_STEP + 2.0 * float(np.log(len(t)))
        near = [k for k in (first, first + 1) if 0 < k < len(begins) and begins[k] > begins[k - 1]]
        ratios = {
            k: at.ratio(at.least(float(between[k - 1]), 0.0, onset.f), onset) for k in near
        }  # fmt: skip
        likely = min(ratios, key=lambda k: ratios[k], default=0)
        whole = bool(ratios) and bool(ratios[likely] <= most)
        first = likely if whole else first
        low, high = at.interval(onset, START, OF_A_STEP)
        if not whole and low <= begins[0] + even:
            return None
        own = recording.slices[self.order[first]]
        back = float(recording.t[own][0] - begins[first])
        within = (float(np.clip(end, begins[first], last[first])) + back for end in (low, high))
        order = self.order
        if whole:
            order = (*order[:first], *sorted(order[first:]))
        return replace(self, order=order, first=first, whole=whole, at=(next(within), next(within)))


@dataclass(frozen=True, eq=False)
class _Clock:
    """A time in which an onset is sought: (n,) [s] of every sample, and the order of records."""

    t: Array
    order: tuple[int, ...]


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

    misfit_rms : what is known to be missing [N]; of that it must seem to take a part. For one that
    is in whole records nothing but their levels speaks, and it must be beyond a rig's.
    """
    found = _strongest(best, candidates)
    if found is None:
        return None
    seen, once = found
    recording = best.problem.recording
    # A record that shows nothing of it takes as much with it as without: rounding would tell.
    once = once.of_those(telling(best, once.effect), recording.t[recording.starts[:-1]])
    misfit = misfit_rms**2 * float(best.problem.block.weight.sum())
    if seen.taken < thresholds.SEEMS_ONCE * misfit or seen.ratio < thresholds.ONCE_RATIO:
        return None
    whole = best, once.effect, once.f, once.records
    if once.whole and not (seems_no_scatter(*whole) and is_no_law(*whole)):
        return None
    return once


def ratio_of_once(best: Hypothesis, candidates: Sequence[Effect]) -> float:
    """The likelihood ratio that decides; 0 where nothing sets in within a record."""
    found = _strongest(best, candidates)
    return found[0].ratio if found is not None and not found[1].whole else 0.0


def _strongest(best: Hypothesis, candidates: Iterable[Effect]) -> tuple[_Seen, SetsInOnce] | None:
    """What takes most of all that lies in one record, or begins with one."""
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
    clocks = _clocks(best, faults)
    seen = [tried(effect, clock) for clock in clocks for effect in faults]
    seen.sort(key=lambda one: -one.taken)
    for one in seen:
        if one.taken < thresholds.ONCE_NEARLY * seen[0].taken:
            break
        once = _once(best, candidates, one)
        if once is not None:
            return one, once
    return None


def _kinds(best: Hypothesis, candidates: Iterable[Effect]) -> tuple[Effect, ...]:
    found = [e for e in candidates if e.sets_in and e not in best.effects]
    return tuple(sorted(found, key=lambda e: e.name))


def _clocks(best: Hypothesis, faults: Sequence[Effect]) -> list[_Clock]:
    """The times of all records one after the other, and of some after all others."""
    s, square = best.problem.block.signals, best.problem.block.weight * best.residual**2
    count = len(s.starts) - 1
    everyone = tuple(range(count))
    clocks = {everyone: running_time(s.t, s.starts)}
    mean = np.add.reduceat(square, s.starts[:-1]) / np.diff(s.starts)
    alone = [(int(r),) for r in np.argsort(-mean)[: thresholds.ONCE_RECORDS]]
    for last in (*alone, *(apart(best, fault) for fault in faults)):
        order = (*(r for r in everyone if r not in last), *last)
        if order not in clocks and len(last) < count:
            clocks[order] = _behind(s.t, s.starts, last, s.typical_step)
    if np.all(s.t[s.starts[1:-1]] >= s.t[s.starts[1:-1] - 1]):
        del clocks[everyone]  # the law in the time of the log says it
    return [_Clock(t, order) for order, t in clocks.items()]


def _behind(t: Array, starts: Index, last: Sequence[int], step: float) -> Array:
    """(n,) time that goes on over some records, before which all others lie at one moment [s]."""
    rows = np.concatenate([np.arange(starts[r], starts[r + 1]) for r in last])
    own = running_time(t[rows], np.cumsum([0, *(starts[r + 1] - starts[r] for r in last)]))
    out = np.full(len(t), own[0] - step)
    out[rows] = own
    return out


def _once(best: Hypothesis, candidates: Iterable[Effect], seen: _Seen) -> SetsInOnce | None:
    """The record and the time of an onset, ramp and all."""
    s, recording = best.problem.block.signals, best.problem.recording
    rows = np.concatenate([np.arange(s.starts[r], s.starts[r + 1]) for r in seen.clock.order])
    kinds, onset = _kinds(best, candidates), seen.onset
    blank = SetsInOnce(seen.effect, seen.clock.order, 0, False, (0.0, 0.0), onset.f, kinds)
    once = blank.set_in(recording, seen.clock.t[rows], seen.at, onset)
    if once is None:
        return None
    ends = float(recording.t[recording.slices[once.record]][-1])
    return once if once.whole or once.at[1] + onset.t_r < ends else None
