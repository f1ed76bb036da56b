"""Tables that go out, in any format, to files and to standard output."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, BinaryIO

import numpy as np
import pyarrow as pa

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import CHANNELS, Array, Recording
from erdctl.io import csv_out
from erdctl.io.arrays import arrow, runs_of_text
from erdctl.io.atomic import output
from erdctl.io.formats import CONTAINERS, SUFFIXES, Format, by_suffix
from erdctl.io.identity import STDOUT
from erdctl.io.stored import with_si

BATCH = 1 << 20  # rows of an Arrow batch: what a reader of a stream must hold at least


def output_format(path: str, format: str | None = None) -> Format:
    """Format to write: what is asked for, else by suffix, else (stdout, devices) CSV.

    Raises UsageProblem for an unknown format or suffix.
    """
    if format is not None:
        known = [f.value for f in Format]
        if format not in known:
            raise UsageProblem(f"unknown format '{format}'; formats are {', '.join(known)}")
        return Format(format)
    found = by_suffix(path)
    if found is not None:
        return found
    if path == STDOUT or (os.path.exists(path) and not os.path.isfile(path)):
        return Format.CSV
    raise UsageProblem(f"'{path}': unknown suffix; known are {', '.join(SUFFIXES)}")


def write_table(table: pa.Table, path: str, format: str | None = None) -> None:
    """Write a table to a file, whole or not at all, or to standard output for `-`.

    Numbers in CSV read back exactly. `.feather` is an Arrow file, all other Arrow a stream.
    Units go where the format keeps them; see `erdctl.io.stored`.
    Raises UsageProblem, ComputationProblem (disk full), BrokenPipeError (the reader has gone).
    """
    kind = output_format(path, format)
    if kind in CONTAINERS:
        data = container(table, kind)
        with output(path) as stream:
            stream.write(data)
        return
    with table_writer(path, format, parts=False) as write:
        write(table)


@contextmanager
def table_writer(
    path: str, format: str | None = None, *, parts: bool = True
) -> Iterator[Callable[[pa.Table], None]]:
    """What writes a table in parts, all with the same columns; else as `write_table`.

    Formats of channels (`CONTAINERS`) are written as a whole alone.
    parts : whether there may be several, of which an Arrow file keeps no dictionaries
    """
    kind = output_format(path, format)
    with output(path) as stream:
        writer: _Csv | _Parquet | _Arrow
        if kind is Format.CSV:
            writer = _Csv(stream)
        elif kind is Format.PARQUET:
            writer = _Parquet(stream)
        else:
            writer = _Arrow(stream, file=path.lower().endswith(".feather"), parts=parts)

        def write(table: pa.Table) -> None:
            with _writable(kind):
                writer.write(table)

        try:
            yield write
        except BaseException:
            # Else pyarrow would close it later, into a stream that is no more.
            with suppress(Exception):
                writer.close()
            raise
        with _writable(kind):
            writer.close()


@contextmanager
def behind(write: Callable[[pa.Table], None]) -> Iterator[Callable[[pa.Table], None]]:
    """The same next to other work: a table is written while the next one is made."""
    from concurrent.futures import Future, ThreadPoolExecutor

    with ThreadPoolExecutor(1) as pool:
        waiting: list[Future[None]] = []

        def later(table: pa.Table) -> None:
            while waiting:
                waiting.pop().result()
            waiting.append(pool.submit(write, table))

        yield later
        while waiting:
            waiting.pop().result()


@contextmanager
def _writable(kind: Format) -> Iterator[None]:
    """Raise UsageProblem for types that the format's writer does not take."""
    try:
        yield
    except (pa.ArrowInvalid, pa.ArrowNotImplementedError, pa.ArrowTypeError) as error:
        reason = str(error).splitlines()[0][:200]
        raise UsageProblem(
            f"the log has a column that {kind.value} cannot hold ({reason}); choose another format"
        ) from None


def container(table: pa.Table, kind: Format) -> memoryview:
    """The bytes of a MAT, MDF4 or TDMS file with the table.

    Raises UsageProblem for what the format cannot hold, ComputationProblem without its library.
    """
    from erdctl.io.containers.outgoing import records_of

    if kind is Format.MAT:
        from erdctl.io.containers.mat_out import write
    elif kind is Format.MDF:
        from erdctl.io.containers.mdf import write
    elif kind is Format.HDF5:
        from erdctl.io.containers.hdf5 import write
    else:
        from erdctl.io.containers.tdms import write
    # Their libraries go back and forth in the file, which a pipe cannot do.
    stream = io.BytesIO()
    write(records_of(table, kind.name), stream)
    return stream.getbuffer()


def append_column(table: pa.Table, name: str, values: Array) -> pa.Table:
    """The table with a column at its end, in place of one that has this name already."""
    if name in table.column_names:
        table = table.drop_columns([name])
    return table.append_column(name, arrow(values))


def table_of(recording: Recording) -> pa.Table:
    """A recording as a log: the channels that it has, then `record`."""
    channels = {name: getattr(recording, name) for name in CHANNELS}
    columns = {name: arrow(c) for name, c in channels.items() if c is not None}
    lengths = np.diff(recording.starts)
    columns["record"] = runs_of_text(recording.names, lengths, pa.string())
    return pa.table(columns)


def _cannot(table: pa.Table, kind: str, other: str, error: Exception) -> UsageProblem:
    """What to say of a table that a format cannot hold; a nested column is why, as a rule."""
    nested = [f.name for f in table.schema if pa.types.is_nested(f.type)]
    reason = str(error).splitlines()[0][:200]
    which = f"columns {', '.join(nested[:5])} hold lists or structs; " if nested else ""
    return UsageProblem(f"{kind} cannot hold this table ({reason}); {which}write {other}")


class _Csv:
    def __init__(self, stream: BinaryIO) -> None:
        self.stream, self.begun = stream, False

    def write(self, table: pa.Table) -> None:
        for chunk in csv_out.chunks(table, head=not self.begun):
            self.stream.write(chunk)
        self.begun = True

    def close(self) -> None:
        pass


class _Arrow:
    def __init__(self, stream: BinaryIO, *, file: bool, parts: bool) -> None:
        self.stream, self.file, self.parts = stream, file, parts
        self.writer: Any = None

    def write(self, table: pa.Table) -> None:
        table = with_si(csv_out.typed(table))
        try:
            if self.file and self.parts:
                table = _decoded(table)
            if any(pa.types.is_dictionary(f.type) for f in table.schema):
                # A file holds one for each column, Parquet several.
                table = table.unify_dictionaries()
            if self.writer is None:
                new = pa.ipc.new_file if self.file else pa.ipc.new_stream
                self.writer = new(self.stream, table.schema)
            self.writer.write_table(table, max_chunksize=BATCH)
        except (pa.ArrowInvalid, pa.ArrowNotImplementedError) as error:
            raise _cannot(table, "Arrow", ".parquet", error) from None

    def close(self) -> None:
        if self.writer is not None:
            self.writer.close()


def _decoded(table: pa.Table) -> pa.Table:
    for index, field in enumerate(table.schema):
        if pa.types.is_dictionary(field.type):
            kind = field.type.value_type
            column = table.column(index).cast(kind)
            table = table.set_column(index, field.with_type(kind), column)
    return table


class _Parquet:
    def __init__(self, stream: BinaryIO) -> None:
        self.stream = stream
        self.writer: Any = None

    def write(self, table: pa.Table) -> None:
        import pyarrow.parquet as pq

        table = with_si(csv_out.typed(table))
        # Dictionaries do not shorten measured floats, and trying takes a third of the time.
        # Statistics pay only where a reader selects by them.
        few = [f.name for f in table.schema if f.name == "duty" or not pa.types.is_floating(f.type)]
        selected = [name for name in ("t", "record") if name in table.column_names]
        try:
            if self.writer is None:
                self.writer = pq.ParquetWriter(
                    self.stream,
                    table.schema,
                    use_dictionary=few or False,
                    write_statistics=selected or False,
                    compression="snappy",
                )
            self.writer.write_table(table, row_group_size=BATCH)
        except (pa.ArrowInvalid, pa.ArrowNotImplementedError) as error:
            raise _cannot(table, "Parquet", ".arrow", error) from None

    def close(self) -> None:
        if self.writer is not None:
            self.writer.close()
