"""A table in any format as a table in any other, with its units."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.io.memory import check_fits
from erdctl.io.plan import in_contract_names, plan_columns, read_planned
from erdctl.io.sources import open_source
from erdctl.io.stored import si, units_apart, with_unit
from erdctl.io.text.options import TextOptions, TextSpec, parse_text_options
from erdctl.io.units import RECORD, Conversion, parse_maps


def read_converted(
    path: str, *, maps: Sequence[str] = (), text: TextSpec = None, say: Callable[[str], None]
) -> pa.Table:
    """All columns of a file; those of the contract under its names and in SI, others as they are.

    Nothing is required of it: it need not be a whole log.
    maps, text : options `--map` and `--text`;  say : takes a line for all that was assumed
    Raises UsageProblem, InputProblem as `read_logs` does.
    """
    mappings = parse_maps(maps)
    written = parse_text_options(text)
    source = open_source(path, text=None if written == TextOptions() else written)

    def note(line: str) -> None:
        say(f"{source.name}: {line}")

    plan = plan_columns(source, mappings, needed=(), say=note)
    check_fits(source, len(source.columns))
    table, plan, _ = read_planned(source, plan, mappings, source.columns, say=note)
    table = in_contract_names(table, plan, note)
    for target, (column, convert) in plan.items():
        if target == RECORD:
            continue
        index = table.column_names.index(target)
        field, values = table.schema.field(index), table.column(index)
        if convert != Conversion():
            values = _converted(values, convert, source.name, column)
        field = with_unit(field.with_type(values.type), si(target))
        table = table.set_column(index, field, values)
    return units_apart(table)


def _converted(
    column: pa.ChunkedArray, convert: Conversion, file: str, name: str
) -> pa.ChunkedArray:
    """Numbers in SI; empty cells stay empty."""
    try:
        values = column.cast(pa.float64(), safe=False).combine_chunks()
    except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
        raise InputProblem(
            f"holds {column.type}, expected numbers", file=file, column=name
        ) from None
    empty = np.asarray(values.is_null())
    return pa.chunked_array(
        [pa.array(convert(values.fill_null(0.0).to_numpy()), mask=empty if empty.any() else None)]
    )
