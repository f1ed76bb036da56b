"""Figures of the kinds of cases that are drawn only when asked for: crowded, sparse, left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from erdctl.prove.judge import Result
from erdctl.prove.tally import Rate, Tally, explained_wrongly, group

MOSTLY = 0.95  # of what the true structure removes


@dataclass(frozen=True)
class Crowded:
    """Crowded cases; in `group`, named is the strong one first.

    mostly : cases in which MOSTLY of what the true structure removes is removed
    worse : corrected models that do worse on fresh records than the paper's
    """

    group: Tally
    mostly: Rate
    worse: Rate


@dataclass(frozen=True)
class Sparse:
    """Sparse cases, split by whether something is hidden.

    wrong : `explained`, and a finding that is not hidden;  right : `explained` by what is
    undecided : it is said that one condition cannot tell
    silent : `adequate`;  unexplained : and not undecided
    held : parameters at the true model whose interval holds the truth
    """

    label: str
    cases: int
    wrong: Rate
    right: Rate
    undecided: Rate
    silent: Rate
    unexplained: Rate
    held: Rate


@dataclass(frozen=True)
class LeftOutEffect:
    """Cases of one effect that was taken out of the catalogue.

    said : what was named or learned in its place, the most frequent first, with how often
    """

    group: Tally
    said: tuple[tuple[str, int], ...]


def left_out(results: Sequence[Result]) -> tuple[LeftOutEffect, ...]:
    """Of some such cases, by effect; the first is of all."""
    hidden = sorted({r.hidden[0].effect for r in results})
    groups = [("all", results)] if results else []
    groups += [(name, [r for r in results if r.hidden[0].effect == name]) for name in hidden]
    return tuple(LeftOutEffect(group(label, some), _said(some)) for label, some in groups)


def _said(results: Sequence[Result]) -> tuple[tuple[str, int], ...]:
    said = (s for r in results for s in (*(f.effect for f in r.findings), *r.learned))
    return tuple(Counter(said).most_common())


def crowded(results: Sequence[Result]) -> Crowded:
    """Of some crowded cases."""
    parts = [r.fresh.removed for r in results if r.fresh.removed is not None]
    return Crowded(
        group=group("crowded", results),
        mostly=Rate(sum(p >= MOSTLY for p in parts), len(parts)),
        worse=Rate(sum(r.fresh.corrected > r.fresh.paper for r in results), len(results)),
    )


def sparse(results: Sequence[Result]) -> tuple[Sparse, ...]:
    """Of some sparse cases, those that hide something first; no row without a case."""

    def row(label: str, some: Sequence[Result]) -> Sparse:
        def rate(hits: Callable[[Result], bool]) -> Rate:
            return Rate(sum(map(hits, some)), len(some))

        printed = [p.holds for r in some for p in r.printed]
        return Sparse(
            label=label,
            cases=len(some),
            wrong=rate(explained_wrongly),
            right=rate(lambda r: r.verdict == "explained" and not r.spurious),
            undecided=rate(lambda r: r.cannot_tell),
            silent=rate(lambda r: r.verdict == "adequate"),
            unexplained=rate(lambda r: r.verdict == "unexplained" and not r.cannot_tell),
            held=Rate(printed.count(True), len(printed)),
        )

    rows = (
        row("one effect hidden", [r for r in results if r.hidden]),
        row("nothing hidden", [r for r in results if not r.hidden]),
        row("all", results),
    )
    return tuple(r for r in rows if r.cases)
