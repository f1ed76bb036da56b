"""Effects that were not named, as rows of a table: from which size data would have shown them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from erdctl.effects import get
from erdctl.report.readable import headline, with_unit

HEADER = ["effect", "would show from", "its force, rms", "beyond the model, rms"]
FORCES = ("force_rms", "beyond_rms")


def undetected_rows(undetected: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """Rows of what a document lists, the largest force that may hide first; last what never shows.

    undetected : see `io.undetected`
    """
    could = [d for d in undetected if d["detectable"]]
    rows = []
    for d in sorted(could, key=lambda d: -d["force_rms"]):
        values = {symbol: v["value"] for symbol, v in d["parameters"].items()}
        effect = get(d["effect"])
        size = headline(effect, values)
        if effect.said and f"{{{d['parameter']}" not in effect.said:
            size += f", {d['parameter']} = {with_unit(d['size'], d['unit'], 3)}"
        rows.append([d["effect"], size, *(with_unit(d[k], "N", 2) for k in FORCES)])
    never = [d for d in undetected if not d["detectable"]]
    return rows + [[d["effect"], f"never: {d['reason']}", "-", "-"] for d in never]
