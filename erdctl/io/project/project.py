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

At = tuple[str, ...]
GENERAL: At = ()  # where that stands which is said of all


@dataclass(frozen=True)
class Said:
    """A value and the table that it stands in: () for what holds of all, `("damper", "A07")`."""

    value: Any
    at: At

    def key(self, *names: str) -> str:
        """Its place in the file, in dots.

        >>> Said(0.4, ("damper", "A07")).key("amplifier", "duty_max")
        'damper.A07.amplifier.duty_max'
        """
        return ".".join((*self.at, *names))


@dataclass(frozen=True, eq=False)
class Project:
    """What a project file says. What is said of a damper wins over what is said of a corner, and
    that over what is said of all; values win one by one, not table by table.

    name : for messages;  folder : absolute, in which the file lies;  source : its text
    sha256 : of its bytes
    """

    name: str
    folder: str
    sha256: str
    source: str
    content: ProjectFile

    def labels(self, path: str, columns: Mapping[str, str] | None = None) -> Labels:
        """Damper, corner, date and conditions of a log, by its path and by its columns.

        path : of the log, of which only the letters are looked at; "-" is none
        columns : label -> the one value of the column that `labels.columns` names for it; wins
        Raises InputProblem for a date or a corner that is none.
        """
        found = {} if path == "-" else groups(self._pattern, relative(path, self.folder))
        rules = self.content.labels
        found = {"damper": rules.damper, **{k: v for k, v in found.items() if v}}
        return labels_of_groups({**found, **(columns or {})}, rules.date, path)

    def columns(self, labels: Labels) -> dict[str, Said]:
        """Contract column -> NAME[UNIT], as `--map` has it."""
        return {k: Said(v, at) for at, section in self._sections(labels)
                for k, v in section.columns.items()}  # fmt: skip

    def mapping(self, labels: Labels) -> tuple[str, ...]:
        """The same as options `--map`."""
        return tuple(f"{k}={s.value}" for k, s in self.columns(labels).items())

    def text(self, labels: Labels) -> dict[str, Said]:
        """Key -> value, as `--text` has them."""
        return {k: Said(v, at) for at, section in self._sections(labels)
                for k, v in section.text.items()}  # fmt: skip

    def where(self, labels: Labels) -> dict[str, Said]:
        """Column -> list of values, as `--where` has them."""
        return {k: Said([v] if isinstance(v, str) else v, at)
                for at, section in self._sections(labels)
                for k, v in section.where.items()}  # fmt: skip

    def limits(self, labels: Labels) -> dict[str, Said]:
        """`amplifier.duty_max`, `rig.accept` and so on -> value, of those that are given."""
        out = {}
        for at, section in self._sections(labels):
            for table in ("amplifier", "rig"):
                part = getattr(section, table)
                for name in part.__struct_fields__:
                    if (value := getattr(part, name)) is not None:
                        out[f"{table}.{name}"] = Said(value, at)
        return out

    def options(self, command: str, labels: Labels) -> dict[str, Said]:
        """Name of an option, without dashes before it -> value, for one command.

        The names are those of all commands: what a command does not have is left to the caller.
        """
        out = {}
        for at, section in self._sections(labels):
            own = section.options.get(command)
            plain = {k: v for k, v in section.options.items() if not isinstance(v, dict)}
            for keys, values in ((("options",), plain), (("options", command), own)):
                for name, value in values.items() if isinstance(values, dict) else ():
                    out[name] = Said(value, (*at, *keys))
        return out

    def reads(self, path: str) -> bool:
        """Whether columns, text and where are for a log, by `logs`."""
        if not self.content.logs:
            return True
        here = "" if path == "-" else relative(path, self.folder)
        return any(p.fullmatch(here) for p in self._globs)

    def with_limits_of_their_own(self) -> list[At]:
        """Dampers and corners for which the amplifier's or the rig's limits are said apart."""
        return [
            at for at, section in self.sections()
            if at != GENERAL
            and (section.amplifier != AmplifierLimits() or section.rig.max_temperature is not None)
        ]  # fmt: skip

    def sections(self) -> Iterator[tuple[At, Section]]:
        """All of them, and where they stand; the one that wins last."""
        yield GENERAL, self.content
        yield from ((("corner", name), s) for name, s in self.content.corner.items())
        yield from ((("damper", name), s) for name, s in self.content.damper.items())

    def _sections(self, labels: Labels) -> Iterator[tuple[At, Section]]:
        """Those that hold."""
        here = {GENERAL, ("corner", labels.corner), ("damper", labels.damper)}
        return ((at, section) for at, section in self.sections() if at in here)

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
