"""What several logs in one picture are told apart by, read from their paths."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence

from erdctl.core.errors import UsageProblem

LOG, FOLDER = "log", "folder"
PATTERNS = {
    "corner": r"(?<![A-Za-z])([FRfr][LRlr])(?![A-Za-z])",
    "date": r"(?<!\d)(\d{4}-?\d{2}(?:-?\d{2})?)(?!\d)",
}


def paths_told(paths: Sequence[str], by: str) -> tuple[str, list[str] | None]:
    """Title and label of each log; no labels where each log stands for itself.

    by : `log`, `folder`, `corner`, `date`, or NAME=PATTERN
    Raises UsageProblem for a path that does not say it, and for a pattern that is none.
    Check: two corners, and dampers by a pattern.
    >>> paths_told(["D1/fl.csv", "D2/rr.csv"], "corner")
    ('corner', ['fl', 'rr'])
    >>> paths_told(["D1/fl.csv", "D2/rr.csv"], "damper=D[0-9]+")
    ('damper', ['D1', 'D2'])
    """
    if by == LOG:
        return LOG, None
    if by == FOLDER:
        return FOLDER, [os.path.basename(os.path.dirname(os.path.abspath(p))) for p in paths]
    title, equals, pattern = by.partition("=")
    if not equals and title in PATTERNS:
        pattern = PATTERNS[title]
    elif not equals or not title or not pattern:
        raise UsageProblem(
            f"--overlay takes {LOG}, {FOLDER}, {', '.join(PATTERNS)} or NAME=PATTERN, e.g."
            f" 'damper=D[0-9]+', not '{by}'"
        )
    try:
        finder = re.compile(pattern)
    except re.error as error:
        raise UsageProblem(f"--overlay: '{pattern}' is no pattern: {error}") from None
    labels = []
    for path in paths:
        found = finder.search(path)
        if found is None:
            raise UsageProblem(f"--overlay {by}: the path '{path}' does not say it")
        labels.append(found[1] if finder.groups else found[0])
    return title, labels
