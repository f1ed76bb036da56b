"""What a project file may hold: keys, types and ranges, and its JSON Schema."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

NAME = "erdctl.project/1"
CORNERS = ("fl", "fr", "rl", "rr")

Corner = Literal["fl", "fr", "rl", "rr"]
Name = Annotated[str, Meta(min_length=1, max_length=200)]
Option = bool | int | float | str | list[str | int | float]


class AmplifierLimits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Limits of the PWM amplifier, as `mimic` and `export --emulate` have options for them.

    duty_max : highest duty, 0..1;  resolution : smallest step of the duty;  slew : of it [1/s]
    update_rate : how often it can change [Hz];  carrier : [Hz];  full_scale : at duty 1 [V]
    """

    duty_max: float | None = None
    resolution: float | None = None
    slew: float | None = None
    update_rate: float | None = None
    carrier: float | None = None
    full_scale: float | None = None


class RigSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The rig: highest temperature of the damper [degC]; findings of its checks that are right as
    they are; whether any other finding ends a command with exit code 1."""

    max_temperature: Annotated[float, Meta(ge=-273.0, le=1e4)] | None = None
    accept: list[Name] | None = None
    strict: bool | None = None


class Section(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What may be said in general, of a corner, and of a damper.

    columns : as `--map`, COLUMN = "NAME[UNIT]";  text : as `--text`;  where : as `--where`
    options : of all commands that have them, or, in a table of its name, of one command
    """

    columns: dict[str, Name] = {}
    text: dict[str, str | int | float] = {}
    where: dict[Name, Name | list[Name]] = {}
    amplifier: AmplifierLimits = AmplifierLimits()
    rig: RigSettings = RigSettings()
    options: dict[str, Option | dict[str, Option]] = {}


class LabelRules(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How damper, corner, date and conditions are read.

    path : regular expression whose named groups are found in the path of a log, with / between
        folders, from the folder of the project file on
    date : its format, as strptime has it; without, ISO 8601
    columns : damper, corner, date or a condition = the log's column that holds it
    damper : the one of all logs whose path and columns name none
    """

    path: Annotated[str, Meta(min_length=1, max_length=1000)] | None = None
    date: Annotated[str, Meta(min_length=1, max_length=100)] | None = None
    columns: dict[Name, Name] = {}
    damper: Name | None = None


class ProjectFile(Section, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A project file (TOML).

    logs : which files columns, text and where are for, as patterns like "raw/**/*.csv"; without,
        all logs that have such columns
    """

    schema: Literal["erdctl.project/1"] = "erdctl.project/1"
    logs: list[Name] = []
    labels: LabelRules = LabelRules()
    corner: dict[Corner, Section] = {}
    damper: dict[Name, Section] = {}


def json_schema() -> dict[str, Any]:
    """JSON Schema of a project file, for editors that check TOML by one."""
    return msgspec.json.schema(ProjectFile)
