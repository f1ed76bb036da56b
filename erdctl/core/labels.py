"""What a test was made with: its date, the damper, and who made it; words that only pass through.

They go into `provenance` of documents, onto pages and under pictures, where somebody looks years
later. Nothing is computed from them, and none is made up: without them documents have none, so
that the same logs give the same file.
"""

from __future__ import annotations

from datetime import datetime

from erdctl.core.errors import UsageProblem

NAMES = ("date", "damper", "operator")
LONGEST = 200  # characters


def labels_of(date: str | None, damper: str | None, operator: str | None) -> dict[str, str]:
    """The labels that are given, by name, each checked.

    date : as ISO 8601 has it, with a time of day or without
    Raises UsageProblem for a date that is none, and for words that no table could show.
    Check: one given of three makes one label.
    >>> labels_of("2024-05-01", None, None)
    {'date': '2024-05-01'}
    """
    out = {}
    for name, given in zip(NAMES, (date, damper, operator), strict=True):
        if given is None:
            continue
        text = " ".join(given.split())
        if not text or not text.isprintable() or len(text) > LONGEST:
            raise UsageProblem(
                f"{name}: expected 1 to {LONGEST} printable characters, not {given[:40]!r}"
            )
        out[name] = text
    if "date" in out:
        try:
            datetime.fromisoformat(out["date"])
        except ValueError:
            raise UsageProblem(
                f"date: expected year-month-day, e.g. 2024-05-01 or 2024-05-01T14:30, not"
                f" '{out['date']}'"
            ) from None
    return out
