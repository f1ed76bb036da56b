"""The page of a proof: what was hidden, what was named, and every case that went wrong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from erdctl.core.messages import counted
from erdctl.report.page import data
from erdctl.report.page.data import Json
from erdctl.report.page.render import Run, digits, render

Table = tuple[str, Sequence[str], Sequence[Sequence[str]]]


def proof_page(document: Json, tables: Sequence[Table], *, run: Run) -> str:
    """The page.

    document : as `prove` writes it, `erdctl.proof/1`;  tables : title, header, rows of its summary
    """
    summary, results = document["summary"], document["results"]
    whole = summary["whole"]
    return render(
        "proof.html",
        title=f"Proof over {counted(document['cases'], 'case')}",
        run=run,
        figures=_figures(results),
        cases=document["cases"],
        seed=document["seed"],
        failed=summary["failed"],
        **_answers(summary, whole),
        bands=[_bar(g["label"], g["named"]) for g in summary["bands"]],
        tables=[
            {"caption": title, "header": header, "rows": rows, "words": _words(header)}
            for title, header, rows in tables
        ],
    )


def _answers(summary: Json, whole: Json) -> Json:
    named, right, located = whole["named"], whole["right"], whole["located"]
    nulls = [g for g in summary["nulls"] if g["label"] == "all"]
    quiet = nulls[0]["adequate"] if nulls and nulls[0]["cases"] else None
    head = f"{right['hits']} of {counted(right['of'], 'case')} got the right verdict"
    if named["of"]:
        were = "was" if named["hits"] == 1 else "were"
        head = f"{named['hits']} of {counted(named['of'], 'hidden effect')} {were} named first"
    removed = whole["removed"]
    return {
        "mood": "good" if not summary["misses"] else "mid",
        "head": f"{head}.",
        "right": _rate(right),
        "located": _rate(located),
        "quiet": _rate(quiet) if quiet else "no such case",
        "spurious": digits(whole["spurious"], 2),
        "removed": "–" if removed is None else f"{100 * removed:.0f} %",
        "misses": len(summary["misses"]),
    }


def _rate(rate: Json) -> str:
    if not rate["of"]:
        return "does not arise"
    return f"{rate['hits']} of {rate['of']} ({100 * rate['hits'] / rate['of']:.0f} %)"


def _bar(label: str, rate: Json) -> Json:
    return {"label": label, "text": _rate(rate), "share": rate["hits"] / max(rate["of"], 1)}


def _words(header: Sequence[str]) -> list[int]:
    """Columns of text: the first, and those that hold names."""
    return [i for i, name in enumerate(header) if not i or name in {"named", "why", "seeds"}]


def _figures(results: Sequence[Json]) -> dict[str, Json]:
    """Each case: misfit of the paper's model over the noise, and the error that is left."""
    groups: dict[str, list[Any]] = {"wrong name or none": [], "right name first": []}
    for r in results:
        paper, left = r["fresh"]["paper"], r["fresh"]["corrected"]
        if r["named"] is None or not r["hidden"] or paper <= 0.0 or r["level"] <= 0.0:
            continue
        hidden = " + ".join(h["effect"] for h in r["hidden"])
        said = " + ".join(f["effect"] for f in r["findings"]) or "nothing"
        words = f"seed {r['seed']}: {hidden}\nnamed: {said} ({r['verdict']})"
        key = "right name first" if r["named"] else "wrong name or none"
        groups[key].append((r["level"], 100 * left / paper, words))
    found = {name: sorted(points) for name, points in groups.items() if points}
    if not found:
        return {}
    return {
        "cases": {
            "kind": "lines",
            "title": "Error left on fresh records, each case",
            "x": {"label": "Misfit of the paper's model over the noise", "unit": "1", "log": True},
            "y": {"label": "Error left, of that of the paper's model", "unit": "%", "zero": True},
            "series": [
                {
                    "name": name,
                    "style": "dots" if name.startswith("right") else "crosses",
                    "x": data.encoded([p[0] for p in points], "f8"),
                    "y": data.encoded([p[1] for p in points]),
                    "words": [p[2] for p in points],
                }
                for name, points in found.items()
            ],
        }
    }
