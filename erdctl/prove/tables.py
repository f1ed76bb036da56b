"""The scoreboard: a line for each case, and the tables at the end, as text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from erdctl.prove.judge import Failed
from erdctl.prove.run import Outcome
from erdctl.prove.score import BAND_NAMES
from erdctl.prove.summary import Summary, hidden_text, said_text
from erdctl.prove.tally import Rate, Tally

SAID = 4  # of what is said in the place of an effect
Table = tuple[str, Sequence[str], Sequence[Sequence[str]]]


def line(outcome: Outcome) -> str:
    """One case in one line, the seed and the key's hash first."""
    if isinstance(outcome, Failed):
        return f"seed {outcome.seed}  FAILED  {outcome.message}"
    r, e = outcome, outcome.fresh
    errors = " ".join(_digits(e.nrmse(rms), 4) for rms in (e.paper, e.corrected, e.best))
    return "  ".join(
        [
            f"seed {r.seed}", r.key_sha256[:12], f"{r.kind}: {hidden_text(r)}",
            f"said: {said_text(r)}", f"named {_yes(r.named)}", r.verdict,
            f"located {_yes(r.located)}", f"nrmse {errors}",
            *([f"learned {' + '.join(r.learned)}"] if r.learned else []),
        ]
    )  # fmt: skip


def tables(s: Summary) -> Iterator[Table]:
    """Every table that has rows: title, header, rows."""
    for title, header, rows in _every(s):
        if rows:
            yield title, header, rows


def _every(s: Summary) -> Iterator[Table]:
    single = ["misfit over noise", "cases", "named first", "wrong name", "explained", "located",
              "first place", "spurious per case", "attainable reduction"]  # fmt: skip
    yield "Single effects, by the misfit of the paper's model over the noise", single, [
        [g.label, str(g.cases), _rate(g.named), _rate(g.wrong), _rate(g.explained),
         _rate(g.located), _rate(g.first_place), _digits(g.spurious, 2), _removed(g)]
        for g in s.bands
    ]  # fmt: skip
    yield (
        "Single effects named first, by effect and misfit over noise",
        ["", *BAND_NAMES],
        _by_effect(s),
    )
    yield "Pairs of effects", ["", "cases", "both found", "named first", "explained", "located",
                    "first place", "spurious per case", "attainable reduction"], [
        [g.label, str(g.cases), _rate(g.all_found), _rate(g.named), _rate(g.explained),
         _rate(g.located), _rate(g.first_place), _digits(g.spurious, 2), _removed(g)]
        for g in (s.pairs,) if g.cases
    ]  # fmt: skip
    yield (
        "Nothing hidden, by the colour of the noise",
        ["", "cases", "adequate"],
        [[g.label, str(g.cases), _rate(g.adequate)] for g in s.nulls if g.cases],
    )
    yield "Outside the catalogue, by the misfit of the paper's model over the noise", [
        "misfit over noise", "cases", "unexplained", "explained by a wrong name", "adequate",
        "located", "first place", "learned", "right slot and coordinate", "error removed",
    ], [
        [g.label, str(g.cases), _rate(g.unexplained), _rate(g.explained), _rate(g.adequate),
         _rate(g.located), _rate(g.first_place), _rate(g.learned), _rate(g.lies), _part(g.cut)]
        for g in (*s.unknown_bands, s.unknowns) if g.cases
    ]  # fmt: skip
    yield "Left out of the catalogue, by effect", [
        "effect", "cases", "unexplained", "learned", "error removed", "in its place",
    ], [
        [row.group.label, str(row.group.cases), _rate(row.group.unexplained),
         _rate(row.group.learned), _part(row.group.cut),
         "" if row.group.label == "all" else ", ".join(f"{s} ({n})" for s, n in row.said[:SAID])]
        for row in s.left_out
    ]  # fmt: skip
    yield "Outside the catalogue, by what is hidden", [
        "hidden", "cases", "learned", "right slot and coordinate", "error removed",
    ], [
        [g.label, str(g.cases), _rate(g.learned), _rate(g.lies), _part(g.cut)]
        for g in s.unknown_effects
    ]  # fmt: skip
    yield "Crowded: a strong effect among faint ones, records that scatter", [
        "", "cases", "strong one first", "spurious per case", "attainable reduction",
        "95 % of it reached", "worse than the paper's model", "all found", "explained",
    ], [
        [g.label, str(g.cases), _rate(g.named), _digits(g.spurious, 2), _removed(g),
         _rate(s.crowded.mostly), _rate(s.crowded.worse), _rate(g.all_found), _rate(g.explained)]
        for g in (s.crowded.group,) if g.cases
    ]  # fmt: skip
    yield "Sparse: few short records, one duty or two", [
        "", "cases", "explained and wrong", "explained and right", "cannot tell", "adequate",
        "unexplained", "intervals that hold the truth",
    ], [
        [g.label, str(g.cases), _rate(g.wrong), _rate(g.right), _rate(g.undecided),
         _rate(g.silent), _rate(g.unexplained), _rate(g.held)]
        for g in s.sparse
    ]  # fmt: skip
    split = ["", "cases", "named first", "all found", "right verdict", "located", "first place",
             "spurious per case", "learned"]  # fmt: skip
    for title, groups in (
        ("By kind and motion (measured: xdot from a noisy, quantised x)", s.motions),
        ("Single effects, by concealment", s.concealments),
        ("All cases", (s.whole,)),
    ):
        yield title, split, [
            [g.label, str(g.cases), _rate(g.named), _rate(g.all_found), _rate(g.right),
             _rate(g.located), _rate(g.first_place), _digits(g.spurious, 2), _rate(g.learned)]
            for g in groups if g.cases
        ]  # fmt: skip
    yield (
        "Confusions",
        ["hidden", "named", "cases", "seeds"],
        [[c.hidden, c.said, str(len(c.seeds)), " ".join(map(str, c.seeds))] for c in s.confusions],
    )
    yield "Misses (one of them alone: the same options with --cases 1 --seed SEED)", [
        "hidden", "seed", "named", "why"
    ], [[m.hidden, str(m.seed), m.said, ", ".join(m.why)] for m in s.misses]  # fmt: skip


def _by_effect(s: Summary) -> list[list[str]]:
    cells = {(row.effect, row.band): _rate(row.named) for row in s.effects}
    names = dict.fromkeys(row.effect for row in s.effects)
    return [[name, *(cells.get((name, b), "-") for b in BAND_NAMES)] for name in names]


def _rate(rate: Rate) -> str:
    return "-" if rate.share is None else f"{100 * rate.share:.0f} % ({rate.hits}/{rate.of})"


def _removed(g: Tally) -> str:
    return "-" if g.removed is None else f"{100 * g.removed:.0f} % ({g.removed_of})"


def _part(value: float | None) -> str:
    return "-" if value is None else f"{100 * value:.0f} %"


def _digits(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _yes(value: bool | None) -> str:
    return {True: "yes", False: "no", None: "-"}[value]
