"""LabVIEW measurement files (.lvm): the blocks above the samples, and those between segments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from erdctl.core.errors import InputProblem
from erdctl.io.spelling import unit_spelt
from erdctl.io.text.options import SEPARATORS

FIRST = "LabVIEW Measurement"
END = "***End_of_Header***"
_TIME = "X_Value"


@dataclass(frozen=True)
class LabView:
    """What the blocks say.

    header_line : the line with the names of the channels
    begin, step : of channels whose times are not written [s];  written : whether they are
    labels : units of the channels, "" where none is stated;  columns : the header's first cell
    """

    separator: str
    decimal: str
    header_line: int
    written: bool
    begin: float | None
    step: float | None
    labels: tuple[str, ...]
    time: bool

    def units(self, names: Sequence[str]) -> dict[str, str]:
        """Units of columns: seconds of X_Value, and those of the channels."""
        out = {_TIME: "s"} if self.time and _TIME in names else {}
        channels = [name for name in names if name not in (_TIME, "Comment")]
        for name, label in zip(channels, self.labels, strict=False):
            unit = unit_spelt(label)
            if unit:
                out[name] = unit
        return out


def labview_of(lines: Sequence[str], file: str) -> LabView | None:
    """The blocks of a .lvm file, None if it is none.

    Raises InputProblem where channels have times of their own.
    """
    if not any(line.startswith(FIRST) for line in lines[:2]):
        return None
    ends = [n for n, line in enumerate(lines, 1) if line.startswith(END)]
    if not ends:
        raise InputProblem(f"a LabVIEW measurement without '{END}': cut off", file=file)
    file_block = _pairs(lines[: ends[0]])
    called = next(iter(file_block.get("Separator", [""])), "Tab")
    separator = SEPARATORS.get(called.lower(), "\t")
    if called.lower() not in SEPARATORS and "," in lines[1]:
        separator = ","
    channel_end = ends[1] if len(ends) > 1 else ends[0]
    block = _pairs(lines[ends[0] : channel_end], separator)
    header_line = next(
        (n for n in range(channel_end + 1, len(lines) + 1) if lines[n - 1].strip()), 0
    )
    if not header_line:
        raise InputProblem("a LabVIEW measurement without samples", file=file)
    columns = next(iter(file_block.get("X_Columns", [""])), "One")
    if columns == "Multi" and lines[header_line - 1].split(separator).count(_TIME) > 1:
        raise InputProblem(
            "every channel has times of its own (X_Columns Multi); export it with one time column",
            file=file,
            row=header_line,
        )
    decimal = next(iter(file_block.get("Decimal_Separator", [""])), "") or None
    return LabView(
        separator,
        "," if decimal == "," else ".",
        header_line,
        columns != "No",
        _number(block.get("X0")),
        _number(block.get("Delta_X")),
        tuple(block.get("Y_Unit_Label", [])),
        all(value == "Time" for value in block.get("X_Dimension", ["Time"]) if value),
    )


def _pairs(lines: Sequence[str], separator: str | None = None) -> dict[str, list[str]]:
    out: dict[str, list[str]] = {}
    for line in lines:
        if separator is None:
            sign = next((s for s in ("\t", ",", ";") if s in line), "\t")
        else:
            sign = separator
        key, _, rest = line.partition(sign)
        values = [part.strip() for part in rest.split(sign)] if sign != rest.strip() else [rest]
        if key.strip() and not key.startswith("***"):
            # `Decimal_Separator<tab>,` in a file separated by tabs holds a comma.
            out[key.strip()] = values if any(values) else [rest.strip()]
    return out


def _number(values: Sequence[str] | None) -> float | None:
    """The one number that all channels have."""
    found = set()
    for value in values or ():
        if value:
            try:
                found.add(float(value.replace(",", ".")))
            except ValueError:
                return None
    return found.pop() if len(found) == 1 else None
