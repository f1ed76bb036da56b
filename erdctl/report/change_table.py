"""The rows of a comparison's table: one for each damper and parameter."""

from __future__ import annotations

from math import isfinite

from erdctl.compare.comparison import Compared, Damper, iso
from erdctl.compare.pair import Change
from erdctl.report.changes import difference_text, trend_text

Cell = str | float | int | None
HEADER = [
    "damper", "parameter", "unit", "logs", "change", "before", "before_error", "now", "now_error",
    "since", "since_first", "since_last", "rate_per_year", "rate_error", "p", "limit_low",
    "limit_high", "verdict", "text",
]  # fmt: skip
SHORT = [
    "damper", "parameter", "unit", "change", "before", "now", "since", "rate_per_year",
    "rate_error", "verdict",
]  # fmt: skip


def rows(found: Compared, *, short: bool = False) -> tuple[list[str], list[list[Cell]]]:
    """Header and rows, the most urgent damper first.

    short : for print: only what changed or is judged, and fewer columns
    """
    out = [row for d in found.dampers for row in _rows(d)]
    if not short:
        return HEADER, out
    at = [HEADER.index(name) for name in SHORT]
    change, verdict = HEADER.index("change"), HEADER.index("verdict")
    quiet = ("constant", Change.SAME.value, Change.UNKNOWN.value, None)
    kept = [row for row in out if row[change] not in quiet or row[verdict] is not None]
    return SHORT, [[row[i] for i in at] for row in kept]


def _rows(d: Damper) -> list[list[Cell]]:
    cells: dict[str, dict[str, Cell]] = {}
    for name, t in d.trends.items():
        since, rate = t.since or (None, None, None), t.rate or (None, None)
        cells[name] = {
            "unit": t.series.unit, "logs": int(t.series.named.sum()),
            "change": "appeared" if t.absent_before else "vanished" if t.absent_after
            else t.form.value,
            "before": t.start[0], "before_error": t.start[1],
            "now": t.now[0], "now_error": t.now[1],
            "since": _date(since[0]), "since_first": _date(since[1]), "since_last": _date(since[2]),
            "rate_per_year": rate[0], "rate_error": rate[1], "p": t.scan.p,
            "text": trend_text(t) or None,
        }  # fmt: skip
    for p in d.pairs:
        for x in p.differences:
            cells[x.name] = {
                "unit": x.unit, "logs": 2, "change": x.verdict.value,
                "before": _number(x.before.value), "before_error": _number(x.before.stderr),
                "now": _number(x.after.value), "now_error": _number(x.after.stderr),
                "p": _number(x.p), "text": difference_text(x),
            }  # fmt: skip
    for j in d.judged:
        one = cells.setdefault(j.name, {"unit": j.unit, "now": _number(j.value)})
        one |= {
            "limit_low": _number(j.band.low), "limit_high": _number(j.band.high),
            "verdict": j.holds.value,
        }  # fmt: skip
    return [
        [{"damper": d.history.damper, "parameter": name, **one}.get(c) for c in HEADER]
        for name, one in cells.items()
    ]


def _date(days: float | None) -> str | None:
    return None if days is None else iso(days)


def _number(value: float) -> float | None:
    return value if isfinite(value) else None
