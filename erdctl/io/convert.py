"""A table in any format as a table in any other, with its units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.io.checks import Place, check_growth, check_values
from erdctl.io.columns import to_numbers, to_records
from erdctl.io.maps import parse_maps
from erdctl.io.memory import check_fits
from erdctl.io.plan import ColumnPlan, in_contract_names, plan_columns, read_planned
from erdctl.io.sources import TableSource, open_source
from erdctl.io.stored import si, units_apart, with_unit
from erdctl.io.text.options import TextOptions, TextSpec, parse_text_options
from erdctl.io.units import RECORD, Conversion

if TYPE_CHECKING:
    from erdctl.io.project.reading import ProjectReading


def read_converted(
    path: str,
    *,
    maps: Sequence[str] = (),
    text: TextSpec = None,
    project: ProjectReading | None = None,
    say: Callable[[str], None],
    warn: Callable[[str], None] | None = None,
) -> pa.Table:
    """All columns of a file; those of the contract under its names and in SI, others as they are.

    Nothing is required of it: it need not be a whole log. But where it has a time or records, they
    must be in order, as every other command demands.
    maps, text : options `--map` and `--text`;  project : what a project file says besides
    say : takes a line for all that was assumed
    warn : takes a line for every column with values that no other command would accept; by default
        that is said like the rest
    Raises UsageProblem, InputProblem as `read_logs` does.
    """
    mappings = parse_maps(maps)
    written = parse_text_options(text)
    explicit = None if written == TextOptions() else written
    assumed = None
    if project is not None:
        explicit, assumed = project.text(path, text)
    source = open_source(path, text=explicit, assumed=assumed)

    def note(line: str) -> None:
        say(f"{source.name}: {line}")

    if project is not None:
        mappings = project.of_log(source, mappings, (), needed=(), say=note).mappings
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
    if table.num_rows:
        _check(table, plan, source, warn or say)
    return units_apart(table)


def _check(
    table: pa.Table, plan: ColumnPlan, source: TableSource, warn: Callable[[str], None]
) -> None:
    """Refuse a time and records out of order; warn of values out of range."""
    rows = table.num_rows
    place = Place(source.name, lambda sample: source.row_of(sample, rows))
    starts, names = np.array([0, rows], dtype=np.intp), None
    if RECORD in plan:
        starts, names = to_records(table.column(RECORD), plan[RECORD][0], place)
    if "t" in plan:
        t, column = to_numbers(table.column("t"), plan["t"][0], place), plan["t"][0]
        check_values("t", t, place, source=column)
        narrow = table.schema.field("t").type == pa.float32()
        check_growth(t, starts, names, place, source=column, narrow=narrow)
    for target in [name for name in plan if name not in ("t", RECORD)]:
        try:
            values = to_numbers(table.column(target), plan[target][0], place)
            check_values(target, values, place, source=plan[target][0])
        except InputProblem as problem:
            warn(f"{problem}; converted as it is, and refused by other commands")


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
