"""A project file out of sample logs: what is recognised, and comments for what is left to people.

Written as text and not by a library, since comments are most of it; a test reads it back.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.messages import shown
from erdctl.io.maps import parse_maps
from erdctl.io.meaning import Meant, in_a_unit, meant, unit_of_column
from erdctl.io.plan import plan_columns
from erdctl.io.project.corners import CarCorner, corners_of
from erdctl.io.project.names import label_lines
from erdctl.io.sources import TableSource, open_source
from erdctl.io.spelling import name_and_unit, stated
from erdctl.io.stored import si
from erdctl.io.text.options import (
    DECIMALS,
    SEPARATORS,
    THOUSANDS,
    TextOptions,
    TextSpec,
    parse_text_options,
)
from erdctl.io.units import RECORD, TARGETS, Conversion

Say = Callable[[str], None]
_WANTED = ("t", "x", "xdot", "duty", "force", "temperature")


@dataclass
class Columns:
    """Lines of a table of columns; unclear : comments for those that people must say."""

    lines: list[str] = field(default_factory=list)
    unclear: list[str] = field(default_factory=list)


def project_text(paths: Sequence[str], folder: str, *, text: TextSpec, say: Say) -> str:
    """The project file for logs like these.

    paths : of logs, of which the first is the sample;  folder : in which the file will lie
    text : option `--text`, which goes into the file;  say : takes a line for what was assumed
    Raises InputProblem, UsageProblem as reading the logs would.
    """
    options = parse_text_options(text)
    given = None if options == TextOptions() else options
    sources = [open_source(path, text=given) for path in paths]
    for source in sources[1:]:
        if lost := [c for c in sources[0].columns if c not in source.columns]:
            say(f"{source.name}: without {', '.join(lost[:8])}, which {sources[0].name} has")
    sample = sources[0]
    corners = corners_of(sample.columns)
    general = _columns(sample, corners, None, say)
    ambiguous = any(_is_bare(line) for line in general.lines)
    parts = [
        "# What holds for all logs in this folder and below; options on the command line win.",
        "# `erdctl project show` prints what applies, `erdctl project --help` says what may stand"
        " here.",
        f"# Written from {_comment(sample.name)}.",
        'schema = "erdctl.project/1"',
        "",
        "# Which files the columns and the text below are for; without it, all that have such"
        " columns.",
        f"{'' if ambiguous else '# '}logs = [{_globs(paths, folder)}]",
        "",
        "# The logs' own columns, as --map has them: COLUMN = \"NAME[UNIT]\". A unit that the log"
        " states",
        "# itself needs none. x and xdot are positive in compression: a minus before NAME turns a"
        " sign.",
        "[columns]",
        *general.lines, *general.unclear,
        *_text(sample, options),
    ]  # fmt: skip
    for corner in corners:
        found = _columns(sample, corners, corner, say)
        parts += ["", f"[corner.{corner.name}.columns]", *found.lines, *found.unclear]
    return "\n".join([*parts, *label_lines(paths, folder), _LIMITS]) + "\n"


_LIMITS = """
# Limits of the amplifier: mimic and export --emulate keep within them.
[amplifier]
# duty_max = 0.45         # highest duty, 0..1
# resolution = 0.001      # smallest step of the duty
# slew = 20.0             # fastest change of the duty, per second
# update_rate = 1000.0    # how often the duty can change, Hz
# carrier = 25000.0       # PWM carrier, Hz
# full_scale = 5000.0     # voltage at duty 1

[rig]
# max_temperature = 60.0  # of the damper, degC: mimic refuses a hotter log
# accept = ["speed_unit"] # findings of the rig checks that are right as they are
# strict = true           # any other finding ends a command with exit code 1

# Options of all commands that have them; of one command in a table of its own.
[options]
# operator = "A. Tester"

# [options.diagnose]
# jobs = 2

# What differs for one damper, by its name: any of the tables above but [labels].
# [damper.A07.amplifier]
# duty_max = 0.4"""


def _columns(
    source: TableSource, corners: Sequence[CarCorner], corner: CarCorner | None, say: Say
) -> Columns:
    """The columns of one corner, or all others: what the reader recognises, and its doubts."""
    out = Columns()
    others = {c for one in corners for c in one.own}
    seen = corner or next(iter(corners), None)
    view = source if seen is None else seen.view(source)

    def own(column: str) -> str:
        return column if seen is None else seen.own_name(column)

    def told(line: str) -> None:
        if seen is None:  # the names in a view are not those of the log
            say(f"{source.name}: {line}")

    plan = plan_columns(view, (), needed=(), say=told)
    for target in TARGETS:
        if target in plan:
            column, convert = plan[target]
            if (own(column) in others) == (corner is not None):
                _known(out, source, target, own(column), convert)
        elif target in _WANTED:
            one = meant(view, target, {c for c, _ in plan.values()})
            names = [n for n in map(own, one.likely) if (n in others) == (corner is not None)]
            if names:
                _unclear(out, source, one, names)
            elif seen is None and target in ("t", "x", "force", "duty"):
                out.unclear.append(f'# {target} = "NAME[UNIT]"  # not found')
    return out


def _known(
    out: Columns, source: TableSource, target: str, column: str, convert: Conversion
) -> None:
    """A line that gives the same reading as the reader's own."""
    unit = unit_of_column(source, column)
    if column == target and unit is None:
        unit = "" if target == RECORD else f" in {si(target) or '0..1'}"
        out.lines.append(f"# {target} = {_quoted(column)}  # as it is{unit}")
        return
    bare, spelt = stated(column)[0], stated(column)[1]
    ways = [column, f"{bare}[{spelt}]", f"{column}[{unit}]"]
    for way in ways:
        try:
            (mapping,) = parse_maps([f"{target}={way}"])
            found, by = mapping.find((*source.columns, *source.clocks), source.name)
        except (InputProblem, UsageProblem):
            continue
        if found != column:
            continue
        by_file = mapping.unit is None and name_and_unit(column)[1] is None
        if (by_file or by == convert) and len(way) <= 200:
            said = f"  # in {_comment(unit)}" if unit and unit not in way else ""
            out.lines.append(f"{target} = {_quoted(way)}{said}")
            return
    out.unclear.append(f"# {target} = {_quoted(column)}  # cannot be written here: rename it")


def _unclear(out: Columns, source: TableSource, one: Meant, names: Sequence[str]) -> None:
    why = one.why or "may be it"
    for name in names[:4]:
        written = _quoted(in_a_unit(source, name, one.target))
        out.unclear.append(f"# {one.target} = {written}  # {_comment(why)}; complete it")


def _text(source: TableSource, given: TextOptions) -> list[str]:
    """How the text is written, so that every other file is read in the same way."""
    written = source.text
    if written is None:
        return []
    dialect = written.dialect
    signs = {
        "separator": (SEPARATORS, dialect.separator), "decimal": (DECIMALS, dialect.decimal),
        "thousands": (THOUSANDS, dialect.thousands),
    }  # fmt: skip
    lines = []
    for key, (known, sign) in signs.items():
        name = next((n for n, s in known.items() if s == sign), sign)
        # Thousands are left open where none was seen; a file with some is then recognised.
        if name and (sign or getattr(given, key) is not None):
            lines.append(f"{key} = {_quoted(name)}")
    for key in ("encoding", "date", "header", "units", "interval"):
        value = getattr(given, key)
        if value is not None:
            value = "none" if key in ("header", "units") and value == 0 else value
            lines.append(f"{key} = {json.dumps(value, ensure_ascii=False)}")
    return ["", f"# How texts are written, as --text has it; read as {_comment(written.read_as)}.",
            "[text]", *lines]  # fmt: skip


def _is_bare(line: str) -> bool:
    """Whether a line takes a column of one of erdctl's names, which is SI where erdctl wrote it."""
    if line.startswith("#"):
        return False
    name = json.loads(line.partition(" = ")[2].partition('"  # in ')[0].rstrip('"') + '"')
    return name_and_unit(name)[0].lstrip("- ") in TARGETS


def _globs(paths: Sequence[str], folder: str) -> str:
    import os

    from erdctl.io.project.labels import relative

    found = []
    for path in paths:
        here = relative(path, folder) if path != "-" else "logs.csv"
        base, suffix = os.path.splitext(here)
        found.append("/".join([*base.split("/")[:-1], f"*{suffix}"]))
    return ", ".join(_quoted(g) for g in dict.fromkeys(found))


def _quoted(text: str) -> str:
    """A basic string of TOML: that of JSON, but for DEL."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def _comment(text: str) -> str:
    return shown(text, 200)
