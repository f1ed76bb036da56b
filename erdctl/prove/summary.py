"""What all cases together say: rates by band, effect, noise, motion; confusions; misses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from statistics import mean, median

from erdctl.prove.judge import Failed, Result
from erdctl.prove.score import BAND_NAMES, band

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


@dataclass(frozen=True)
class EffectRow:
    """One effect alone, in one band."""

    effect: str
    band: str
    named: Rate
    explained: Rate


@dataclass(frozen=True)
class Confusion:
    """An effect that was given another's name; seeds : where."""

    hidden: str
    said: str
    seeds: tuple[int, ...]


@dataclass(frozen=True)
class Miss:
    """A case that did not come out as it should, and in what."""

    seed: int
    hidden: str
    said: str
    why: tuple[str, ...]


@dataclass(frozen=True)
class Summary:
    """The proof in figures. `whole` holds every case, `bands` and `effects` the singles."""

    whole: Tally
    bands: tuple[Tally, ...]
    effects: tuple[EffectRow, ...]
    pairs: Tally
    nulls: tuple[Tally, ...]
    unknowns: Tally
    motions: tuple[Tally, ...]
    concealments: tuple[Tally, ...]
    confusions: tuple[Confusion, ...]
    misses: tuple[Miss, ...]
    failed: int


def summarise(results: Sequence[Result], failed: Sequence[Failed] = ()) -> Summary:
    """Figures of some results."""
    singles = [r for r in results if r.kind == "single"]
    nulls = [r for r in results if r.kind == "null"]
    colours = sorted({r.colour for r in nulls})
    return Summary(
        whole=group("all cases", results),
        bands=_split("", singles, BAND_NAMES, _band),
        effects=_effects(singles),
        pairs=group("pairs", [r for r in results if r.kind == "pair"]),
        nulls=(*_split("", nulls, colours, lambda r: r.colour), group("all", nulls)),
        unknowns=group("unknown", [r for r in results if r.kind == "unknown"]),
        motions=tuple(
            g
            for kind in ("single", "pair", "null", "unknown")
            for g in _split(
                f"{kind}, ", [r for r in results if r.kind == kind],
                ("exact", "measured"), lambda r: r.motion,
            )
        ),
        concealments=_split(
            "", singles, ("unlabelled", "absorbed", "not_logged"), lambda r: r.concealment
        ),
        confusions=_confusions(results),
        misses=tuple(
            sorted(
                [
                    *(m for m in map(_miss, results) if m is not None),
                    *(Miss(f.seed, "?", "?", (f"failed: {f.message}",)) for f in failed),
                ],
                key=lambda m: m.seed,
            )
        ),
        failed=len(failed),
    )  # fmt: skip


def group(label: str, results: Sequence[Result]) -> Tally:
    """Rates of some results."""
    named = [r.named for r in results if r.named is not None]
    hiding = [r for r in results if r.named is not None]
    places = [r.located for r in results if r.located is not None]
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
        right=Rate(sum(r.verdict == due(r) for r in results), len(results)),
        located=Rate(places.count(True), len(places)),
        first_place=Rate(first.count(True), len(first)),
        spurious=mean(r.spurious for r in results) if results else None,
        removed=median(parts) if parts else None,
        removed_of=len(parts),
    )


def due(r: Result) -> str:
    """The verdict that a case deserves."""
    return {"null": "adequate", "unknown": "unexplained"}.get(r.kind, "explained")


def reasons(r: Result) -> tuple[str, ...]:
    """What is wrong with a case; nothing if it came out as it should."""
    out = []
    if r.named is False:
        out.append("wrong name first" if r.findings else "not named")
    if r.named is not None and r.matched < len(r.hidden) and r.matched:
        out.append(f"{r.matched} of {len(r.hidden)} found")
    if r.verdict != due(r):
        out.append(f"verdict {r.verdict}")
    if r.spurious:
        out.append(f"{r.spurious} spurious")
    if r.located is False:
        out.append("not located")
    return tuple(out)


def hidden_text(r: Result) -> str:
    """What a case hides, in a few characters: names and levels."""
    return " + ".join(f"{h.effect} {h.level:.2g}" for h in r.hidden) or "nothing"


def said_text(r: Result) -> str:
    """What the diagnosis said, in a few characters."""
    names = ["/".join([f.effect, *f.equivalent]) for f in r.findings]
    return " + ".join(names) or "-"


def _band(r: Result) -> str:
    return band(r.hidden[0].level)


def _split(
    prefix: str, results: Sequence[Result], labels: Iterable[str], of: Callable[[Result], str]
) -> tuple[Tally, ...]:
    groups = (group(prefix + name, [r for r in results if of(r) == name]) for name in labels)
    return tuple(g for g in groups if g.cases)


def _effects(singles: Sequence[Result]) -> tuple[EffectRow, ...]:
    out = []
    for effect in sorted({r.hidden[0].effect for r in singles}):
        for name in BAND_NAMES:
            cases = [r for r in singles if r.hidden[0].effect == effect and _band(r) == name]
            if cases:
                whole = group("", cases)
                out.append(EffectRow(effect, name, whole.named, whole.explained))
    return tuple(out)


def _confusions(results: Sequence[Result]) -> tuple[Confusion, ...]:
    """Names given to singles, nulls and unknowns that are not theirs, the most frequent first."""
    seeds: dict[tuple[str, str], list[int]] = {}
    for r in results:
        hidden = r.hidden[0].effect if len(r.hidden) == 1 else "nothing"
        wrong = r.kind != "pair" and bool(r.findings) and not r.named
        if wrong:
            seeds.setdefault((hidden, r.findings[0].effect), []).append(r.seed)
    counts = Counter({pair: len(where) for pair, where in seeds.items()})
    return tuple(
        Confusion(*pair, tuple(seeds[pair]))
        for pair in sorted(counts, key=lambda pair: (-counts[pair], pair))
    )


def _miss(r: Result) -> Miss | None:
    why = reasons(r)
    return Miss(r.seed, hidden_text(r), said_text(r), why) if why else None
