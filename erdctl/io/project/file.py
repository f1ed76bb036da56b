"""A project file as it is read: strictly, and whatever is wrong with its line and its key."""

from __future__ import annotations

import datetime as dt
import hashlib
import math
import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

from erdctl.core.errors import UsageProblem
from erdctl.io.project.labels import OWN
from erdctl.io.project.lines import line_of, where_of
from erdctl.io.project.patterns import pattern_of
from erdctl.io.project.project import Project
from erdctl.io.project.shape import ProjectFile, Section
from erdctl.io.spelling import name_and_unit
from erdctl.io.text.options import parse_text_options
from erdctl.io.units import RECORD, TARGETS, UNITS
from erdctl.model.amplifier import Amplifier

LARGEST = 1 << 20  # bytes


class ProjectProblem(UsageProblem):
    """A project file cannot be used; it says on the user's behalf what the command line may say.

    key : path in the file, in dots;  line : from 1
    """

    def __init__(self, message: str, *, file: str, key: str = "", line: int | None = None) -> None:
        self.file = file
        place = "".join([f"line {line}: " if line else "", f"{key}: " if key else ""])
        super().__init__(f"{file}: {place}{message}")


def read_project(path: str) -> Project:
    """The project file at a path. Raises UsageProblem with line and key of what is wrong."""
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise UsageProblem(f"cannot read the project file '{path}': {reason}") from None
    return parse_project(data, path)


def parse_project(data: bytes, path: str) -> Project:
    """The same of its bytes; path : where they are from, and what they are called."""
    name = _shown(path)
    text, raw = _parsed(data, name)
    try:
        content = msgspec.convert(raw, ProjectFile)
    except msgspec.ValidationError as error:
        message, key = where_of(str(error), raw)
        raise _problem(message, name, text, key) from None
    project = Project(
        name=name, folder=str(Path(path).resolve().parent), source=text,
        sha256=hashlib.sha256(data).hexdigest(), content=content,
    )  # fmt: skip
    for message, key in _wrong(project):
        raise _problem(message, name, text, key)
    return project


def _shown(path: str) -> str:
    """A path as short as it can be said from here."""
    try:
        short = os.path.relpath(path)
    except ValueError:  # another drive
        return path
    return short if len(short) < len(path) else path


def _parsed(data: bytes, name: str) -> tuple[str, dict[str, Any]]:
    if len(data) > LARGEST:
        raise ProjectProblem("larger than 1 MB, which is no project file", file=name)
    try:
        text = data.decode("utf-8-sig")
        return text, tomllib.loads(text)
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise ProjectProblem("not UTF-8, in which TOML is written", file=name, line=line) from None
    except RecursionError:
        raise ProjectProblem("brackets within brackets, hundreds deep", file=name) from None
    except ValueError as error:  # TOMLDecodeError, and numbers that Python does not read
        found = re.search(r" \(at line (\d+), column (\d+)\)$", str(error))
        message = str(error)[: found.start()] if found else str(error)
        hint = ""
        if "escape" in message:
            hint = "; between single quotes a backslash is itself: path = '(?P<damper>\\d+)'"
        raise ProjectProblem(
            f"not TOML: {message[:200]}{hint}", file=name, line=int(found[1]) if found else None
        ) from None


def problem_of(project: Project, key: tuple[str, ...], message: str) -> ProjectProblem:
    """What is wrong with a value of a project that has been read."""
    return _problem(message, project.name, project.source, key)


def _problem(message: str, name: str, text: str, key: tuple[str, ...]) -> ProjectProblem:
    return ProjectProblem(message, file=name, key=".".join(key), line=line_of(text, key))


Wrong = tuple[str, tuple[str, ...]]


def _wrong(project: Project) -> Iterator[Wrong]:
    """What types do not tell: a message and the key that it is about."""
    content = project.content
    for glob in content.logs:
        try:
            pattern_of(glob)
        except re.error:
            yield f"'{glob}' is no pattern; write it like raw/**/*.csv", ("logs",)
    yield from _wrong_labels(project)
    for at, section in project.sections():
        for message, key in (*_wrong_columns(section, bool(content.logs)), *_wrong_values(section)):
            yield message, (*at, *key)


def _wrong_labels(project: Project) -> Iterator[Wrong]:
    rules = project.content.labels
    if rules.path is not None:
        try:
            found = re.compile(rules.path).groupindex
        except (re.error, RecursionError, OverflowError) as error:
            yield f"no regular expression: {error}", ("labels", "path")
            return
        if not found:
            yield (
                "has no named group; write (?P<damper>...), (?P<corner>...), (?P<date>...), or the"
                " name of a condition", ("labels", "path"),
            )  # fmt: skip
    if rules.date is not None:
        try:
            dt.datetime.strptime(dt.datetime(2024, 5, 1).strftime(rules.date), rules.date)
        except ValueError as error:
            yield f"no format of a date, such as %Y%m%d: {error}", ("labels", "date")
        if "%" not in rules.date:
            yield "no format of a date, such as %Y%m%d", ("labels", "date")
    for name in rules.columns:
        if name not in OWN and not re.fullmatch(r"\w+", name):
            yield f"'{name}' is no name of a condition: letters, digits, _", ("labels", "columns")


def _wrong_columns(section: Section, told_apart: bool) -> Iterator[Wrong]:
    for target, source in section.columns.items():
        key = ("columns", target)
        if target not in TARGETS:
            yield f"no column of erdctl's; columns are {', '.join(TARGETS)}", key
            continue
        name, unit = name_and_unit(source)
        bare = name.lstrip("- ")
        same = unit in (None, UNITS.get(target)) and source == name == target
        if bare in TARGETS and not same and not told_apart and target != RECORD:
            # In a pipe, and in every file that erdctl wrote, this column is there in SI.
            yield (
                f"'{source}' would also be read where erdctl wrote '{bare}', in SI; say which files"
                ' are meant: logs = ["raw/*.csv"] at the top', key,
            )  # fmt: skip


def _wrong_values(section: Section) -> Iterator[Wrong]:
    try:
        parse_text_options(section.text)
    except UsageProblem as error:
        yield str(error).removeprefix("--text").lstrip(": "), ("text",)
    given = {
        name: getattr(section.amplifier, name) for name in section.amplifier.__struct_fields__
        if getattr(section.amplifier, name) is not None
    }  # fmt: skip
    for name, value in given.items():
        if not math.isfinite(value):
            yield f"is {value}, expected a number; a limit that is none is left out", (
                "amplifier", name,
            )  # fmt: skip
    try:
        Amplifier(**given)
    except UsageProblem as error:
        yield str(error), ("amplifier",)
    limit = section.rig.max_temperature
    if limit is not None and not math.isfinite(limit):
        yield f"is {limit}, expected a number", ("rig", "max_temperature")
    for key, value in section.options.items():
        plain = value if isinstance(value, dict) else {key: value}
        for name, one in plain.items():
            at = ("options", key, name) if isinstance(value, dict) else ("options", key)
            if isinstance(one, float) and not math.isfinite(one):
                yield f"is {one}, expected a number", at
