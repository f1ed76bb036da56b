"""Small phrases that several pages share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from erdctl.core.messages import counted
from erdctl.core.recording import Array, Recording
from erdctl.report.readable import error_of, number, scaled


def plain(name: str) -> str:
    """An effect's name as words."""
    return name.replace("_", " ")


def joined(words: Sequence[str], last: str = "and") -> str:
    """A list in a sentence.

    Check: a, b, c gives "a, b and c".
    >>> joined(["a", "b", "c"])
    'a, b and c'
    """
    return f" {last} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def logs_text(recording: Recording) -> str:
    """The logs by name, two at most."""
    names = [s.name if s.name != "-" else "stdin" for s in recording.sources] or ["a log"]
    return ", ".join(names[:2]) + (f" and {len(names) - 2} more" if len(names) > 2 else "")


def extent(recording: Recording, levels: int) -> str:
    """How much was recorded."""
    seconds = sum(float(recording.t[p][-1] - recording.t[p][0]) for p in recording.slices)
    records, shown = counted(len(recording.names), "record"), counted(levels, "PWM level")
    return (f"{len(recording):,} samples, {seconds:.3g} s, {records}, {shown}").replace(
        ",", "\u202f", f"{len(recording):,}".count(",")
    )


def rig_line(fault: Mapping[str, Any]) -> str:
    """A fault of the rig, as a document holds it, in one line."""
    where = f"record {fault['record']}: " if fault["record"] else ""
    return f"{where}{fault['text']}; {fault['remedy']}"


def peak_of(force: Array) -> float:
    """The highest force either way [N]."""
    return max(float(force.max()), -float(force.min()))


def shown_value(given: dict[str, Any]) -> dict[str, str]:
    """Value, standard error and unit of a document's parameter, as people read them."""
    value = given["value"]
    factor, unit = scaled(given["unit"], value or max(given.get("interval") or (0.0,)))
    return {
        "value": "not identified" if value is None else number(value * factor),
        "stderr": error_of(
            given["stderr"],
            factor,
            at_bound=given.get("at_bound", False),
            value=value,
            within=given.get("interval"),
        ),
        "unit": unit,
    }
