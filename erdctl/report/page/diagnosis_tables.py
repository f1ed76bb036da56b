"""Tables of the page of a diagnosis: parameters, why some have no value, record effects, errors."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.core.recording import DIRECTIONS
from erdctl.model.paper import QUANTITIES
from erdctl.report.page import data
from erdctl.report.page.data import Json
from erdctl.report.page.render import digits
from erdctl.report.readable import error_of, largest, percent_of, scaled, with_unit


def paper_table(doc: Json) -> Json:
    """The paper's parameters, before and after, for both directions."""
    files = {"before": doc["baseline"]["params"], "after": doc["corrected"]["params"]}
    if not doc["findings"]:
        files.pop("before")
    rows = []
    for symbol, q in QUANTITIES.items():
        given = [file[d][symbol] for d in DIRECTIONS for file in files.values()]
        values = [v if isinstance(v, dict) else {"value": v} for v in given]
        factor, unit = scaled(q.unit, largest(v.get("value") for v in values))
        cells = [_cell(v, factor) for v in values]
        rows.append({"symbol": symbol, "title": q.title, "unit": unit, "cells": cells})
    names = {"before": "before", "after": "corrected" if "before" in files else "value"}
    return {"directions": DIRECTIONS, "columns": [names[k] for k in files], "rows": rows}


def _cell(value: Json, factor: float) -> str:
    if value.get("value") is None:
        return "not identified"
    within, at_bound = value.get("interval"), value.get("at_bound", False)
    error = error_of(
        value.get("stderr"), factor, at_bound=at_bound, value=value["value"], within=within
    )
    if at_bound:
        return error
    text = digits(value["value"] * factor)
    if within is not None:
        return f"{text} ({error})"
    stderr = value.get("stderr")
    return text if stderr is None else f"{text} ± {digits(stderr * factor, 2)}"


def notes_of(doc: Json) -> list[str]:
    """Why a parameter has no value, one line for each reason."""
    reasons: dict[str, list[str]] = {}
    for direction in DIRECTIONS:
        for symbol, value in doc["corrected"]["params"][direction].items():
            if isinstance(value, dict) and value.get("value") is None:
                reasons.setdefault(value.get("reason") or "no value given", []).append(
                    f"{direction}.{symbol}"
                )
    return [f"Not identified: {', '.join(names)}: {why}." for why, names in reasons.items()]


def record_table(records: Sequence[Json] | None) -> Json | None:
    """Gain and zero of each record, where they were free."""
    if not records:
        return None
    kinds = [k for k in ("gain", "offset") if k in records[0]]
    return {
        "header": ["record", *(f"{k} [{records[0][k]['unit']}]" for k in kinds)],
        "rows": [
            [
                v["name"],
                *(f"{digits(v[k]['value'])} ± {digits(v[k]['stderr'], 2)}" for k in kinds),
            ]
            for v in records
        ],
    }


def heldout_table(doc: Json, peak: float) -> Json:
    """Errors per PWM level before and after: NRMSE, N, and of the peak force."""
    before, after = doc["heldout"]["before"], doc["heldout"]["after"]
    names = [data.percent(level["duty"]) for level in before["nrmse_by_duty"]] + ["all"]
    rows = []
    pairs = ([*s["nrmse_by_duty"], s] for s in (before, after))
    for label, a, b in zip(names, *pairs, strict=True):
        change = f"{100 * (b['nrmse'] / a['nrmse'] - 1):+.0f} %".replace("-", "−")
        rows.append([
            label, f"{a['nrmse']:.4f}", f"{b['nrmse']:.4f}", change,
            *(digits(s["rms"], 3) for s in (a, b)), percent_of(b["rms"], peak),
        ])  # fmt: skip
    return {
        "header": [
            "PWM level", "NRMSE before", "NRMSE after", "change", "rms before [N]",
            "rms after [N]", f"after, of {with_unit(peak, 'N', 3)} peak",
        ],
        "rows": rows,
    }  # fmt: skip
