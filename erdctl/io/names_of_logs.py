"""What logs and their records are called when several are read together."""

from __future__ import annotations

import os
from collections.abc import Sequence

from erdctl.core.errors import UsageProblem
from erdctl.core.messages import as_text
from erdctl.io.sources import STDIN


def refuse_repeated(paths: Sequence[str]) -> None:
    """Raise UsageProblem for a log that is given twice, also by another name."""
    seen: set[str] = set()
    for path in paths:
        real = path if path == STDIN else os.path.realpath(path)
        if real in seen:
            raise UsageProblem(f"'{path}' is given twice; its samples would count twice")
        seen.add(real)


def stem(path: str) -> str:
    """What a log without records of its own is called."""
    return "stdin" if path == STDIN else as_text(os.path.splitext(os.path.basename(path))[0])


def names_of(paths: Sequence[str]) -> list[str]:
    """What several logs are called in the names of their records."""
    stems = [stem(p) for p in paths]
    # Logs of the same name in several directories are distinguished by their paths.
    return [s if stems.count(s) == 1 else p for s, p in zip(stems, paths, strict=True)]


def qualified(names: Sequence[str], label: str) -> tuple[str, ...]:
    """Names of records with the log's before them."""
    return tuple(n if n.split(":")[0] == label else f"{label}:{n}" for n in names)
