"""What a project says of a log as it is read: its columns, its text, its rows, what it is of.

A project holds for logs as a lab writes them. In a pipe, and among the files that erdctl wrote,
columns have the contract's names and are SI: a log that has none of the project's columns is read
as it is. One that has some of them must have all that the command needs, and the duty, which would
otherwise be taken as 0.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from erdctl.core.errors import InputProblem
from erdctl.io.dampers import Where, chosen_rows, needed_columns
from erdctl.io.maps import Mapping as ColumnMapping
from erdctl.io.maps import parse_maps
from erdctl.io.project.labels import Labels, common, over
from erdctl.io.project.project import Project, Said, chosen
from erdctl.io.sources import TableSource, open_source, read_source
from erdctl.io.text.options import TextOptions, TextSpec, pairs_of, parse_text_options
from erdctl.io.units import TARGETS, listed

_OPTIONAL = ("xdot", "temperature", "record", "force", "force_model")
_MANY = 20  # different values of a column that a message counts


@dataclass(frozen=True)
class OfLog:
    """What holds for one log: mappings of columns, rows, and what it is of."""

    mappings: tuple[ColumnMapping, ...]
    where: tuple[Where, ...]
    labels: Labels


def _untold(what: str) -> None:
    """Nobody asks; a function with a name goes to another process, a lambda does not."""


@dataclass(frozen=True)
class ProjectReading:
    """A project as the logs of one command are read by it.

    damper, corner : as the user gave them;  used : takes what the project changed
    given : what the user said of single logs, by path; wins name by name
    """

    project: Project
    damper: str | None = None
    corner: str | None = None
    used: Callable[[str], None] = _untold
    given: Mapping[str, Labels] = field(default_factory=dict)

    def labels(self, path: str, columns: Mapping[str, str] | None = None) -> Labels:
        """What a log is of, as far as its path, its columns and the user say it."""
        found = over(self.project.labels(path, columns), self.given.get(path, Labels()))
        return chosen(found, self.damper, self.corner)

    def says(self, path: str) -> list[Any]:
        """All that the reading of one log depends on, to see whether that is unchanged."""
        content, labels = self.project.content, self.labels(path)
        columns = content.labels.columns  # where they are asked, any damper may be found
        sections = [
            (at, section.columns, section.text, section.where)
            for at, section in self.project.sections()
            if at[:1] != ("damper",) or columns or at == ("damper", labels.damper)
        ]
        return [labels, self.project.reads(path), bool(content.logs), columns, sections]

    def text(self, path: str, given: TextSpec) -> tuple[TextOptions | None, TextOptions | None]:
        """How a text is written: what is said of this file, and what of any but plain CSV.

        given : of the command line, which wins key by key
        """
        own = dict(pairs_of(given))
        said = {}
        if self.project.reads(path):
            said = {k: str(s.value) for k, s in self.project.text(self.labels(path)).items()}
        if not said:
            return (parse_text_options(own) if own else None), None
        merged = parse_text_options({**said, **own})
        if own:
            self._use("text", [k for k in said if k not in own])
            return merged, None
        return None, merged

    def of_log(
        self, source: TableSource, given: Sequence[ColumnMapping], where: Sequence[Where], *,
        needed: Sequence[str], say: Callable[[str], None],
    ) -> OfLog:  # fmt: skip
        """What holds for a log that is open.

        given, where : of the command line, which win column by column
        needed : contract columns that the command cannot do without
        Raises InputProblem where the log has some of the project's columns but not all that are
        needed, and where it holds several corners and none is chosen; UsageProblem.
        """
        labels = self._labels(source, where, say)
        if not self.project.reads(source.path):
            return OfLog(tuple(given), tuple(where), labels)
        if source.text is not None and source.text.options != TextOptions():
            self._use("text", list(self.project.text(labels)))
        labels = self._corner(source, labels, needed)
        columns = self.project.columns(labels)
        taken = {m.target for m in given}
        own = [self._mapping(t, s) for t, s in columns.items() if t not in taken]
        found = [m for m in own if _is_in(m, source)]
        of_lab = bool(self.project.content.logs) or any(m.source not in TARGETS for m in found)
        if of_lab:
            self._missing([m for m in own if m not in found], source, needed, say)
        # With its unit only now: to read units takes an import that pipes can do without.
        mappings = parse_maps([m.spec for m in found], self._said, given)
        self._use("columns", [m.target for m in found if m.source != m.target])
        rows = [w for w in self._where(labels, where) if w.column in source.columns]
        self._use("where", [w.column for w in rows])
        self._use("", [f"{name} {text}" for name, text in labels.texts().items()
                       if getattr(self, name, None) is None])  # fmt: skip
        return OfLog((*given, *mappings), (*where, *rows), labels)

    def of_all(self, labels: Sequence[Labels | None], say: Callable[[str], None]) -> Labels:
        """What logs that are taken together are all of."""
        dampers = list(dict.fromkeys(one.damper for one in labels if one and one.damper))
        if len(dampers) > 1:
            say(f"they are of {len(dampers)} dampers by {self.project.name}: {listed(dampers, 8)}")
        return common([one for one in labels if one is not None])

    @property
    def _said(self) -> str:
        return f"{self.project.name}, columns"

    def _mapping(self, target: str, said: Said) -> ColumnMapping:
        return ColumnMapping(target, said.value.strip(), f"{target}={said.value}", self._said)

    def _where(self, labels: Labels, given: Sequence[Where]) -> list[Where]:
        asked = {w.column for w in given}
        said = self.project.where(labels).items()
        return [Where(k, tuple(s.value)) for k, s in said if k not in asked]

    def _labels(
        self, source: TableSource, where: Sequence[Where], say: Callable[[str], None]
    ) -> Labels:
        """With those that stand in columns."""
        named = self.project.content.labels.columns
        here = {label: column for label, column in named.items() if column in source.columns}
        labels = self.labels(source.path)
        if not here:
            return labels
        rows = [*where, *(w for w in self._where(labels, where) if w.column in source.columns)]
        stated = _stated(source, here, rows, say)
        return self.labels(source.path, stated)

    def _corner(self, source: TableSource, labels: Labels, needed: Sequence[str]) -> Labels:
        """The corner whose columns the log has, where nobody says it and it has those of one."""
        corners = self.project.content.corner
        if labels.corner is not None or not corners or {"t", "x"} <= set(source.columns):
            return labels
        # Columns of their own: a time is there for all.
        uses = Counter(
            v for _, section in self.project.sections() for v in set(section.columns.values())
        )
        here = [
            name for name, section in corners.items()
            if any(
                uses[v] == 1 and _is_in(self._mapping(t, Said(v, ())), source)
                for t, v in section.columns.items()
            )
        ]  # fmt: skip
        if len(here) > 1 and needed:
            raise InputProblem(
                f"holds columns of the corners {', '.join(here)} by {self.project.name}; choose"
                f" one: --corner {here[0]}", file=source.name,
            )  # fmt: skip
        return chosen(labels, None, here[0]) if len(here) == 1 else labels

    def _missing(
        self, missing: Sequence[ColumnMapping], source: TableSource, needed: Sequence[str],
        say: Callable[[str], None],
    ) -> None:  # fmt: skip
        """Refuse a log of the lab that lacks what its project names and the command needs."""
        for m in missing:
            if m.target in source.columns or (m.target in _OPTIONAL and m.target not in needed):
                continue
            if m.target != "duty" and m.target not in needed:
                continue
            none = ', or --map "duty=0" where there was no control' if m.target == "duty" else ""
            raise InputProblem(
                f"no column '{m.source}', which {self.project.name} names as '{m.target}'; the log"
                f" has {listed(source.columns)}; --map says which it is{none}, and"
                " --no-project leaves the project aside", file=source.name,
            )  # fmt: skip
        absent = [m for m in missing if m.target in ("temperature", "xdot", "record")]
        if absent:
            names = listed([f"'{m.source}' ({m.target})" for m in absent])
            say(f"without {names}, which {self.project.name} names")

    def _use(self, what: str, names: Sequence[str]) -> None:
        if names:
            self.used(f"{what} {', '.join(names)}".strip())


def _is_in(mapping: ColumnMapping, source: TableSource) -> bool:
    return mapping.is_in((*source.columns, *source.clocks), source.units)


def read_labels(project: Project, path: str) -> Labels:
    """What a log is of by its path and its columns; opens it only if columns are to be asked.

    Raises InputProblem, UsageProblem as reading the log would.
    """
    if not project.content.labels.columns:
        return project.labels(path)
    reading = ProjectReading(project)
    text, assumed = reading.text(path, None)
    source = open_source(path, text=text, assumed=assumed)
    return reading._labels(source, (), lambda line: None)


def _stated(
    source: TableSource, columns: Mapping[str, str], where: Sequence[Where],
    say: Callable[[str], None],
) -> dict[str, str]:  # fmt: skip
    """Label -> the one value of its column, in the rows that are chosen."""
    import pyarrow as pa
    import pyarrow.compute as pc

    wanted = [*columns.values(), *needed_columns(source.columns, where, source.name)]
    table, _ = read_source(source, list(dict.fromkeys(wanted)), labels=list(columns.values()))
    kept = chosen_rows(table, where, source.name)
    table = table if kept is None else table.take(kept)
    out = {}
    for label, column in columns.items():
        values = pc.unique(table.column(column)).drop_null()
        if pa.types.is_dictionary(values.type):
            values = values.cast(values.type.value_type)
        if len(values) == 1:
            out[label] = str(values[0].as_py())
        elif len(values) > 1:
            many = f"more than {_MANY}" if len(values) > _MANY else len(values)
            say(f"'{column}' holds {many} values, so that it is no {label}")
    return out
