"""Which logs are meant by paths, folders, patterns and lists: those of a campaign."""

from __future__ import annotations

import glob
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from typing import TextIO

from erdctl.core.errors import UsageProblem
from erdctl.io import urls
from erdctl.io.formats import by_suffix
from erdctl.io.sources import STDIN

TEXTS = (".txt", ".asc", ".dat")  # suffixes of lab's texts, which say nothing of the format


def find_logs(places: Sequence[str], listed: TextIO | None = None) -> list[str]:
    """Paths and URLs of logs, each once, in order of their names.

    places : files, which need not exist; folders, for all logs below them by their suffixes;
        patterns with `*`, `?` and `**`; URLs, also with patterns; and "-" for a list of all these,
        one a line, on standard input (`listed`)
    Raises UsageProblem for a pattern or folder without a log, and if nothing is named at all.
    """
    found: dict[str, str] = {}
    for place in _places(places, listed or sys.stdin):
        # Two ways of writing one path are one log; what is first in order gives its name.
        for path in _at(place):
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


def _at(place: str) -> Iterable[str]:
    if urls.is_url(place):
        if not urls.is_pattern(place):
            return [place]
        found = urls.matching(place)
    elif os.path.isdir(place):
        found = [os.path.join(root, n) for root, _, names in os.walk(place) for n in names]
        found = [path for path in found if _is_log(path)]
    elif urls.is_pattern(place) and not os.path.lexists(place):
        found = [path for path in glob.glob(place, recursive=True) if os.path.isfile(path)]
    else:
        return [place]
    if not found:
        raise UsageProblem(f"'{place}': no log there")
    return found


def _is_log(path: str) -> bool:
    hidden = os.path.basename(path).startswith(".")
    return not hidden and (by_suffix(path) is not None or path.lower().endswith(TEXTS))
