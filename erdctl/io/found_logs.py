"""Which logs are meant by paths, folders, patterns and lists: those of a campaign."""

from __future__ import annotations

import glob
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TextIO

from erdctl.core.errors import UsageProblem
from erdctl.io import urls
from erdctl.io.formats import by_suffix
from erdctl.io.sources import STDIN

# Suffixes of lab's texts, which say nothing of the format.
TEXTS = (".txt", ".asc", ".dat", ".lvm", ".tsv", ".tab")
# Suffixes of what may hold a log, and as often something else: taken only by their names.
PERHAPS = (".log", ".gz", ".zip", ".bz2", ".xz", ".xls", ".xlsx", ".ods", ".out")


def find_logs(
    places: Sequence[str],
    listed: TextIO | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> list[str]:
    """Paths and URLs of logs, each once, in order of their names.

    places : files, which need not exist; folders, for all logs below them by their suffixes;
        patterns with `*`, `?` and `**`; URLs, also with patterns; and "-" for a list of all these,
        one a line, on standard input (`listed`)
    report : takes a line on files of a folder that may be logs and are left out
    Raises UsageProblem for a pattern or folder without a log, and if nothing is named at all.
    """
    found: dict[str, str] = {}
    for place in _places(places, listed or sys.stdin):
        # Two ways of writing one path are one log; what is first in order gives its name.
        for path in _at(place, report):
            key = path if urls.is_url(path) else os.path.abspath(path)
            found[key] = min(found.get(key, path), path)
    if not found:
        raise UsageProblem("no log is named: the list is empty")
    return sorted(found.values())


def _places(places: Sequence[str], listed: TextIO) -> Iterator[str]:
    for place in places:
        if place == STDIN:
            yield from (line for line in map(str.strip, listed) if line)
        else:
            yield place


def _at(place: str, report: Callable[[str], None]) -> Iterable[str]:
    if urls.is_url(place):
        if not urls.is_pattern(place):
            return [place]
        found = urls.matching(place)
    elif os.path.isdir(place):
        found = [os.path.join(root, n) for root, _, names in os.walk(place) for n in names]
        if left := Counter(s for s in map(_suffix, found) if s in PERHAPS):
            kinds = ", ".join(f"{count} {suffix}" for suffix, count in sorted(left.items()))
            report(f"left out in {place}: {kinds}; if these are logs, name them, as by a pattern")
        found = [path for path in found if _is_log(path)]
    elif urls.is_pattern(place) and not os.path.lexists(place):
        found = [path for path in glob.glob(place, recursive=True) if os.path.isfile(path)]
    else:
        return [place]
    if not found:
        raise UsageProblem(f"'{place}': no log there")
    return found


def _suffix(path: str) -> str:
    """In lower case; of a hidden file none."""
    name = os.path.basename(path)
    return "" if name.startswith(".") else os.path.splitext(name)[1].lower()


def _is_log(path: str) -> bool:
    return bool(_suffix(path)) and (by_suffix(path) is not None or _suffix(path) in TEXTS)
