"""Samples of a text file as columns, parsed by pyarrow once the lines are all alike."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.memory import check_threads
from erdctl.core.messages import counted
from erdctl.io.csv_out import as_csv_text
from erdctl.io.text.cells import COMMENT, NUMBER, between_thousands, cells_of, whole_lines
from erdctl.io.text.encoding import UTF8, decoded
from erdctl.io.text.labview import END
from erdctl.io.text.layout import STEPS, Data, TextLayout
from erdctl.io.text.regular import regular
from erdctl.io.text.rows import explained, row_of, samples_of
from erdctl.io.text.stamps import NoStamp, Read, combined, nanoseconds

BLOCK = 4 << 20
_TAIL = 1 << 16  # bytes at the end, where a table may leave empty rows
_FAILURES = (pa.ArrowException, UnicodeDecodeError, UnicodeEncodeError)


class _Unlike(Exception):
    """Cells that are no numbers of the dialect."""


def read_text(
    data: Data,
    layout: TextLayout,
    file: str,
    columns: Sequence[str],
    numbers: Collection[str],
) -> tuple[pa.Table, list[str]]:
    """Chosen columns, `numbers` and times as float64, others as text; what was assumed of times.

    Raises InputProblem with the rows of cells that do not fit.
    """
    notes: list[str] = []
    names = layout.header.names
    stamps = [c for c in columns if c in numbers and c in layout.forms]
    raw = list(dict.fromkeys([c for c in (*columns, *(layout.dates.get(c, "") for c in stamps))
                              if c in names]))  # fmt: skip
    made = _made(layout)
    plain = [c for c in raw if c in numbers and c not in stamps and c != made]
    try:
        table = _parsed(_lines(data, layout, file, notes), layout, raw, plain)
        for name in plain:
            if table.schema.field(name).type != pa.float64():
                table = _set(table, name, _numbers(table.column(name), layout))
    except MemoryError:
        raise
    except (*_FAILURES, _Unlike) as error:
        check_threads(error, file)
        raise explained(data, layout, file, columns, numbers, error) from None
    if not table.num_rows and raw:
        raise InputProblem("a header but no samples", file=file)
    read: dict[str, Any] = {}
    for name in columns:
        if name in stamps:
            read[name] = _seconds(table, name, data, layout, file, notes)
        elif name == made:
            rows = table.num_rows or sum(1 for _ in samples_of(data, layout))
            read[name] = _steps(rows, layout, file, notes)
        else:
            read[name] = table.column(name) if name in plain else _texts(table, name, layout)
    texts = [name for name in columns if name not in numbers]
    return as_csv_text(pa.table(read), texts), notes


def _made(layout: TextLayout) -> str | None:
    """The column of times that are not written."""
    if layout.labview is not None and not layout.labview.written:
        return "X_Value"
    return STEPS if STEPS not in layout.header.names and STEPS in layout.columns else None


def _lines(data: Data, layout: TextLayout, file: str, notes: list[str]) -> bytes:
    """The samples as lines of UTF-8 that are all alike."""
    if isinstance(data, str):
        with open(data, "rb") as stream:
            body = stream.read()
    else:
        body = bytes(data)
    body = body[layout.mark :]
    if layout.encoding != UTF8:
        body = decoded(body, layout.encoding, file).encode()
    if b"\r" in body:
        body = body.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    offset = 0
    for _ in range(layout.start - 1):
        offset = body.index(b"\n", offset) + 1
    body = body[offset:]
    separator = layout.dialect.separator
    if layout.labview is not None:
        body = _one_segment(body, layout, file)
    body = _ended(body, separator, notes)
    if layout.comment is not None:
        body = re.sub(rb"(?m)^" + COMMENT.encode() + rb"[^\n]*(?:\n|\Z)", b"", body)
    if b'"' in body and (separator == " " or layout.ragged or re.search(rb'[ \t]"|"[ \t]', body)):
        return _rewritten(body, layout)
    if b"\n " in body or b"\n\t" in body:
        body = re.sub(rb"(?m)^[ ]+\n" if separator == "\t" else rb"(?m)^[ \t]+\n", b"", body)
    if separator == " ":
        body = re.sub(rb"(?m)^[ \t]+|[ \t]+$", b"", body)
        body = re.sub(rb"[ \t]+", b"\t", body)
    return _padded(body, layout) if layout.ragged else body


def _ended(body: bytes, separator: str, notes: list[str]) -> bytes:
    """The samples without rows of nothing but separators at the end, which tables leave there."""
    sign, size = separator.encode(), _TAIL
    while not (kept := body[-size:].rstrip(b" \t\n" + sign)) and size < len(body):
        size *= 8
    line = body.find(b"\n", max(0, len(body) - size) + len(kept)) + 1
    rows = sum(sign in row for row in body[line:].split(b"\n")) if line else 0
    if rows:
        notes.append(f"{counted(rows, 'empty row')} at the end left out")
        return body[:line]
    return body


def _padded(body: bytes, layout: TextLayout) -> bytes:
    """Rows that end before their last cells, which are texts, with these cells empty."""
    sign, most = _between(layout).encode(), len(layout.header.names) - 1
    least = layout.shortest - 1
    lines = body.split(b"\n")
    for i, line in enumerate(lines):
        signs = line.count(sign)
        if line and least <= signs < most:
            lines[i] = line + sign * (most - signs)
    return b"\n".join(lines)


def _between(layout: TextLayout) -> str:
    return "\t" if layout.dialect.separator == " " else layout.dialect.separator


def _rewritten(body: bytes, layout: TextLayout) -> bytes:
    """The same by plain Python: quotes may hold anything."""
    import csv
    import io

    out = io.StringIO()
    writer = csv.writer(out, delimiter=_between(layout), lineterminator="\n")
    width = len(layout.header.names)
    for _, line in whole_lines(body.decode(errors="surrogateescape").split("\n")):
        cells = cells_of(line, layout.dialect.separator)
        if cells:
            short = layout.shortest <= len(cells) < width
            writer.writerow(cells + [""] * (width - len(cells)) if short else cells)
    return out.getvalue().encode(errors="surrogateescape")


def _one_segment(body: bytes, layout: TextLayout, file: str) -> bytes:
    """The samples of all segments of a LabVIEW file; the blocks between them left out."""
    end = re.escape(END.encode())
    block = re.compile(
        rb"^Channels\b.*?^" + end + rb"[^\n]*\n+([^\n]*)\n", re.DOTALL | re.MULTILINE
    )
    sign = layout.dialect.separator
    for found in block.finditer(body):
        names = cells_of(found[1].decode(errors="replace"), sign)
        if [n for n in names if n] != [n for n in layout.header.names if n in names]:
            raise InputProblem(
                f"a later segment has other columns ({', '.join(names[:8])}); split the file",
                file=file,
            )
        if layout.labview is not None and not layout.labview.written:
            raise InputProblem("several segments without a time column; split the file", file=file)
    return block.sub(b"", body)


def _parsed(
    body: bytes, layout: TextLayout, columns: Sequence[str], numbers: Collection[str]
) -> pa.Table:
    import pyarrow.csv as pc

    direct = not layout.dialect.thousands
    if len(body) < _TAIL and not body.strip():
        return pa.table({name: pa.array([], pa.string()) for name in columns})
    return pc.read_csv(
        pa.py_buffer(body),
        read_options=pc.ReadOptions(block_size=BLOCK, column_names=list(layout.header.names)),
        parse_options=pc.ParseOptions(delimiter=_between(layout), newlines_in_values=b'"' in body),
        convert_options=pc.ConvertOptions(
            column_types={
                c: pa.float64() if direct and c in numbers else pa.string() for c in columns
            },
            include_columns=list(columns),
            null_values=[""],
            strings_can_be_null=False,
            decimal_point=layout.dialect.decimal,
        ),
    )


def _numbers(column: pa.ChunkedArray, layout: TextLayout) -> pa.ChunkedArray:
    """Texts with separated thousands as float64; empty cells null."""
    import pyarrow.compute as pc

    dialect = layout.dialect
    cells = pc.utf8_trim_whitespace(column)
    empty = pc.equal(cells, "")
    fits = pc.or_(empty, pc.match_substring_regex(cells, dialect.number.pattern))
    if not pc.all(fits).as_py():
        raise _Unlike("not all cells are numbers")
    cells = pc.replace_substring_regex(cells, between_thousands(dialect.thousands), "")
    cells = pc.replace_substring(cells, dialect.decimal, ".")
    return pc.if_else(empty, None, cells).cast(pa.float64())


def _texts(table: pa.Table, name: str, layout: TextLayout) -> pa.ChunkedArray:
    """A column that nobody computes with; numbers of it written as CSV writes them."""
    import pyarrow.compute as pc

    cells = pc.utf8_trim_whitespace(table.column(name))
    kind = layout.kinds[layout.header.names.index(name)]
    dialect = layout.dialect
    if kind != NUMBER or (dialect.decimal == "." and not dialect.thousands):
        return cells
    fits = pc.or_(pc.equal(cells, ""), pc.match_substring_regex(cells, dialect.number.pattern))
    if not pc.all(fits).as_py():
        return cells
    if dialect.thousands:
        cells = pc.replace_substring_regex(cells, between_thousands(dialect.thousands), "")
    return pc.replace_substring(cells, dialect.decimal, ".")


def _seconds(
    table: pa.Table, name: str, data: Data, layout: TextLayout, file: str, notes: list[str]
) -> Any:
    import pyarrow.compute as pc

    def read(column: str) -> Read:
        cells = pc.utf8_trim_whitespace(table.column(column))
        try:
            return nanoseconds(cells, layout.forms[column], layout.options.date)
        except NoStamp as error:
            row = None if error.sample is None else row_of(data, layout, error.sample)
            raise InputProblem(str(error), file=file, row=row, column=column) from None

    time = read(name)
    beside = layout.dates.get(name)
    if beside is not None:
        time = combined(read(beside), time)
    if time.resolution >= 10**9 and "yyyy" in time.form and not (time.ns % (86_400 * 10**9)).any():
        raise InputProblem(
            "dates without a time of day; map the column of times", file=file, column=name
        )
    seconds, said = regular(time, layout, file, name)
    called = f"'{beside}' and '{name}'" if beside else f"'{name}'"
    notes.append(f"{called} ({time.form}) as seconds from the first sample")
    notes.extend((*time.notes, *said))
    return pa.array(seconds)


def _steps(rows: int, layout: TextLayout, file: str, notes: list[str]) -> Any:
    """Times of samples whose times are not written."""
    found = layout.labview
    step = layout.options.interval
    begin = 0.0
    if step is None and found is not None and found.time:
        step, begin = found.step, found.begin or 0.0
    if step is None or step <= 0.0:
        raise InputProblem(
            "no times are written, and no step between them; give it: --text interval=SECONDS",
            file=file,
        )
    notes.append(f"times made of the interval {step:g} s")
    return pa.array(begin + np.arange(rows) * step)


def _set(table: pa.Table, name: str, column: pa.ChunkedArray) -> pa.Table:
    return table.set_column(table.column_names.index(name), name, column)
