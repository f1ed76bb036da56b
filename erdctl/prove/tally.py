"""Rates of a group of cases, and the verdict that a case deserves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import mean, median

from erdctl.prove.case import LEFT_OUT
from erdctl.prove.judge import Result

STRONG = 1.0  # misfit over noise from which the attainable reduction is counted


@dataclass(frozen=True)
class Rate:
    """So many of so many."""

    hits: int
    of: int

    @property
    def share(self) -> float | None:
        """As a number, None of nothing."""
        return self.hits / self.of if self.of else None


@dataclass(frozen=True)
class Tally:
    """Rates of a group of cases; a rate of nothing where a question does not arise.

    named : first finding right;  wrong : first finding wrong
    all_found : every hidden effect has its finding
    spurious : findings per case that match nothing hidden
    right : verdict as it should be for what is hidden
    first_place : the place listed first is a true one, of the misfit or of the effect's own force
    removed : attainable reduction: the error removed, over what the true structure removes; median
    lies : a law that was learned has slot and coordinates of what is hidden, or says so of another
    learned : something was learned;  cut : part of the paper's error that is removed; median
    """

    label: str
    cases: int
    named: Rate
    wrong: Rate
    all_found: Rate
    adequate: Rate
    explained: Rate
    unexplained: Rate
    right: Rate
    located: Rate
    first_place: Rate
    spurious: float | None
    removed: float | None
    removed_of: int
    learned: Rate
    lies: Rate
    cut: float | None


def group(label: str, results: Sequence[Result]) -> Tally:
    """Rates of some results."""
    named = [r.named for r in results if r.named is not None]
    hiding = [r for r in results if r.named is not None]
    places = [r.located for r in results if r.located is not None]
    places_of = [r.lies for r in results if r.lies is not None]
    first = [r.first_place for r in results if r.first_place is not None]
    parts = [r.fresh.removed for r in hiding if r.level >= STRONG and r.fresh.removed is not None]

    def verdicts(verdict: str) -> Rate:
        return Rate(sum(r.verdict == verdict for r in results), len(results))

    return Tally(
        label=label,
        cases=len(results),
        named=Rate(named.count(True), len(named)),
        wrong=Rate(sum(bool(r.findings) and not r.named for r in hiding), len(hiding)),
        all_found=Rate(sum(r.matched == len(r.hidden) for r in hiding), len(hiding)),
        adequate=verdicts("adequate"),
        explained=verdicts("explained"),
        unexplained=verdicts("unexplained"),
        right=Rate(sum(is_due(r) for r in results), len(results)),
        located=Rate(places.count(True), len(places)),
        first_place=Rate(first.count(True), len(first)),
        spurious=mean(r.spurious for r in results) if results else None,
        removed=median(parts) if parts else None,
        removed_of=len(parts),
        learned=Rate(sum(bool(r.learned) for r in results), len(results)),
        lies=Rate(places_of.count(True), len(places_of)),
        cut=median(r.fresh.cut for r in results) if results else None,
    )


def due(r: Result) -> str:
    """The verdict that a case deserves."""
    strangers = {"unknown": "unexplained", LEFT_OUT: "unexplained"}
    return {"null": "adequate", **strangers}.get(r.kind, "explained")


def is_due(r: Result) -> bool:
    """Whether a case has the verdict that it deserves; of few data only that no wrong name
    explains them."""
    return not explained_wrongly(r) if r.kind == "sparse" else r.verdict == due(r)


def explained_wrongly(r: Result) -> bool:
    """Whether what was found is said to be all, and some of it is not there."""
    return r.verdict == "explained" and r.spurious > 0
