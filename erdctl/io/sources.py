"""Tables that come in, from files and streams of any format, with their hash."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import pyarrow as pa

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.memory import check_threads, while_reading
from erdctl.io.formats import CONTAINERS, Format, by_content
from erdctl.io.stored import units_of
from erdctl.io.urls import fetch, is_url

if TYPE_CHECKING:
    from erdctl.io.containers.isolated import Container
    from erdctl.io.roles import Roles
    from erdctl.io.text.layout import TextLayout
    from erdctl.io.text.options import TextOptions

Data = str | bytearray  # the path of a file, or the bytes of a stream
T = TypeVar("T")

STDIN = "-"
_CHUNK = 1 << 24


@dataclass(frozen=True)
class TableSource:
    """A table that can be read.

    path : as given;  name : for messages;  data : the path of a file, or the bytes of a stream
    schema : None for CSV and containers;  layout : of a container (MAT, MDF4, TDMS), else None
    text : how a text file is written, None for plain CSV
    units : as the file states them for columns, apart from those in names like `x [mm]`
    rows : as the file states them, None if it does not
    """

    path: str
    name: str
    format: Format
    data: Data
    columns: tuple[str, ...]
    schema: pa.Schema | None = None
    units: Mapping[str, str] = field(default_factory=dict)
    layout: Container | None = None
    text: TextLayout | None = None
    rows: int | None = None

    @property
    def clocks(self) -> Collection[str]:
        """Names in the file that column `t` was made of."""
        return () if self.layout is None else self.layout.clocks

    def row_of(self, sample: int, samples: int) -> int:
        """Row of a sample (counted from 0) as InputProblem states rows; samples : how many."""
        if self.text is not None and not self.text.ordinary:
            from erdctl.io.text import rows

            return rows.row_of(self.data, self.text, sample)
        if self.format is Format.CSV:
            from erdctl.io import csv_in

            return csv_in.row_of(self.data, self.name, sample, samples)
        return sample + 1

    @property
    def remarks(self) -> Collection[str]:
        """What to say of the file before it is read."""
        if self.format is Format.CSV:
            from erdctl.io.text.cut_off import cut_off

            return cut_off(self.data, self.text)
        return () if self.layout is None else self.layout.notes

    @property
    def size(self) -> int:
        """Number of bytes."""
        return os.path.getsize(self.data) if isinstance(self.data, str) else len(self.data)


def open_source(
    path: str,
    held: Data | None = None,
    *,
    text: TextOptions | None = None,
    assumed: TextOptions | None = None,
    whole: bool = True,
) -> TableSource:
    """Look at a file, or take all of standard input for `-`; samples are not read yet.

    held : the bytes of the file where they are in memory; `path` is then only what it is called
    text : what is given of how a text file is written
    assumed : the same where it is not written as the contract has it
    whole : whether it will be read at once
    Raises UsageProblem if it cannot be opened, InputProblem if it is no table, ComputationProblem
    if memory does not suffice.
    """
    name = "stdin" if path == STDIN else path
    with while_reading(name):  # what a format needs is imported here as well
        return _opened(path, name, _data(path) if held is None else held, text, assumed, whole)


def _opened(
    path: str,
    name: str,
    data: Data,
    text: TextOptions | None,
    assumed: TextOptions | None,
    whole: bool,
) -> TableSource:
    if isinstance(data, str):
        with open(data, "rb") as file:
            head = file.read(64)
    else:
        head = bytes(data[:64])
    found = by_content(head, path, name)
    schema, rows, units, written, line = None, None, dict[str, str](), None, 0
    if found in CONTAINERS:
        from erdctl.io.containers.isolated import open_isolated

        layout = open_isolated(data, found, name)
        return TableSource(
            path, name, found, data, layout.columns, units=layout.units, layout=layout
        )
    if found is Format.CSV:
        from erdctl.io import csv_in
        from erdctl.io.plain import is_plain

        plain = text is None and is_plain(data)
        written = None if plain else _recognised(data, name, text or assumed)
        if written is not None:
            columns, units, line = list(written.columns), written.units, written.header.line
        else:
            line, columns = csv_in.header_of(data, name)
    else:
        schema, columns, units, rows = guarded(
            name, found, lambda: _described(data, found, name, whole)
        )
    if not columns:
        raise InputProblem("a table without columns; expected a bench log", file=name)
    for i, column in enumerate(columns):
        if column in columns[:i]:
            raise InputProblem(
                f"columns {columns.index(column) + 1} and {i + 1} are both called '{column}';"
                " rename one",
                file=name,
                row=line or None,
            )
    return TableSource(
        path, name, found, data, tuple(columns), schema, units, text=written, rows=rows
    )


def _recognised(data: Data, name: str, options: TextOptions | None) -> TextLayout | None:
    """How a text is written; None for plain CSV, which is read faster and explained better."""
    from erdctl.io.text.layout import recognise
    from erdctl.io.text.options import TextOptions

    found = recognise(data, name, options or TextOptions())
    return None if found is None or (found.ordinary and not found.forms) else found


def read_source(
    source: TableSource,
    columns: Sequence[str] | None = None,
    *,
    numbers: Collection[str] = (),
    labels: Collection[str] = (),
    roles: Roles | None = None,
    want_hash: bool = False,
) -> tuple[pa.Table, str]:
    """The columns (all: None), and the SHA-256 of all bytes in hex ("" unless wanted).

    numbers : columns that are float64 if the table is CSV, which knows no types; its other
        columns stay text (see `csv_out`)
    labels : columns of few different texts, which come dictionary-encoded out of Parquet
    roles : what columns of a container are needed for, by which they share a time base
    Raises InputProblem if the content is damaged, ComputationProblem if memory does not suffice.
    """
    names = source.columns if columns is None else tuple(columns)

    def read() -> pa.Table:
        text = source.text
        if text is not None and not (text.ordinary and text.forms.keys().isdisjoint(numbers)):
            from erdctl.io.text.body import read_text

            table, notes = read_text(source.data, text, source.name, names, numbers)
            if roles is not None:
                for note in notes:
                    roles.say(note)
            return table
        if source.format is Format.CSV:
            from erdctl.io import csv_in

            return csv_in.read(source.data, source.name, source.columns, names, numbers)
        if source.format is Format.PARQUET:
            from erdctl.io import parquet_in

            file = native(source.data)
            assert source.schema is not None
            return parquet_in.read(file, source.size, source.schema, names, labels, source.name)
        if source.layout is not None:
            from erdctl.io.roles import Roles

            return source.layout.table(names, roles or Roles())
        from erdctl.io import arrow_in

        with native(source.data) as file:
            return arrow_in.read(file, source.size, source.columns, names, source.name)

    with while_reading(source.name):
        if not want_hash:
            return guarded(source.name, source.format, read), ""
        from concurrent.futures import ThreadPoolExecutor

        with ThreadPoolExecutor(1) as pool:
            # Next to the parsing, hashing takes hardly any time.
            digest = pool.submit(sha256_of, source.data)
            return guarded(source.name, source.format, read), digest.result()


def read_table(
    path: str, columns: Sequence[str] | None = None, *, numbers: Collection[str] = ()
) -> pa.Table:
    """A table whose columns are known beforehand; see `open_source` and `read_source`."""
    return read_source(open_source(path), columns, numbers=numbers)[0]


def _data(path: str) -> Data:
    if path == STDIN:
        if sys.stdin.isatty():
            raise UsageProblem(
                "'-' is standard input, which is the terminal here; pipe a log into it"
            )
        return _all_of(sys.stdin.buffer)
    if is_url(path):
        return fetch(path)
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise UsageProblem(f"'{path}' is a directory; name the files in it")
        with open(path, "rb") as file:
            # A pipe (`<(zcat log.csv.gz)`) can be read only once; and the readers of formats open
            # no name that is not UTF-8.
            return path if stat.S_ISREG(mode) and _is_text(path) else _all_of(file)
    except FileNotFoundError:
        raise UsageProblem(f"'{path}' does not exist") from None
    except OSError as error:
        raise UsageProblem(
            f"cannot read '{path}': {(error.strerror or str(error)).lower()}"
        ) from None


def _is_text(path: str) -> bool:
    try:
        path.encode()
    except UnicodeEncodeError:
        return False
    return True


def _all_of(stream: BinaryIO) -> bytearray:
    out = bytearray()
    while chunk := stream.read(_CHUNK):
        out += chunk
    return out


def sha256_of(data: Data) -> str:
    """SHA-256 of all bytes in hex."""
    import hashlib

    if not isinstance(data, str):
        return hashlib.sha256(data).hexdigest()
    with open(data, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def guarded(name: str, format: Format, read: Callable[[], T]) -> T:
    """What reading gives; InputProblem where the content is damaged."""
    try:
        return read()
    except MemoryError:
        raise
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        check_threads(error, name)
        reason = str(error).splitlines()[0][:200]
        raise InputProblem(
            f"damaged or cut off {format.value} ({reason}); write or copy it again", file=name
        ) from None


def native(data: Data) -> Any:
    """The file as pyarrow reads it."""
    # Not a memory map: if the file were cut while it is in use, the program would crash.
    return pa.OSFile(data) if isinstance(data, str) else pa.BufferReader(pa.py_buffer(data))


def _described(
    data: Data, format: Format, name: str, whole: bool
) -> tuple[pa.Schema, list[str], dict[str, str], int]:
    """Schema, columns, units that the file states for them, and how many rows it says it has."""
    if format is Format.PARQUET:
        from erdctl.io import parquet_in

        schema, rows = parquet_in.described(native(data))
    else:
        from erdctl.io import arrow_in

        with native(data) as file:
            schema, rows = arrow_in.described(file, name, held=whole)
    return schema, list(schema.names), units_of(schema), rows
