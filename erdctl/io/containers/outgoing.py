"""A table on its way into a container: its records, and their columns as arrays with units."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from erdctl.core.errors import UsageProblem
from erdctl.io.checks import Place
from erdctl.io.columns import to_records
from erdctl.io.csv_out import typed
from erdctl.io.stored import unit_of, units_apart, with_si
from erdctl.io.units import RECORD


@dataclass(frozen=True, eq=False)
class Column:
    """name, unit (None: unknown), values (n,): numbers, logicals, or an object array of text."""

    name: str
    unit: str | None
    values: npt.NDArray[Any]


Columns = tuple[Column, ...]


def records_of(table: pa.Table, kind: str) -> list[tuple[str | None, Columns]]:
    """The records of a table, by its column `record`; one without a name if it has none.

    Empty cells become NaN among numbers and "" among text. kind : the format, for messages
    Raises UsageProblem for columns that containers cannot hold, InputProblem for records that
    come back after others.
    """
    table = with_si(units_apart(typed(table)))
    starts = np.array([0, table.num_rows], np.intp)
    names: tuple[str | None, ...] = (None,)
    if RECORD in table.column_names and table.num_rows:
        place = Place("the log", lambda sample: sample + 1)
        starts, found = to_records(table.column(RECORD), RECORD, place)
        names, table = found, table.drop_columns([RECORD])
    whole = [
        Column(f.name, unit_of(f), _values(table.column(i), f.name, kind))
        for i, f in enumerate(table.schema)
    ]
    return [
        (name, tuple(Column(c.name, c.unit, c.values[first:end]) for c in whole))
        for name, (first, end) in zip(names, pairwise(starts.tolist()), strict=True)
    ]


def _values(column: pa.ChunkedArray, name: str, kind: str) -> npt.NDArray[Any]:
    if pa.types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    t = column.type
    if pa.types.is_string(t) or pa.types.is_large_string(t) or pa.types.is_null(t):
        return np.array([v or "" for v in column.to_pylist()], object)
    if pa.types.is_decimal(t) or (column.null_count and pa.types.is_integer(t)):
        column = _as_floats(column, name, kind)
    number = pa.types.is_integer(t) or pa.types.is_floating(t) or pa.types.is_decimal(t)
    if not number and (not pa.types.is_boolean(t) or column.null_count):
        raise UsageProblem(
            f"column '{name}' holds {t}{' with empty cells' if column.null_count else ''}, which"
            f" {kind} cannot hold; write .parquet or .arrow"
        )
    values: npt.NDArray[Any] = column.to_numpy()
    return values


def _as_floats(column: pa.ChunkedArray, name: str, kind: str) -> pa.ChunkedArray:
    try:
        return column.cast(pa.float64())
    except pa.ArrowInvalid:
        raise UsageProblem(
            f"column '{name}' holds {column.type} with empty cells, which {kind} cannot hold"
            " without rounding; write .parquet or .arrow"
        ) from None
