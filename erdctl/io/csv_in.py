"""CSV logs: read fast, and when that fails found out where and why."""

from __future__ import annotations

import csv
import io
import mmap
import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager

import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.memory import check_threads
from erdctl.core.messages import counted
from erdctl.io.csv_out import as_csv_text
from erdctl.io.plain import NUMBER
from erdctl.io.problems import Wrong, problem_of

# The path of a file, or the bytes of a stream.
Data = str | bytearray

SUSPECT = 16 << 20  # bytes looked through cell by cell to explain a failure
MOST_SUSPECT = 8 * SUSPECT  # a cell this long is a quote left open
BEYOND = 20_000  # rows looked through after the first error, for those of other columns
BLOCK = 4 << 20  # bytes parsed at a time: 0.9 s for 10 million rows, 1.5 s with pyarrow's 1 MB

_FAILURES = (pa.ArrowException, UnicodeDecodeError)

# How bytes that are no UTF-8 show with errors="surrogateescape".
_NOT_UTF8 = re.compile("[\udc80-\udcff]")
_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "spaces"}


def header_of(data: Data, file: str) -> tuple[int, list[str]]:
    """Line of the header row, and the names in it.

    Raises InputProblem if there is none, if it is not UTF-8, or not separated by commas.
    """
    rows = _rows(data, file)
    line, names = next(rows, (1, []))
    if not names:
        raise InputProblem("empty; expected a header row and samples", file=file)
    _check_text(names, line, file)
    if len(names) == 1:
        below = next(rows, (0, names))[1]
        if len(below) > 1:
            raise InputProblem(
                f"one cell where {len(below)} follow; remove what stands before the header",
                file=file,
                row=line,
            )
        for separator, called in _SEPARATORS.items():
            if separator in names[0]:
                raise InputProblem(
                    f"the header is separated by {called}, expected commas; export it as"
                    " comma-separated, with a point as decimal sign",
                    file=file,
                    row=line,
                )
    return line, names


def read(
    data: Data, file: str, names: Sequence[str], columns: Sequence[str], numbers: Collection[str]
) -> pa.Table:
    """Chosen columns: `numbers` as float64 (empty cells null), the others as their text.

    names : all columns of the file
    Raises InputProblem with the line of the first cell or row that cannot be read.
    """
    # Only quoted cells can hold line ends, and looking for quotes costs less than parsing with
    # line ends allowed (0.03 s against 0.5 s for 10 million rows).
    quoted = _contains(data, b'"')
    try:
        table = _parsed(data, columns, numbers, quoted=quoted)
    except MemoryError:
        raise
    except _FAILURES as error:
        check_threads(error, file)
        start, line = _first_bad_block(data, names, columns, numbers)
        rows = _rows(data, file, start, line)
        raise _explained(rows, file, names, columns, numbers, error, first=start == 0) from None
    return as_csv_text(table, [c for c in columns if c not in numbers])


def _parsed(
    data: Data | bytes,
    columns: Sequence[str],
    numbers: Collection[str],
    *,
    quoted: bool,
    names: Sequence[str] | None = None,
) -> pa.Table:
    import pyarrow.csv as pc

    return pc.read_csv(
        data if isinstance(data, str) else pa.py_buffer(data),
        read_options=pc.ReadOptions(block_size=BLOCK, column_names=names),
        parse_options=pc.ParseOptions(newlines_in_values=quoted),
        convert_options=pc.ConvertOptions(
            column_types={c: pa.float64() if c in numbers else pa.string() for c in columns},
            include_columns=list(columns),
            null_values=[""],
            strings_can_be_null=False,
        ),
    )


def _first_bad_block(
    data: Data, names: Sequence[str], columns: Sequence[str], numbers: Collection[str]
) -> tuple[int, int]:
    """Offset and line of the first part of a file that cannot be read.

    Plain Python finds the very cell, but takes half a minute for 10 million rows.
    """
    begin, line = 0, 1
    with _searchable(data) as content:
        while begin < len(content):
            end, quotes = begin, 0
            # An odd number of quotes: the part ends inside a cell.
            while end < len(content) and (end == begin or quotes % 2):
                if end - begin > MOST_SUSPECT:
                    return begin, line
                more = content.find(b"\n", end + SUSPECT) + 1 or len(content)
                quotes += bytes(content[end:more]).count(b'"')
                end = more
            part = bytes(content[begin:end])
            try:
                _parsed(part, columns, numbers, quoted=True, names=names if begin else None)
            except _FAILURES:
                return begin, line
            line += part.count(b"\n")
            begin = end
    return 0, 1


def row_of(data: Data, file: str, sample: int, samples: int) -> int:
    """Line in the file (header = line 1) of a sample counted from 0.

    Blank lines and line ends inside quotes make it more than sample + 2.
    samples : number of samples in the file
    """
    if _count_lines(data) == samples + 1:
        return sample + 2
    rows = _rows(data, file)
    next(rows)
    for count, (line, _) in enumerate(rows):
        if count == sample:
            return line
    return sample + 2


def _count_lines(data: Data) -> int:
    with _searchable(data) as content:
        size = len(content)
        ends = sum(bytes(content[i : i + SUSPECT]).count(b"\n") for i in range(0, size, SUSPECT))
        return ends + (bytes(content[-1:]) != b"\n")


def _explained(
    rows: Iterator[tuple[int, list[str]]],
    file: str,
    names: Sequence[str],
    columns: Sequence[str],
    numbers: Collection[str],
    error: Exception,
    *,
    first: bool,
) -> InputProblem:
    """The first thing wrong in every column; first : the rows begin with the header."""
    header = next(rows)[0] if first else 0
    checked = [(i, n) for i, n in enumerate(names) if n in columns]
    found: dict[str, Wrong] = {}
    since = 0
    empty = True
    try:
        for line, cells in rows:
            empty = False
            since += bool(found)
            if since > BEYOND:
                break
            if len(cells) != len(names):
                found.setdefault("", Wrong(_count(cells, names), line))
                continue
            for i, name in checked:
                if name in numbers and name not in found and not NUMBER.fullmatch(cells[i]):
                    hint = _hint(cells[i], first=line == header + 1)
                    said = f"found '{cells[i][:40]}', expected a number{hint}"
                    found[name] = Wrong(said, line, name)
                if not found:
                    _check_text(cells[i : i + 1], line, file)
    except InputProblem as problem:  # the rows cannot be followed from here on
        if not found:
            return problem
    if found:
        return problem_of(list(found.values()), file)
    if empty:
        return InputProblem("a header but no samples", file=file)
    return InputProblem(f"not a CSV log: {error}", file=file)


def _count(cells: Sequence[str], names: Sequence[str]) -> str:
    return (
        f"{counted(len(cells), 'cell')} where the header has {counted(len(names), 'column')}; a"
        " cell that holds a comma"
        " must be quoted, and the last row may have been cut off"
    )


def _hint(cell: str, *, first: bool) -> str:
    from erdctl.io.text.cells import Dialect
    from erdctl.io.text.numerals import otherwise

    if said := otherwise(cell.strip(), Dialect()):
        return said
    if first and re.search(r"[^\W\d]", cell):
        return "; delete the row if it holds units or comments"
    return ""


def _check_text(cells: Sequence[str], line: int, file: str) -> None:
    for cell in cells:
        bad = _NOT_UTF8.search(cell)
        if bad:
            raise InputProblem(
                f"not UTF-8: byte 0x{ord(bad[0]) - 0xDC00:02x} near '{cell[: bad.start()][-20:]}';"
                " convert it first, e.g. iconv -f latin1 -t utf-8 log.csv > new.csv",
                file=file,
                row=line,
            )


def _rows(data: Data, file: str, start: int = 0, line: int = 1) -> Iterator[tuple[int, list[str]]]:
    """Rows that are not blank, each with its line; from an offset that begins the given line."""
    with (
        pa.OSFile(data) if isinstance(data, str) else pa.BufferReader(pa.py_buffer(data)) as stream,
        io.TextIOWrapper(
            stream, encoding="utf-8-sig", errors="surrogateescape", newline=""
        ) as text,
    ):
        stream.seek(start)
        reader = csv.reader(text)
        before = line
        try:
            for cells in reader:
                if cells:
                    yield line, cells
                line = before + reader.line_num
        except csv.Error as error:
            raise InputProblem(
                f"not a CSV row: {error}; a quote may be left open", file=file, row=line
            ) from None


def _contains(data: Data, pattern: bytes) -> bool:
    with _searchable(data) as content:
        return content.find(pattern) >= 0


@contextmanager
def _searchable(data: Data) -> Iterator[mmap.mmap | bytearray]:
    if not isinstance(data, str):
        yield data
        return
    with open(data, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        yield content
