"""The columns of a Parquet or Arrow file, some rows at a time."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import pyarrow as pa

from erdctl.core.errors import ComputationProblem
from erdctl.io.formats import Format
from erdctl.io.sources import TableSource, guarded, native

STREAMS = (Format.PARQUET, Format.ARROW)


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
            try:
                table = guarded(source.name, source.format, lambda: next(tables, None))
            except MemoryError:
                raise ComputationProblem(
                    f"out of memory while reading {source.name}; split it"
                ) from None
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


class Rows:
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
