"""How a text file is written, recognised from its beginning, and in one line for the user."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from erdctl.core.errors import InputProblem
from erdctl.io.text.cells import (
    EMPTY,
    NUMBER,
    STAMP,
    Dialect,
    cells_of,
    comment_of,
    kind_of,
    unbroken,
    whole_lines,
)
from erdctl.io.text.encoding import CALLED, LINE_END, UTF8, decoded, encoding_of
from erdctl.io.text.interval import stated_interval
from erdctl.io.text.labview import LabView, labview_of
from erdctl.io.text.names import Header, header_of
from erdctl.io.text.numerals import evidence_of, settle
from erdctl.io.text.options import TextOptions
from erdctl.io.text.stamps import CLOCK, form_of, has_time
from erdctl.io.text.structure import Structure, refuse_none, structure_of
from erdctl.io.units import RECORD

Data = str | bytearray

HEAD = 1 << 18  # bytes that the recognition looks at
STEPS = "t"  # what the time is called where the file has none
_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars", " ": "blanks"}
_EXCEL = re.compile(r'"?sep=(.)"?[,;|\s]*', re.IGNORECASE)


@dataclass(frozen=True)
class TextLayout:
    """How a text file is written.

    columns : names;  kinds : of each, NUMBER, STAMP, TEXT or EMPTY;  width : cells of a whole row
    shortest : cells that no row may lack;  start : line of the first sample
    forms : column -> form of its stamps;  dates : column of times of day -> that of their dates
    interval : between samples as the file's own header states it [s]
    """

    encoding: str
    mark: int
    dialect: Dialect
    header: Header
    kinds: tuple[str, ...]
    shortest: int
    start: int
    comment: str | None = None
    labview: LabView | None = None
    options: TextOptions = field(default_factory=TextOptions)
    forms: dict[str, str] = field(default_factory=dict)
    dates: dict[str, str] = field(default_factory=dict)
    interval: float | None = None

    @property
    def columns(self) -> tuple[str, ...]:
        """Names, with a time made of the interval where that was asked for."""
        made = self.options.interval is not None and not self.forms
        own = self.header.names
        return (STEPS, *own) if made and STEPS not in own else own

    @property
    def units(self) -> dict[str, str]:
        """What the file says of units apart from names; stamps come in seconds."""
        return self.header.units | dict.fromkeys(self.forms, "s")

    @property
    def ragged(self) -> bool:
        """Whether rows may end before their last cells."""
        return self.shortest < len(self.header.names)

    @cached_property
    def ordinary(self) -> bool:
        """Whether it is what the contract calls CSV."""
        return (
            self.encoding == UTF8 and self.dialect == Dialect() and not self.header.units
            and self.header.verbatim and self.header.units_line == 0 and not self.ragged
            and self.comment is None and self.labview is None and self.options == TextOptions()
            and self.start > self.header.line and not self.above
        )  # fmt: skip

    @property
    def above(self) -> bool:
        """Whether the header row is below other lines."""
        return self.header.line > 1

    @property
    def read_as(self) -> str:
        """What was assumed."""
        dialect = self.dialect
        said = [CALLED.get(self.encoding, self.encoding), _SEPARATORS.get(dialect.separator, "")]
        said[1] = said[1] or f"separator '{dialect.separator}'"
        if dialect.decimal == ",":
            said.append("decimal comma")
        if dialect.thousands:
            called = {".": "points", ",": "commas", " ": "blanks", "'": "apostrophes"}
            said.append(f"{called.get(dialect.thousands, dialect.thousands)} between thousands")
        if self.labview is not None:
            said.append("LabVIEW measurement")
        said.append(f"header in line {self.header.line}" if self.header.line else "no header row")
        if self.header.units_line:
            said.append(f"units in line {self.header.units_line}")
        if self.comment:
            said.append(f"lines with {self.comment} left out")
        if self.ragged:
            absent = self.header.names[self.shortest :]
            said.append(f"{', '.join(repr(n) for n in absent)} absent in some rows")
        return ", ".join(said)


def recognise(data: Data, file: str, options: TextOptions) -> TextLayout | None:
    """How a text file is written; None if it is a plain CSV log, or nothing better is known.

    Raises InputProblem where it may be read in two ways, with the option that decides.
    """
    head, whole = _head(data)
    encoding, mark = encoding_of(head, file, whole=whole, given=options.encoding is not None)
    encoding = options.encoding or encoding
    lines = LINE_END.split(decoded(head[mark:], encoding, file, whole=whole))
    if not whole and len(lines) > 1:
        lines = lines[:-1]  # cut
    lines = unbroken(lines)
    first = next((n for n, line in enumerate(lines, 1) if line.strip()), 1)
    excel = _EXCEL.fullmatch(lines[first - 1])
    above = first if excel else 0
    separator = options.separator or (excel[1] if excel else None)
    labview = labview_of(lines, file)
    after = labview.header_line - 1 if labview else above
    if labview is not None:
        separator = options.separator or labview.separator
        options = replace(options, decimal=options.decimal or labview.decimal)
        options = replace(options, header=options.header or labview.header_line)
    after = max(after, options.header or 0, options.units or 0)
    found = structure_of(lines, after, separator, file)
    if found is None:
        if encoding == UTF8 and options == TextOptions() and "," in lines[first - 1]:
            return None
        raise refuse_none(lines, file)
    try:
        header = header_of(lines, above, found, options, file)
    except InputProblem:
        plain = found.separator == "," and encoding == UTF8 and options == TextOptions()
        plain = plain and found.start == first + 1
        if plain and len(cells_of(lines[first - 1], ",")) > 1 and not comment_of(lines[first - 1]):
            return None
        raise
    kinds = _kinds(found, header)
    dialect = _dialect(data, encoding, mark, found, kinds, options, file)
    forms = _forms(found, header.names, kinds)
    if labview is not None:
        header = replace(header, units=header.units | labview.units(header.names))
    return TextLayout(
        encoding, mark, dialect, header, kinds, _shortest(found, header, kinds), found.start,
        found.comment, labview, options, forms, _dates(found, header.names, forms),
        stated_interval(lines[: found.start - 1], dialect.decimal),
    )  # fmt: skip


def _head(data: Data) -> tuple[bytes, bool]:
    if isinstance(data, str):
        with open(data, "rb") as file:
            head = file.read(HEAD + 1)
    else:
        head = bytes(data[: HEAD + 1])
    return head[:HEAD], len(head) <= HEAD


def _kinds(found: Structure, header: Header) -> tuple[str, ...]:
    return (*found.kinds, *[EMPTY] * (len(header.names) - found.width))


def _shortest(found: Structure, header: Header, kinds: Sequence[str]) -> int:
    """Cells that every row must have: up to the last that holds values."""
    last = max(j for j, kind in enumerate(kinds) if kind in (NUMBER, STAMP)) + 1
    if found.shortest >= len(header.names):
        return len(header.names)
    return max(last, min(found.shortest, len(header.names)))


def _forms(found: Structure, names: Sequence[str], kinds: Sequence[str]) -> dict[str, str]:
    """Form of the stamps of every column of them."""
    out: dict[str, str] = {}
    for j, (name, kind) in enumerate(zip(names, kinds, strict=True)):
        if kind == STAMP and name != RECORD:
            cells = [row.cells[j] for row in found.samples if j < len(row.cells)]
            out[name] = next(form for form in map(form_of, cells) if form is not None)
    return out


def _dates(found: Structure, names: Sequence[str], forms: dict[str, str]) -> dict[str, str]:
    """Times of day that have their date in a column of its own beside them."""
    out: dict[str, str] = {}
    for name, form in forms.items():
        j = list(names).index(name)
        for beside in (j - 1, j + 1):
            other = names[beside] if 0 <= beside < len(names) else ""
            if form == CLOCK and forms.get(other) not in (None, CLOCK):
                cell = next((r.cells[beside] for r in found.samples if beside < len(r.cells)), "")
                if not has_time(forms[other], cell):
                    out.setdefault(name, other)
    return out


def _dialect(
    data: Data, encoding: str, mark: int, found: Structure, kinds: Sequence[str],
    options: TextOptions, file: str,
) -> Dialect:  # fmt: skip
    """Separator and signs of numbers; the whole file is asked where its beginning is silent."""

    def numbers(rows: Iterator[tuple[int, Sequence[str]]]) -> Iterator[tuple[str, int]]:
        for line, cells in rows:
            for cell, kind in zip(cells, kinds, strict=False):
                if kind == NUMBER and kind_of(cell) == NUMBER:
                    yield cell, line

    evidence = evidence_of(numbers((row.line, row.cells) for row in found.samples))
    asked = found.separator != "," or "," in evidence.either
    if not evidence.decimal and not options.decimal and asked:
        evidence = evidence_of(numbers(_rows(data, encoding, mark, found, file)))
    return Dialect(found.separator, *settle(evidence, found.separator, options, file))


def _rows(
    data: Data, encoding: str, mark: int, found: Structure, file: str
) -> Iterator[tuple[int, Sequence[str]]]:
    if isinstance(data, str):
        with open(data, "rb") as stream:
            content = stream.read()
    else:
        content = bytes(data)
    for number, line in whole_lines(LINE_END.split(decoded(content[mark:], encoding, file))):
        if number >= found.start and line.strip() and comment_of(line) is None:
            yield number, cells_of(line, found.separator)
