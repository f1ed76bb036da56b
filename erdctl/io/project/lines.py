"""Where in a TOML file something stands, which its parser does not tell."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from difflib import get_close_matches
from typing import Any

from erdctl.io.project.shape import (
    CORNERS,
    NAME,
    AmplifierLimits,
    LabelRules,
    ProjectFile,
    RigSettings,
)

_MOST = 2_000  # lines of a file that is searched
_KINDS = {
    bool: "bool", int: "int", float: "float", str: "str", list: "array", dict: "object",
}  # fmt: skip


def line_of(text: str, key: tuple[str, ...]) -> int | None:
    """The line in which a key is complete, from 1; None where that cannot be said.

    It is the first to which the file can be read with the key in it.
    Check: the second key of a table in line 1 stands in line 3.
    >>> line_of("[rig]\\nstrict = true\\naccept = 3", ("rig", "accept"))
    3
    """
    lines = text.splitlines()
    while key and len(lines) <= _MOST:
        last = key[-1]
        for number in (n for n, line in enumerate(lines, 1) if last in line):
            try:
                found = tomllib.loads("\n".join(lines[:number]))
            except (ValueError, RecursionError):
                continue
            if _holds(found, key):
                return number
        key = key[:-1]  # what is missing is said of the table
    return None


def _holds(value: Any, key: tuple[str, ...]) -> bool:
    for name in key:
        if not isinstance(value, dict) or name not in value:
            return False
        value = value[name]
    return True


def where_of(message: str, raw: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
    """A message of msgspec without the place in it, and the key that it means.

    For keys that the shape does not name msgspec says `[...]`: the first value that is as the
    message says is taken.
    """
    told, _, place = message.partition(" - at ")
    told = (
        told.replace("Object contains unknown field", "unknown key")
        .replace("`", "'")
        .replace(" | null'", "'")
    )
    steps = re.findall(r"\.(\w+)|(\[\.\.\.\]|\[\d+\])", place.replace("`key` in ", ""))
    path = [name or step for name, step in steps]
    unknown = re.search(r"unknown key '(.*)'", told, re.DOTALL)
    wrong = re.search(r"got `(\w+)`", message)
    of_key = place.startswith("`key` in ")
    if of_key:
        path = path[: len(path) - path[-1:].count("[...]")]
    matches = list(_matching(raw, path))
    for key, value in matches:
        if unknown is not None and isinstance(value, dict) and unknown[1] in value:
            return told + _meant(unknown[1]), (*key, unknown[1])
        if wrong is not None and not of_key and _KINDS.get(type(value)) == wrong[1]:
            return told, key
    key = matches[0][0] if matches else ()
    if of_key or key == ("schema",):
        told += f"; expected {', '.join(CORNERS) if of_key else NAME}"
    return told, key


def _meant(name: str) -> str:
    """Keys of a project file that are spelt nearly so."""
    shapes = (ProjectFile, LabelRules, AmplifierLimits, RigSettings)
    known = {field for shape in shapes for field in shape.__struct_fields__}
    close = get_close_matches(name.replace("-", "_"), known, 1, 0.7)
    return f"; did you mean '{close[0]}'?" if close else ""


def _matching(value: Any, path: list[str]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Keys that a path may mean, and what is there."""
    if not path:
        yield (), value
        return
    step, rest = path[0], path[1:]
    if step.startswith("["):
        if isinstance(value, list):  # the line of a list is that of its key
            for item in value:
                yield from _matching(item, rest)
            return
        names = list(value) if isinstance(value, dict) else []
    else:
        names = [step] if isinstance(value, dict) and step in value else []
    for name in names:
        for key, found in _matching(value[name], rest):
            yield (name, *key), found
