"""Lines of a text file one by one: which of them are samples, and what is wrong with them."""

from __future__ import annotations

import io
from collections.abc import Collection, Iterator, Sequence
from itertools import islice

import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.messages import counted
from erdctl.io.problems import Wrong, problem_of
from erdctl.io.text.cells import cells_of, comment_of, whole_lines
from erdctl.io.text.labview import END
from erdctl.io.text.layout import Data, TextLayout
from erdctl.io.text.numerals import otherwise
from erdctl.io.text.stamps import form_of, kind

BEYOND = 100_000  # rows that are looked through after the first error, for those of other columns


def samples_of(data: Data, layout: TextLayout) -> Iterator[tuple[int, list[str]]]:
    """Line and cells of every sample."""
    skipping = ends = False
    block = "Channels" + layout.dialect.separator
    with (
        pa.OSFile(data) if isinstance(data, str) else pa.BufferReader(pa.py_buffer(data)) as stream,
        io.TextIOWrapper(
            stream, encoding=layout.encoding, errors="surrogateescape", newline=None
        ) as text,
    ):
        stream.seek(layout.mark)
        for number, line in whole_lines(line.rstrip("\n") for line in text):
            if number < layout.start or is_empty(line, layout):
                continue
            # A segment of a LabVIEW file has its own block, and the names again.
            begins = layout.labview is not None and line.startswith(block)
            if ends or skipping or begins:
                skipping, ends = not line.startswith(END) and not ends, line.startswith(END)
                continue
            yield number, cells_of(line, layout.dialect.separator)


def is_empty(line: str, layout: TextLayout) -> bool:
    """Whether a line holds nothing: blank, or a comment. Tabs alone are a row of empty cells."""
    blank = not line.strip(" ") if layout.dialect.separator == "\t" else not line.strip()
    return blank or (layout.comment is not None and comment_of(line) is not None)


def row_of(data: Data, layout: TextLayout, sample: int) -> int:
    """Line of a sample counted from 0."""
    lines = (line for line, _ in samples_of(data, layout))
    return next(islice(lines, sample, None), layout.start + sample)


def explained(
    data: Data,
    layout: TextLayout,
    file: str,
    columns: Sequence[str],
    numbers: Collection[str],
    reason: Exception,
) -> InputProblem:
    """The first thing wrong in every column, and the first row with a wrong number of cells."""
    names = layout.header.names
    number = layout.dialect.number
    wanted = [(j, name) for j, name in enumerate(names) if name in columns and name in numbers]
    found: dict[str, Wrong] = {}
    since = 0
    for line, cells in samples_of(data, layout):
        if found:
            since += 1
            if since > BEYOND or len(found) > len(wanted):
                break
        if not layout.shortest <= len(cells) <= len(names):
            found.setdefault("", _wrong_count(len(cells), layout, line))
            continue
        for j, name in wanted:
            if name in found or j >= len(cells):
                continue
            cell, form = cells[j], layout.forms.get(name)
            if form is not None and form_of(cell) == form:
                continue
            if form is None and (not cell or number.match(cell)):
                continue
            expected = (
                f"a number{otherwise(cell, layout.dialect)}" if form is None else f"a {kind(form)}"
            )
            said = f"found '{cell[:40]}', expected {expected}"
            found[name] = Wrong(said if cell else f"empty, expected {expected}", line, name)
    if found:
        return problem_of(sorted(found.values(), key=lambda w: w.row or 0), file)
    return InputProblem(f"cannot be read: {str(reason).splitlines()[0][:200]}", file=file)


def _wrong_count(count: int, layout: TextLayout, line: int) -> Wrong:
    names = layout.header.names
    least = f"{layout.shortest} to " if layout.ragged else ""
    source = (
        f"the header has {counted(len(names), 'column')}"
        if layout.header.line
        else "others have more"
    )
    return Wrong(
        f"{counted(count, 'cell')} where {source} ({least}{len(names)} expected); the last row may"
        " have been"
        " cut off",
        line,
    )
