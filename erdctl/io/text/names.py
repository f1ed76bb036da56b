"""Names of columns and their units, in the lines above the samples."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass

from erdctl.core.errors import InputProblem
from erdctl.core.messages import counted
from erdctl.io.spelling import stated, unit_spelt
from erdctl.io.text.cells import NUMBER, STAMP, cells_of, comment_of, kind_of, stands_alone
from erdctl.io.text.options import TextOptions
from erdctl.io.text.structure import Structure

NUMBERED = "column_{}"
_NO_UNIT = {"1", "", None}


@dataclass(frozen=True)
class Header:
    """Names of the columns, and where they came from.

    names : one a column;  line, units_line : in the file, 0 for none
    units : column -> unit, out of a row of units
    verbatim : the names are the cells of their line, without blanks or names given to empty ones
    """

    names: tuple[str, ...]
    line: int
    units_line: int
    units: dict[str, str]
    verbatim: bool = False


def header_of(
    lines: Sequence[str], after: int, found: Structure, options: TextOptions, file: str
) -> Header:
    """The header above the samples; without one the columns are numbered.

    after : it is below this line

    Raises InputProblem if the header does not have as many names as the samples have cells.
    """
    width = found.width
    above = [n for n in range(found.start - 1, after, -1) if lines[n - 1].strip()]
    likely = [n for n in above if not _is_remark(lines[n - 1], found)]
    if any(_may_name(lines[n - 1], found) for n in likely):
        above = likely
    units_line = options.units or 0
    if options.units is None and options.header != 0:
        below = _units_line(lines, above, found) if above else 0
        units_line = _units_above(lines, above, below, found, options, file) or below
    units = _cells(lines[units_line - 1], found.separator, width) if units_line else []
    if options.header == 0:
        return Header(_numbered(width), 0, units_line, _by_name(_numbered(width), units))
    if options.header:
        line = options.header
        if line > len(lines) or line >= found.start:
            raise InputProblem(
                f"--text header={line}: the samples begin in row {found.start}", file=file
            )
        names = _cells(lines[line - 1], found.separator, width)
        if not _are_names(names):
            raise InputProblem(f"--text header={line}: it holds no names", file=file, row=line)
    else:
        line = next((n for n in above if n != units_line), 0)
        names = _cells(lines[line - 1], found.separator, width) if line else []
        named = any(_may_name(lines[n - 1], found) for n in above if n < line)
        if named and _are_spoilt(names) and len(names) >= found.shortest:
            raise _neither(line, found, file)
        if not _are_names(names) or _is_title(names, line, lines, found):
            if line and comment_of(lines[line - 1]) is None:
                _refuse_values(names, line, found, file)
            line, names = 0, []
    if not line:
        return Header(_numbered(width), 0, units_line, _by_name(_numbered(width), units))
    names = _fitted(names, found, line, file)
    whole = tuple(name or NUMBERED.format(i) for i, name in enumerate(names, 1))
    by_name = _by_name(whole, units)
    for name, unit in by_name.items():
        beside = stated(name)[1]
        if beside is not None and beside != unit:
            raise InputProblem(
                f"{beside} by its name and {unit} by the units in row {units_line}; say which"
                f" holds, e.g. --text header={line},units=none for the names",
                file=file,
                column=name,
            )
    verbatim = tuple(next(csv.reader([lines[line - 1]], delimiter=found.separator), ())) == whole
    return Header(whole, line, units_line, by_name, verbatim)


def _cells(line: str, separator: str, width: int) -> list[str]:
    """The cells of a line above the samples, which may be a comment or separated otherwise."""
    sign = comment_of(line)
    whole = line if sign is None else line.strip()
    without = whole if sign is None else whole[len(sign) :].strip()
    texts = [whole, without] if stands_alone(line) else [without, whole]
    # Names above columns of blanks may be separated by what they are not.
    tried = [separator, "\t", ";", ","] if separator == " " else [separator]
    for text in texts:
        found = [cells_of(text, s) for s in tried]
        # Names with blanks in them stand apart by two or more.
        if separator in (" ", "\t"):
            found.insert(1, [c for c in re.split(r"\s{2,}|\t", text.strip()) if c])
        exact = [cells for cells in found if len(cells) == width]
        if exact:
            return exact[0]
    return cells_of(without, separator)


def _are_names(cells: Sequence[str]) -> bool:
    filled = [cell for cell in cells if cell]
    values = sum(kind_of(cell) in (NUMBER, STAMP) for cell in filled)
    keyed = any(cell.endswith(":") for cell in filled)
    return bool(filled) and values < 0.5 * len(filled) and not keyed


def _is_title(names: Sequence[str], line: int, lines: Sequence[str], found: Structure) -> bool:
    """Whether a line is a sentence above the samples rather than their names."""
    if len(names) == 1:
        return True
    apart = not lines[found.start - 2].strip()
    unlike = len(names) != found.width
    comment = comment_of(lines[line - 1]) is not None
    return (apart and (unlike or found.separator == " ")) or (unlike and comment)


def _are_spoilt(cells: Sequence[str]) -> bool:
    """Whether cells are hardly names but a spoilt sample: `---;ERR;ERR`, `0.0;---`."""
    filled = [cell for cell in cells if cell]
    worded = all(re.search(r"[^\W\d_]", cell) for cell in filled)
    values = any(kind_of(cell) in (NUMBER, STAMP) for cell in filled)
    return values or not worded or len(set(filled)) < len(filled)


def _may_name(line: str, found: Structure) -> bool:
    """Whether a line has a name for every column."""
    cells = _cells(line, found.separator, found.width)
    return len(cells) == found.width and not _are_spoilt(cells)


def _is_remark(line: str, found: Structure) -> bool:
    """Whether a line is a comment that holds neither names nor units: no header ends with it."""
    other = len(_cells(line, found.separator, found.width)) != found.width
    return other and comment_of(line) is not None


def _neither(line: int, found: Structure, file: str) -> InputProblem:
    return InputProblem(
        f"neither names nor values like those below it (row {found.start}); say which line"
        " holds the names, --text header=LINE, or --text header=none, and mend or remove this",
        file=file,
        row=line,
    )


def _refuse_values(cells: Sequence[str], line: int, found: Structure, file: str) -> None:
    """A line of values above the samples that is not like them is not left out in silence."""
    values = sum(kind_of(cell) in (NUMBER, STAMP) for cell in cells)
    if line == found.start - 1 and values >= 2 and len(cells) >= found.shortest:
        raise _neither(line, found, file)


def _units_line(lines: Sequence[str], above: Sequence[int], found: Structure) -> int:
    """The line directly above the samples, if it holds units and names are above it."""
    if len(above) < 2:
        return 0
    units = _units_in(lines[above[0] - 1], found, every=False)
    names = _cells(lines[above[1] - 1], found.separator, found.width)
    if abs(len(units) - len(names)) > 1 or not _are_names(names):
        return 0
    dashes = set(units) == {"1"}  # in all columns: a sample without values, for times have a unit
    return above[0] if any(units) and not dashes else 0


def _units_above(
    lines: Sequence[str],
    above: Sequence[int],
    below: int,
    found: Structure,
    options: TextOptions,
    file: str,
) -> int:
    """A line above the names that holds units, and as many as there are columns.

    below : the line of units directly above the samples, 0 for none
    Raises InputProblem if several lines do, and not with the same units.
    """
    named = options.header or next((n for n in above if n != below), 0)
    rows = {n: _units_in(lines[n - 1], found) for n in above if n not in (named, below)}
    rows = {n: units for n, units in rows.items() if set(units) - _NO_UNIT}
    if below:
        rows = {below: _units_in(lines[below - 1], found, every=False), **rows}
    if len({tuple(units) for units in rows.values()}) > 1:
        first, second = list(rows)[:2]
        raise InputProblem(
            f"other units than in row {first}; say which hold: --text units={first} or --text"
            f" units={second}",
            file=file,
            row=second,
        )
    return next(iter(rows), 0)


def _units_in(line: str, found: Structure, *, every: bool = True) -> list[str | None]:
    """The units of a line, one a column; none if it holds anything else for the most part."""
    cells = _cells(line, found.separator, found.width)
    units = [unit_spelt(cell) for cell in cells]
    if every and len(units) != found.width:
        return []
    # One that nobody knows does not make names of the others; it will be refused as a unit.
    filled = [unit for cell, unit in zip(cells, units, strict=True) if cell]
    return units if sum(unit is not None for unit in filled) > 0.6 * len(filled) else []


def _fitted(names: list[str], found: Structure, line: int, file: str) -> list[str]:
    """The names, as many as there are columns.

    More names than cells are columns that are mostly absent; they must be texts at the end.
    """
    while len(names) > found.width and not names[-1]:
        names = names[:-1]
    if len(names) < found.width:
        spare = found.kinds[len(names) :]
        if len(names) >= 2 and not any(spare):  # separators at the end of every row
            return [*names, *[""] * len(spare)]
        raise InputProblem(
            f"{counted(len(names), 'name')} in the header, but {counted(found.width, 'cell')} in"
            " the samples below"
            f" (row {found.start}){_commas(names, found)}; say which line holds the names, e.g."
            f" --text header={line}, or --text header=none to number the columns",
            file=file,
            row=line,
        )
    return names


def _commas(names: Sequence[str], found: Structure) -> str:
    if found.separator == "," and found.width > len(names) + 1:
        return "; if numbers have decimal commas, they need another separator or quotes"
    return ""


def _by_name(names: Sequence[str], units: Sequence[str]) -> dict[str, str]:
    pairs = zip(names, units, strict=False)
    found = {name: cell if unit_spelt(cell) is None else unit_spelt(cell) for name, cell in pairs}
    return {name: unit for name, unit in found.items() if unit}


def _numbered(width: int) -> tuple[str, ...]:
    return tuple(NUMBERED.format(i + 1) for i in range(width))
