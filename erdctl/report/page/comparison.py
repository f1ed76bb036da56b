"""The page of a comparison: the fleet at a glance, what changed and since when, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from erdctl.compare.comparison import Attention, Compared, Damper, iso
from erdctl.compare.pair import told_by
from erdctl.compare.tolerance import Holds
from erdctl.compare.trend import Trend
from erdctl.core.messages import counted
from erdctl.report.changes import (
    SET,
    damper_texts,
    head,
    month,
    noun,
    pair_remarks,
    relative,
    trend_text,
)
from erdctl.report.page.data import Json, encoded
from erdctl.report.page.render import Run, digits, render
from erdctl.report.readable import scaled, typeset

ROWS, DETAILS, FIGURES, EACH = 1000, 100, 60, 6  # dampers, in detail, figures, of one damper
FIRST = 4  # dampers on the first screen
SIDE = 200  # dampers side by side
MONTH = 30.4375  # days


def comparison_page(found: Compared, *, run: Run) -> str:
    """The page."""
    dampers = found.dampers[:ROWS]
    detailed = [d for d in dampers if d.attention < Attention.QUIET][:DETAILS]
    figures, details = _details(detailed)
    urgent = [d for d in details if d["said"]]
    changed = [n for d in dampers for n, t in d.trends.items() if t.changed]
    judged = [j.name for d in dampers for j in d.judged]
    pairs = [x.name for d in dampers for p in d.pairs for x in p.changes]
    columns = list(dict.fromkeys([*changed, *pairs, *judged]))[:16]
    ids = {id(d): f"damper-{i}" for i, d in enumerate(detailed)}
    return render(
        "comparison.html",
        title=head(found),
        run=run,
        figures=figures,
        head=f"{head(found)}.",
        mood=_mood(found),
        logs=found.logs,
        count=len(found.dampers),
        period=_period(found),
        urgent=urgent[:FIRST],
        more=max(0, len(urgent) - FIRST),
        checks=_checks(found),
        compared=any(d.compared for d in found.dampers),
        sure=_sure(found),
        columns=[noun(n) for n in columns],
        rows=[_row(d, columns, ids.get(id(d), "")) for d in dampers],
        left_out=len(found.dampers) - len(dampers),
        details=details,
        values=_values(found.dampers[:SIDE]),
    )


def _mood(found: Compared) -> str:
    first = min((d.attention for d in found.dampers), default=Attention.QUIET)
    if first is Attention.FAILS:
        return "bad"
    alone = first is Attention.ALONE and not found.count(Holds.PASS)
    return "mid" if first < Attention.QUIET or alone else "good"


def _period(found: Compared) -> str:
    t = np.concatenate([d.history.t for d in found.dampers])
    t = t[np.isfinite(t)]
    return f"{iso(float(t.min()))} to {iso(float(t.max()))}" if len(t) else ""


def _checks(found: Compared) -> str:
    counts = {h: found.count(h) for h in Holds}
    if not any(counts.values()):
        return ""
    return ", ".join(f"{n} {h.value}" for h, n in counts.items())


def _sure(found: Compared) -> str:
    if not found.tests:
        return "By the errors of the fits; see the remarks of each damper."
    return (
        f"{counted(found.tests, 'parameter')} followed over time; where none changes, the chance"
        f" that any is told to is {100 * found.false_alarms:g} % for all of them together. Dates"
        " and rates are given with what the scatter of the logs leaves open (95 %; a rate with its"
        " standard error)."
    )


def _row(d: Damper, columns: Sequence[str], name: str) -> Json:
    h = d.history
    last = float(np.nanmax(h.t)) if np.isfinite(h.t).any() else float("nan")
    return {
        "id": name,
        "detailed": bool(name),
        "name": h.damper,
        "attention": d.attention.words,
        "logs": len(h.logs),
        "last": iso(last) or "",
        "cells": [_cell(d, n) for n in columns],
    }


def _cell(d: Damper, name: str) -> str:
    """Change and verdict of one parameter; readable without a colour."""
    verdict = next((j.holds.value for j in d.judged if j.name == name), "")
    t = d.trends.get(name)
    text = "" if t is None else "·"
    if t is not None and t.changed:
        way = "▲" if t.now[0] > t.start[0] else "▼"
        text = f"{way} {100 * abs(relative(t)):.0f} %"
        text = "appeared" if t.absent_before else "vanished" if t.absent_after else text
    for p in d.pairs:
        text = next((x.verdict.value for x in p.differences if x.name == name), text)
    return f"{text} {verdict}".strip()


def _details(dampers: Sequence[Damper]) -> tuple[dict[str, Json], list[Json]]:
    figures: dict[str, Json] = {}
    out = []
    for i, d in enumerate(dampers):
        names = []
        for k, t in enumerate(d.changes[:EACH]):
            if len(figures) < FIGURES:
                names.append(f"damper-{i}-{k}")
                figures[names[-1]] = _figure(d, t)
        out.append({
            "id": f"damper-{i}", "name": d.history.damper, "attention": d.attention.words,
            "said": damper_texts(d), "figures": names,
            "remarks": list(dict.fromkeys(r for p in d.pairs for r in pair_remarks(p))),
        })  # fmt: skip
    return figures, out


def _figure(d: Damper, t: Trend) -> Json:
    """Logs, form and the band of logs to come, over months since the first log."""
    s = t.series
    factor, unit = scaled(s.unit, float(np.nanmax(np.abs(s.value))))
    unit = typeset(unit) if unit != "1" else ""
    first, last = float(s.t[0]), float(s.t[-1])
    ahead = np.array([last, last + t.ahead])
    low, high = t.band(ahead)
    corners = np.array([first, *([] if t.since is None else [t.since[0], t.since[0]]), *ahead])
    if t.since is not None:  # a step goes up or down at its date
        corners[2] = np.nextafter(corners[1], np.inf)
    named = s.named
    marks = [
        {"value": end * factor, "text": f"limit {digits(end * factor, SET)}"}
        for j in d.judged if j.name == s.name for end in (j.band.low, j.band.high) if isfinite(end)
    ]  # fmt: skip
    bands = []
    if t.since is not None:
        low_end, high_end = ((e - first) / MONTH for e in t.since[1:])
        bands = [{"low": low_end, "high": high_end, "text": month(t.since[0])}]

    def line(name: str, x: object, y: object, style: str = "line") -> Json:
        months = (np.asarray(x, dtype=float) - first) / MONTH
        values = np.asarray(y, dtype=float) * factor
        return {"name": name, "style": style, "x": encoded(months), "y": encoded(values)}

    logs = line("logs", s.t[named], s.value[named], "dots")
    logs["words"] = [iso(v) or "" for v in s.t[named].tolist()]
    around = line("95 % of logs to come", ahead[[0, 1, 1, 0]], [low[0], low[1], high[1], high[0]])
    return {
        "kind": "lines",
        "title": f"{d.history.damper}: {trend_text(t)}",
        "x": {"label": f"Months since {iso(first)}", "unit": "months"},
        "y": {"label": noun(s.name), "unit": unit},
        "series": [around, line(t.form.value, corners, t.at(corners)[0]), logs],
        "bands": bands,
        "marks": marks,
    }  # fmt: skip


def _values(dampers: Sequence[Damper]) -> Json:
    """Values of all parameters of the dampers, a row each."""
    told = []
    for d in dampers:
        last = len(d.history.logs) - 1
        mine = {n: (t.value, t.stderr, t.unit) for n, t in told_by(d.history, last).items()}
        mine |= {n: (*t.now, t.series.unit) for n, t in d.trends.items() if not t.absent_after}
        told.append({n: v for n, v in mine.items() if isfinite(v[0])} if last >= 0 else {})
    names = list(dict.fromkeys(n for one in told for n in one))
    names.sort(key=lambda n: ("." not in n, n))
    units = {}
    for name in names:
        values = [one[name] for one in told if name in one]
        units[name] = scaled(values[0][2], max(abs(v[0]) for v in values))
    rows = []
    for d, one in zip(dampers, told, strict=True):
        cells = [_valued(one[n], units[n][0]) if n in one else "" for n in names]
        rows.append([d.history.damper, *cells])
    header = [f"{n} [{typeset(units[n][1])}]" if units[n][1] != "1" else n for n in names]
    return {"header": ["damper", *header], "rows": rows}


def _valued(value: tuple[float, float, str], factor: float) -> str:
    error = f" ± {digits(value[1] * factor, 2)}" if isfinite(value[1]) else ""
    return f"{digits(value[0] * factor)}{error}"
