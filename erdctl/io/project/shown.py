"""What of a project holds, value by value, with its key and line."""

from __future__ import annotations

from typing import Any

from erdctl.io.project.labels import Labels
from erdctl.io.project.lines import line_of
from erdctl.io.project.project import At, Project, Said

_APART = (("corner",), ("damper",))


def values_of(project: Project, labels: Labels, log: str | None = None) -> list[dict[str, Any]]:
    """Name, value, key in the file and line of all that holds for a log, or in general.

    log : whose columns, text and where are left out if they are not for it
    """
    found: list[tuple[Said, At]] = []
    if log is None or project.reads(log):
        tables = {
            "columns": project.columns(labels), "text": project.text(labels),
            "where": project.where(labels),
        }  # fmt: skip
        found += [(s, (table, k)) for table, said in tables.items() for k, s in said.items()]
    found += [(s, tuple(key.split("."))) for key, s in project.limits(labels).items()]
    for command in ("", *_commands(project)):
        end = ("options", command) if command else ("options",)
        said = project.options(command, labels)
        found += [(s, (name,)) for name, s in said.items() if s.at[-len(end) :] == end]
    return [
        {
            "name": ".".join((*s.at[2 * (s.at[:1] in _APART) :], *names)),
            "value": s.value, "key": s.key(*names),
            "line": line_of(project.source, (*s.at, *names)),
        }
        for s, names in found
    ]  # fmt: skip


def _commands(project: Project) -> list[str]:
    """Those that have options of their own."""
    tables = [s.options for _, s in project.sections()]
    return list(dict.fromkeys(k for t in tables for k, v in t.items() if isinstance(v, dict)))
