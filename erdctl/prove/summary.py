"""What all cases together say: rates by band, effect, noise, motion; confusions; misses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from erdctl.prove.asked import Crowded, LeftOutEffect, Sparse, crowded, left_out, sparse
from erdctl.prove.case import LEFT_OUT
from erdctl.prove.judge import Failed, Result
from erdctl.prove.score import BAND_NAMES, band
from erdctl.prove.tally import Rate, Tally, due, explained_wrongly, group


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
    unknown_bands: tuple[Tally, ...]
    unknown_effects: tuple[Tally, ...]
    motions: tuple[Tally, ...]
    concealments: tuple[Tally, ...]
    confusions: tuple[Confusion, ...]
    misses: tuple[Miss, ...]
    failed: int
    crowded: Crowded
    sparse: tuple[Sparse, ...]
    left_out: tuple[LeftOutEffect, ...]


def summarise(results: Sequence[Result], failed: Sequence[Failed] = ()) -> Summary:
    """Figures of some results."""
    singles = [r for r in results if r.kind == "single"]
    nulls = [r for r in results if r.kind == "null"]
    unknowns = [r for r in results if r.kind == "unknown"]
    colours = sorted({r.colour for r in nulls})
    return Summary(
        whole=group("all cases", results),
        bands=_split("", singles, BAND_NAMES, _band),
        effects=_effects(singles),
        pairs=group("pairs", [r for r in results if r.kind == "pair"]),
        nulls=(*_split("", nulls, colours, lambda r: r.colour), group("all", nulls)),
        unknowns=group("all", unknowns),
        unknown_bands=_split("", unknowns, BAND_NAMES, _band),
        unknown_effects=_split("", unknowns, sorted(set(map(_hidden, unknowns))), _hidden),
        motions=tuple(
            g
            for kind in ("single", "pair", "null", "unknown", "crowded", "sparse")
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
        crowded=crowded([r for r in results if r.kind == "crowded"]),
        sparse=sparse([r for r in results if r.kind == "sparse"]),
        left_out=left_out([r for r in results if r.kind == LEFT_OUT]),
    )  # fmt: skip


def reasons(r: Result) -> tuple[str, ...]:
    """What is wrong with a case; nothing if it came out as it should."""
    out = []
    if r.kind == "sparse":
        missed = [p.parameter for p in r.printed if not p.holds]
        if missed:
            out.append(f"not within its interval: {', '.join(missed)}")
        return (("wrong name", *out)) if explained_wrongly(r) else tuple(out)
    if r.named is False:
        out.append("wrong name first" if r.findings else "not named")
    if r.named is not None and r.matched < len(r.hidden) and r.matched:
        out.append(f"{r.matched} of {len(r.hidden)} found")
    if r.kind == "crowded" and r.fresh.corrected > r.fresh.paper:
        out.append("worse than the paper's model")
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


def _hidden(r: Result) -> str:
    return r.hidden[0].effect


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
        wrong = r.kind not in {"pair", "crowded", LEFT_OUT} and bool(r.findings) and not r.named
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
