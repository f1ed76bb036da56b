"""The contract's columns of a table as channels, and the table with what became of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import pyarrow as pa

from erdctl.core.recording import Array, Index
from erdctl.io.arrays import arrow, runs_of_text
from erdctl.io.checks import Place, check_values
from erdctl.io.columns import to_numbers
from erdctl.io.plan import ColumnPlan
from erdctl.io.problems import Problems
from erdctl.io.sources import TableSource
from erdctl.io.stored import si, with_unit
from erdctl.io.units import RECORD, Conversion


def take_channels(
    table: pa.Table, plan: ColumnPlan, place: Place, *, keep_table: bool
) -> tuple[dict[str, Array], pa.Table]:
    """(n,) of each channel in SI, checked, and the table with them; without, to save memory.

    table : under the contract's names.  Raises InputProblem with all that is wrong.
    """
    channels: dict[str, Array] = {}
    problems = Problems(place.file)
    for target in [t for t in plan if t != RECORD]:
        column, convert = plan[target]
        numbers = problems.attempt(partial(to_numbers, table.column(target), column, place))
        if numbers is None:
            continue
        values = convert(numbers)
        problems.attempt(partial(check_values, target, values, place, source=column))
        # Column by column, so that at most one of them is in memory twice.
        if keep_table:
            table = _with_channel(table, target, values, converted=convert != Conversion())
        else:
            table = table.drop_columns(target)
        channels[target] = values
    problems.settle()
    return channels, table


def _with_channel(table: pa.Table, target: str, values: Array, *, converted: bool) -> pa.Table:
    """The table with a channel's values, shared; a column that needed no change stays as it was."""
    index = table.column_names.index(target)
    field, column = with_unit(table.schema.field(index), si(target)), table.column(index)
    if not converted and (column.num_chunks == 1 or field.type != pa.float64()):
        return table.set_column(index, field, column)
    return table.set_column(index, field.with_type(pa.float64()), arrow(values))


def with_own_label(
    table: pa.Table, source: TableSource, plan: ColumnPlan, starts: Index, names: Sequence[str]
) -> pa.Table:
    """The table with `record` in the type that the log has it in."""
    if RECORD not in plan or source.schema is None:
        return table
    index = table.column_names.index(RECORD)
    field = source.schema.field(plan[RECORD][0]).with_name(RECORD)
    if field.type == table.schema.field(index).type:
        return table
    text = runs_of_text(names, np.diff(starts), field.type)
    return table.set_column(index, field, text)
