"""A table in any format as a table in any other, with its units."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Index, running_time
from erdctl.core.stretches import LONG
from erdctl.io.arrays import runs_of_text
from erdctl.io.batches import in_portions, long_source, read_batches
from erdctl.io.checks import Place, check_growth, check_values
from erdctl.io.columns import to_numbers
from erdctl.io.joins import names_of_runs, restarts
from erdctl.io.maps import parse_maps
from erdctl.io.memory import check_fits
from erdctl.io.names_of_logs import stem
from erdctl.io.outline import ByColumn, Outline, outline, place_behind
from erdctl.io.plan import ColumnPlan, in_contract_names, plan_columns, read_planned
from erdctl.io.sources import TableSource, open_source
from erdctl.io.stored import si, units_apart, with_unit, with_units
from erdctl.io.text.options import TextOptions, TextSpec, parse_text_options
from erdctl.io.units import RECORD, Conversion

_NAMED = "a column 'record' that names them is written"

if TYPE_CHECKING:
    from erdctl.io.project.reading import ProjectReading


def read_converted(
    path: str,
    *,
    maps: Sequence[str] = (),
    text: TextSpec = None,
    project: ProjectReading | None = None,
    goes_on: bool = False,
    say: Callable[[str], None],
    warn: Callable[[str], None] | None = None,
) -> pa.Table:
    """All columns of a file; those of the contract under its names and in SI, others as they are.

    Nothing is required of it: it need not be a whole log. But where it has a time or records, they
    must be in order, as every other command demands; runs whose time begins anew become records.
    maps, text : options `--map` and `--text`;  project : what a project file says besides
    goes_on : the time goes on from record to record, where it began anew
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
    table = _stating(_in_si(table, plan, source.name, note), plan, source)
    if rows := table.num_rows:
        place = Place(source.name, lambda sample: source.row_of(sample, rows))
        table, plan = _with_runs(table, plan, source, place, note)
        _Checks(plan, warn or say).add(table, place)
    if goes_on:
        table = _going_on(table, plan, source)
    return units_apart(table)


def _stating(table: pa.Table, plan: ColumnPlan, source: TableSource) -> pa.Table:
    """The table with the units that a row of a text gives to columns other than the contract's."""
    units = {} if source.text is None else source.text.header.units
    own = {n: u for n, u in units.items() if n in table.column_names and n not in plan and u != "1"}
    return with_units(table, own) if own else table


def _with_runs(
    table: pa.Table,
    plan: ColumnPlan,
    source: TableSource,
    place: Place,
    note: Callable[[str], None],
) -> tuple[pa.Table, ColumnPlan]:
    """The table with a column `record` for runs that follow one another, if it has none."""
    if "t" not in plan or RECORD in plan:
        return table, plan
    starts = restarts(to_numbers(table.column("t"), plan["t"][0], place))
    if starts is None:
        return table, plan
    names = names_of_runs(starts, stem(source.path), place, note, named=_NAMED)
    column = runs_of_text(names, np.diff(starts), pa.string())
    return table.append_column(RECORD, column), plan | {RECORD: (RECORD, Conversion())}


def _going_on(table: pa.Table, plan: ColumnPlan, source: TableSource) -> pa.Table:
    if "t" not in plan or RECORD not in plan:
        raise UsageProblem(
            f"{source.name}: --running-time is for logs with columns t and record; --map says which"
            " those are"
        )
    place = Place(source.name, lambda sample: source.row_of(sample, table.num_rows))
    t = to_numbers(table.column("t"), plan["t"][0], place)
    starts, _ = ByColumn(plan[RECORD][0]).add(table.column(RECORD), place, 0)
    if t.size:
        t = running_time(t, starts)
    index = table.column_names.index("t")
    field = table.schema.field(index).with_type(pa.float64())
    return table.set_column(index, field, pa.chunked_array([pa.array(t)]))


def converted_in_parts(
    path: str,
    *,
    maps: Sequence[str] = (),
    say: Callable[[str], None],
    warn: Callable[[str], None],
    progress: Progress = lambda stage, what: None,
) -> Iterator[pa.Table] | None:
    """The same some rows at a time, of a long file that can be read so; else None."""
    source = long_source([path])
    if source is None:
        return None
    said: list[str] = []
    plan = plan_columns(source, parse_maps(maps), needed=(), say=said.append)
    assert source.schema is not None
    if "t" in plan and pa.types.is_temporal(source.schema.field(plan["t"][0]).type):
        return None
    found = None
    if "t" in plan and RECORD not in plan:
        found = outline(source, plan, (), (), stem(path), said.append, named=_NAMED)
    for line in said:
        say(f"{source.name}: {line}")
    return _parts(source, plan, found, say, warn, progress)


def _parts(
    source: TableSource,
    plan: ColumnPlan,
    runs: Outline | None,
    say: Callable[[str], None],
    warn: Callable[[str], None],
    progress: Progress,
) -> Iterator[pa.Table]:
    divided = runs is not None and runs.named
    checks, rows = _Checks(plan | ({RECORD: (RECORD, Conversion())} if divided else {}), warn), 0
    labels = [plan[RECORD][0]] if RECORD in plan else []
    for table in in_portions(read_batches(source, source.columns, labels), LONG):
        progress("converting", part_of(f"{source.rows} rows", rows + 1, source.rows or 1))
        said: list[str] = []
        table = _in_si(table, plan, source.name, said.append)
        if not rows:
            for line in said:
                say(f"{source.name}: {line}")
        if runs is not None and runs.named:
            edges = np.clip(runs.starts - rows, 0, table.num_rows)
            column = runs_of_text(runs.names, np.diff(edges), pa.string())
            table = table.append_column(RECORD, column)
        checks.add(table, place_behind(source.name, rows))
        rows += table.num_rows
        yield units_apart(_own_labels(table, source, plan))


def _own_labels(table: pa.Table, source: TableSource, plan: ColumnPlan) -> pa.Table:
    """The table with `record` in the type that the log has it in."""
    if RECORD not in plan or source.schema is None:
        return table
    index = table.column_names.index(RECORD)
    own = source.schema.field(plan[RECORD][0]).type
    if table.schema.field(index).type == own:
        return table
    field = table.schema.field(index).with_type(own)
    return table.set_column(index, field, table.column(index).cast(own))


def _in_si(table: pa.Table, plan: ColumnPlan, file: str, note: Callable[[str], None]) -> pa.Table:
    table = in_contract_names(table, plan, note)
    for target, (column, convert) in plan.items():
        if target == RECORD:
            continue
        index = table.column_names.index(target)
        field, values = table.schema.field(index), table.column(index)
        if convert != Conversion():
            values = _converted(values, convert, file, column)
        field = with_unit(field.with_type(values.type), si(target))
        table = table.set_column(index, field, values)
    return table


class _Checks:
    """Refuses a time and records out of order, warns of values out of range, part by part."""

    def __init__(self, plan: ColumnPlan, warn: Callable[[str], None]) -> None:
        self.plan, self.warn = plan, warn
        self._labels = ByColumn(plan[RECORD][0]) if RECORD in plan else None
        self._rows = 0
        self._last: tuple[float, str | None] | None = None  # time and record
        self._warned: set[str] = set()

    def add(self, table: pa.Table, place: Place) -> None:
        """The next rows, one at least."""
        starts, names = np.array([0, table.num_rows], dtype=np.intp), None
        if self._labels is not None:
            starts, names = self._labels.add(table.column(RECORD), place, self._rows)
        self._rows += table.num_rows
        if "t" in self.plan:
            self._check_time(table, starts, names, place)
        for target in [n for n in self.plan if n not in ("t", RECORD) and n not in self._warned]:
            try:
                values = to_numbers(table.column(target), self.plan[target][0], place)
                check_values(target, values, place, source=self.plan[target][0])
            except InputProblem as problem:
                self._warned.add(target)
                self.warn(f"{problem}; converted as it is, and refused by other commands")

    def _check_time(
        self, table: pa.Table, starts: Index, names: tuple[str, ...] | None, place: Place
    ) -> None:
        t, column = to_numbers(table.column("t"), self.plan["t"][0], place), self.plan["t"][0]
        check_values("t", t, place, source=column)
        narrow = table.schema.field("t").type == pa.float32()
        record = None if names is None else names[0]
        if self._last is not None and self._last[1] == record:
            # With the last time before, which its own must be later than.
            t, starts = np.append(self._last[0], t), np.append(0, starts[1:] + 1)
            before = place
            place = Place(place.file, lambda sample: before.row_of(sample - 1))
        check_growth(t, starts, names, place, source=column, narrow=narrow)
        self._last = float(t[-1]), None if names is None else names[-1]


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
