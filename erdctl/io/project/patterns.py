"""Patterns of paths such as `raw/**/*.csv`."""

from __future__ import annotations

import re

_PARTS = re.compile(r"\*\*/|\*\*|\*|\?|\[[^\]/]+\]|.", re.DOTALL)
_MEAN = {"**/": "(?:[^/]+/)*", "**": ".*", "*": "[^/]*", "?": "[^/]"}


def pattern_of(glob: str) -> re.Pattern[str]:
    """A pattern as a regular expression: ** goes over folders, * and ? stay in one.

    `fnmatch` has no **, and `glob` and `pathlib` before Python 3.13 want the files to be there.
    Check: * stays in its folder, **/ is any number of folders, none among them.
    >>> [bool(pattern_of("raw/*.csv").fullmatch(p)) for p in ("raw/a.csv", "raw/b/a.csv")]
    [True, False]
    >>> [bool(pattern_of("raw/**/*.csv").fullmatch(p)) for p in ("raw/a.csv", "raw/b/a.csv")]
    [True, True]
    """
    out = []
    for part in _PARTS.findall(glob.removeprefix("./")):
        if part in _MEAN:
            out.append(_MEAN[part])
        elif part.startswith("[") and len(part) > 2:
            inner = part[1:-1].replace("\\", r"\\").replace("[", r"\[")
            out.append(f"[{'^' + inner[1:] if inner[0] == '!' else inner}]")
        else:
            out.append(re.escape(part))
    return re.compile("".join(out), re.DOTALL)
