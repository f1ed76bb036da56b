"""The columns of a Parquet or Arrow file, some rows at a time."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Sequence

import pyarrow as pa

from erdctl.core.memory import while_reading
from erdctl.io.formats import Format, by_content
from erdctl.io.sources import STDIN, TableSource, guarded, native, open_source

STREAMS = (Format.PARQUET, Format.ARROW)
STREAMED = 1 << 21  # rows from which a log is read in stretches
SMALL = 1 << 20  # bytes; what so small a file holds is not worth a look before reading


def read_batches(
    source: TableSource, names: Sequence[str], labels: Collection[str] = ()
) -> Iterator[pa.Table]:
    """The columns `names`, a table of the next rows after the other.

    labels : columns of few different texts, which come dictionary-encoded out of Parquet
    Raises InputProblem if the content is damaged, ComputationProblem if memory does not suffice.
    """
    with native(source.data) as file:
        tables = _tables(source, file, names, labels)
        while True:
            with while_reading(source.name):
                table = guarded(source.name, source.format, lambda: next(tables, None))
            if table is None:
                return
            if table.num_rows:
                yield table


def _tables(
    source: TableSource, file: pa.NativeFile, names: Sequence[str], labels: Collection[str]
) -> Iterator[pa.Table]:
    if source.format is Format.PARQUET:
        from erdctl.io import parquet_in

        assert source.schema is not None
        return parquet_in.batches(file, source.size, source.schema, names, labels, source.name)
    from erdctl.io import arrow_in

    return arrow_in.batches(file, source.size, source.columns, names, source.name)


def in_portions(tables: Iterator[pa.Table], rows: int) -> Iterator[pa.Table]:
    """The same of at least so many rows each, but the last."""
    held: list[pa.Table] = []
    for table in tables:
        held.append(table)
        if sum(t.num_rows for t in held) >= rows:
            yield pa.concat_tables(held)
            held = []
    if held:
        yield pa.concat_tables(held)


class Incoming:
    """Tables that come one after the other, to be taken in other portions."""

    def __init__(self, tables: Iterator[pa.Table]) -> None:
        self._tables = tables
        self._held: list[pa.Table] = []
        self._rows = 0

    def next(self, rows: int) -> pa.Table:
        """So many rows from where it is, fewer at the end; they stay to be taken."""
        while self._rows < rows and (table := next(self._tables, None)) is not None:
            self._held.append(table)
            self._rows += table.num_rows
        whole = pa.concat_tables(self._held)
        self._held = [whole]
        return whole.slice(0, rows)

    def take(self, rows: int) -> None:
        """Go on behind so many rows."""
        whole = pa.concat_tables(self._held)
        self._rows = whole.num_rows - rows
        # Chunk by chunk, so that what is behind is let go.
        self._held = [whole.slice(rows)] if self._rows else []


def long_source(paths: Sequence[str]) -> TableSource | None:
    """The file, if it is so long that it is better read in stretches."""
    if len(paths) != 1 or paths[0] == STDIN or not os.path.isfile(paths[0]):
        return None
    if os.path.getsize(paths[0]) < SMALL or not _streams(paths[0]):
        return None
    source = open_source(paths[0], whole=False)
    long = source.rows is not None and source.rows >= STREAMED
    return source if long and isinstance(source.data, str) else None


def _streams(path: str) -> bool:
    """Whether the content is of a format that is read so."""
    try:
        with open(path, "rb") as file:
            head = file.read(64)
    except OSError:
        return False
    return by_content(head, path, path) in STREAMS
