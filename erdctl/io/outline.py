"""The records of a long log, by a first look at one of its columns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Index
from erdctl.io.batches import read_batches
from erdctl.io.checks import Place
from erdctl.io.columns import to_numbers, to_records
from erdctl.io.dampers import Where, chosen_rows
from erdctl.io.joins import names_of_runs, restarts_at
from erdctl.io.plan import ColumnPlan
from erdctl.io.sources import TableSource
from erdctl.io.units import RECORD

MOST_FALLS = 100_000  # of a time; more are no runs


class Outline(NamedTuple):
    """Offsets and names of the records; named : by a column, or by their time."""

    starts: Index
    names: tuple[str, ...]
    named: bool


def outline(
    source: TableSource,
    plan: ColumnPlan,
    choosing: Sequence[str],
    where: Sequence[Where],
    stem: str,
    say: Callable[[str], None],
    **named: str,
) -> Outline | None:
    """The records of a log, or None if only some of its rows are wanted.

    choosing : columns that say which damper a row is of;  named : as of `names_of_runs`
    Raises InputProblem for records that come back, and for several dampers.
    """
    column, convert = plan[RECORD] if RECORD in plan else plan["t"]
    looked = list(dict.fromkeys([column, *choosing]))
    labels = [c for c in looked if c != column or RECORD in plan]
    chosen = {name: dict[str | None, None]() for name in choosing}
    look: ByColumn | _Times = ByColumn(column) if RECORD in plan else _Times()
    rows = 0
    for table in read_batches(source, looked, labels):
        place = place_behind(source.name, rows)
        values = table.column(column)
        if isinstance(look, ByColumn):
            look.add(values, place, rows)
        else:
            look.add(convert(to_numbers(values, column, place)), rows)
        for name, seen in chosen.items():
            seen.update(dict.fromkeys(_texts(table.column(name))))
        rows += table.num_rows
    if not rows:
        raise InputProblem("a header but no samples", file=source.name)
    if not _all_rows(chosen, where, source.name):
        return None
    if isinstance(look, ByColumn):
        return Outline(np.array([*look.starts, rows], dtype=np.intp), tuple(look.names), True)
    starts = look.runs(rows)
    if starts is None:
        return Outline(np.array([0, rows], dtype=np.intp), (stem,), False)
    return Outline(
        starts, names_of_runs(starts, stem, place_behind(source.name, 0), say, **named), True
    )


def place_behind(file: str, rows: int) -> Place:
    """Where samples stand that begin behind so many rows of a table that has no others."""
    return Place(file, lambda sample: rows + sample + 1)


def _texts(column: pa.ChunkedArray) -> Iterator[str | None]:
    import pyarrow.compute as pc

    try:
        yield from pc.unique(column).cast(pa.string()).to_pylist()
    except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
        return  # what is no text names no damper


def _all_rows(chosen: dict[str, dict[str | None, None]], where: Sequence[Where], file: str) -> bool:
    """Whether every row is wanted; each column is asked by itself, as by all values that it has."""
    return all(
        chosen_rows(
            pa.table({name: pa.array([*seen], pa.string())}),
            [w for w in where if w.column == name],
            file,
        )
        is None
        for name, seen in chosen.items()
    )


class ByColumn:
    """Records by a column that names them."""

    def __init__(self, column: str) -> None:
        self.column = column
        self.starts: list[int] = []
        self.names: list[str] = []
        self._seen: set[str] = set()

    def add(
        self, values: pa.ChunkedArray, place: Place, rows: int
    ) -> tuple[Index, tuple[str, ...]]:
        """The next values, before which there were so many rows; their records alone.

        Raises InputProblem for a record that comes back.
        """
        starts, names = to_records(values, self.column, place)
        for name, start in zip(names, starts.tolist(), strict=False):
            if self.names and name == self.names[-1]:
                continue
            if name in self._seen:
                raise place.problem(
                    f"record '{name}' comes back after another record; sort the rows by record",
                    start,
                    self.column,
                )
            self._seen.add(name)
            self.names.append(name)
            self.starts.append(rows + start)
        return starts, names


class _Times:
    """Runs by their time, which begins anew."""

    def __init__(self) -> None:
        self.falls: list[int] = []
        self.begins: list[float] = []
        self.ends: list[float] = []
        self._last: float | None = None

    def add(self, t: Array, rows: int) -> None:
        before = t[:-1] if self._last is None else np.append(self._last, t[:-1])
        now = t[1:] if self._last is None else t
        at = np.flatnonzero(now < before)
        if self._last is None:
            self.begins.append(float(t[0]))
        if len(self.falls) < MOST_FALLS:
            self.falls += (rows + at + (self._last is None)).tolist()
            self.begins += now[at].tolist()
            self.ends += before[at].tolist()
        self._last = float(t[-1])

    def runs(self, rows: int) -> Index | None:
        """Offsets of the runs, None where there is one, or time falls in another way."""
        if not self.falls or len(self.falls) >= MOST_FALLS or self._last is None:
            return None
        begins, ends = np.array(self.begins), np.array([*self.ends, self._last])
        return restarts_at(np.array(self.falls, dtype=np.intp), begins, ends, rows)
