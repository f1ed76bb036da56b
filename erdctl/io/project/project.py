"""A project file in memory: what of it holds for a log, a damper, a command."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from erdctl.io.project.labels import Labels, groups, labels_of_groups, relative
from erdctl.io.project.patterns import pattern_of
from erdctl.io.project.shape import AmplifierLimits, ProjectFile, Section

GENERAL = ""  # where a value is from that is said of all


@dataclass(frozen=True)
class Said:
    """A value and where it stands: "" for what holds of all, else `corner.fl` or `damper.A07`."""

    value: Any
    where: str

    def key(self, name: str) -> str:
        """Its place in the file.

        >>> Said(0.4, "damper.A07").key("amplifier.duty_max")
        'damper.A07.amplifier.duty_max'
        """
        return f"{self.where}.{name}" if self.where else name


@dataclass(frozen=True, eq=False)
class Project:
    """What a project file says. What is said of a damper wins over what is said of a corner, and
    that over what is said of all; values win one by one, not table by table.

    name : for messages;  folder : absolute, in which the file lies;  sha256 : of its bytes
    """

    name: str
    folder: str
    sha256: str
    content: ProjectFile

    def labels(self, path: str, columns: Mapping[str, str] | None = None) -> Labels:
        """Damper, corner, date and conditions of a log, by its path and by its columns.

        path : of the log, of which only the letters are looked at; "-" is none
        columns : label -> the one value of the column that `labels.columns` names for it; wins
        Raises InputProblem for a date or a corner that is none.
        """
        found = {} if path == "-" else groups(self._pattern, relative(path, self.folder))
        rules = self.content.labels
        return labels_of_groups({**found, **(columns or {})}, rules.date, path)

    def columns(self, labels: Labels) -> dict[str, Said]:
        """Contract column -> NAME[UNIT], as `--map` has it."""
        return {k: s for where, section in self._sections(labels)
                for k, v in section.columns.items() for s in (Said(v, where),)}  # fmt: skip

    def mapping(self, labels: Labels) -> tuple[str, ...]:
        """The same as options `--map`."""
        return tuple(f"{k}={s.value}" for k, s in self.columns(labels).items())

    def text(self, labels: Labels) -> dict[str, Said]:
        """Key -> value, as `--text` has them."""
        return {k: Said(v, where) for where, section in self._sections(labels)
                for k, v in section.text.items()}  # fmt: skip

    def where(self, labels: Labels) -> dict[str, Said]:
        """Column -> list of values, as `--where` has them."""
        return {k: Said([v] if isinstance(v, str) else v, where)
                for where, section in self._sections(labels)
                for k, v in section.where.items()}  # fmt: skip

    def limits(self, labels: Labels) -> dict[str, Said]:
        """`amplifier.duty_max`, `rig.accept` and so on -> value, of those that are given."""
        out = {}
        for where, section in self._sections(labels):
            for table in ("amplifier", "rig"):
                part = getattr(section, table)
                for name in part.__struct_fields__:
                    if (value := getattr(part, name)) is not None:
                        out[f"{table}.{name}"] = Said(value, where)
        return out

    def options(self, command: str, labels: Labels) -> dict[str, Said]:
        """Name of an option, without dashes before it -> value, for one command.

        The names are those of all commands: what a command does not have is left to the caller.
        """
        out = {}
        for where, section in self._sections(labels):
            own = section.options.get(command)
            plain = {k: v for k, v in section.options.items() if not isinstance(v, dict)}
            for key, values in (("options", plain), (f"options.{command}", own)):
                for name, value in values.items() if isinstance(values, dict) else ():
                    out[name] = Said(value, f"{where}.{key}" if where else key)
        return out

    def reads(self, path: str) -> bool:
        """Whether columns, text and where are for a log, by `logs`."""
        if not self.content.logs:
            return True
        here = "" if path == "-" else relative(path, self.folder)
        return any(p.fullmatch(here) for p in self._globs)

    def with_limits_of_their_own(self) -> list[str]:
        """Dampers and corners for which the amplifier's or the rig's limits are said apart."""
        return [
            where for where, section in self.sections()
            if where != GENERAL
            and (section.amplifier != AmplifierLimits() or section.rig.max_temperature is not None)
        ]  # fmt: skip

    def sections(self) -> Iterator[tuple[str, Section]]:
        """All of them, and what they are called in the file."""
        yield GENERAL, self.content
        yield from ((f"corner.{name}", s) for name, s in self.content.corner.items())
        yield from ((f"damper.{name}", s) for name, s in self.content.damper.items())

    def _sections(self, labels: Labels) -> Iterator[tuple[str, Section]]:
        """Those that hold, the one that wins last."""
        here = {GENERAL, f"corner.{labels.corner}", f"damper.{labels.damper}"}
        return ((where, section) for where, section in self.sections() if where in here)

    @cached_property
    def _pattern(self) -> re.Pattern[str] | None:
        path = self.content.labels.path
        return None if path is None else re.compile(path)

    @cached_property
    def _globs(self) -> list[re.Pattern[str]]:
        return [pattern_of(glob) for glob in self.content.logs]


def chosen(labels: Labels, damper: str | None, corner: str | None) -> Labels:
    """Labels with those that the user gave in their place."""
    return replace(labels, damper=damper or labels.damper, corner=corner or labels.corner)
