"""Channels with several time bases as the rows of one table.

The rows are those of `force`, so that the measured force is never interpolated; where it is not
needed those of `x`; of other columns the longest. Between the first and the last time at which all
channels of the contract are recorded, and nowhere else,

    motion, force, temperature: linear between the two samples around a row
    duty, whole numbers, text:  the sample before

A gap in a channel that would be bridged so is refused. Other columns are empty where they have no
samples.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.messages import counted
from erdctl.core.recording import Array
from erdctl.io.arrays import arrow, runs_of_text
from erdctl.io.containers.channels import TIME, Layout, Member
from erdctl.io.containers.usable import checked, numbers, sound
from erdctl.io.dampers import DAMPER
from erdctl.io.roles import Roles
from erdctl.io.stored import with_units
from erdctl.io.units import RECORD

GAP = 5.0  # steps without a sample that are no jitter
_EARLY = 1e-6  # of a step: clocks that count the same samples differ by their rounding
_FIRST = ("force", "x")


@dataclass(frozen=True, eq=False)
class _Column:
    """A column with its samples; target : of the contract, None for others."""

    name: str
    target: str | None
    values: npt.NDArray[Any]
    time: Array

    @property
    def held(self) -> bool:
        kind = self.values.dtype.kind
        return self.target == "duty" or kind not in "iuf" or (self.target is None and kind != "f")


def aligned(layout: Layout, wanted: Sequence[str], roles: Roles, file: str) -> pa.Table:
    """The wanted columns of all records as one table, with units; time in s, record by name.

    A channel that nothing needs and that makes no column is left out, and it is said.
    Raises InputProblem where a needed channel has no time, no numbers, a gap, or no overlap.
    """
    said = _Once(roles.say)
    clock = next((c for c, target in roles.targets.items() if target == TIME), TIME)
    parts: dict[str, list[pa.Array]] = {name: [] for name in wanted}
    lengths: list[int] = []
    for name, members in layout.records:
        said.record = name
        place = file if name is None else f"{file}, record '{name}'"
        columns = _load(members, wanted, clock, roles, place, said)
        time, made = _on_one_base(columns, place, said)
        lengths.append(len(time))
        for column in wanted:
            if column == clock:
                made[column] = arrow(time)
            if column in made:
                parts[column].append(made[column])
    whole = {c: p for c, p in parts.items() if len(p) == len(lengths)}
    table = pa.table({c: _joined(p) for c, p in whole.items()})
    if RECORD in wanted and RECORD not in whole:
        names = [str(name) for name, _ in layout.records]
        table = table.append_column(RECORD, runs_of_text(names, np.array(lengths), pa.string()))
    if layout.dampers and DAMPER in wanted:
        whose = runs_of_text(layout.dampers, np.array(lengths), pa.string())
        table = table.append_column(DAMPER, whose)
    said.tell()
    units = {c: u for c, u in layout.units.items() if c in table.column_names}
    return with_units(table, units | ({clock: "s"} if clock in whole else {}))


class _Once:
    """Says what was done to the first record that it was done to, and to how many more."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self.say = say
        self.record: str | None = None
        self.lines: dict[str, tuple[str, str | None, int]] = {}

    def __call__(self, topic: str, line: str) -> None:
        first, record, count = self.lines.get(topic, (line, self.record, 0))
        self.lines[topic] = (first, record, count + 1)

    def tell(self) -> None:
        for line, record, count in self.lines.values():
            of = "" if record is None else f"record '{record}': "
            more = f"; similarly in {counted(count - 1, 'more record')}" if count > 1 else ""
            self.say(f"{of}{line}{more}")


def _load(
    members: Mapping[str, Member],
    wanted: Sequence[str],
    clock: str,
    roles: Roles,
    place: str,
    said: _Once,
) -> list[_Column]:
    own = members.get(clock)  # the user says that this channel is the time of its group
    times: dict[int, Array] = {}
    if own is not None:
        values = numbers(sound(own.channel.load().values))
        if values is None:
            raise InputProblem("expected numbers to be the time", file=place, column=clock)
        times[own.group] = roles.seconds(values)
    out = []
    names = [n for n in wanted if n in members and n != clock]
    if not names and own is None:  # only the time is asked for
        names = list(members)[:1]
    for name in names:
        member, target = members[name], roles.targets.get(name)
        samples = member.channel.load()
        time = times.get(member.group, samples.time)
        found = checked(samples, time)
        if isinstance(found, str):
            if target is not None:
                raise InputProblem(found, file=place, column=name)
            said(f"left {name}", f"'{name}' is left out: {found}")
            continue
        if samples.said is not None:
            said(f"samples {name}", f"'{name}': {samples.said}")
        out.append(_Column(name, target, *found))
    if not out and own is not None:
        out.append(_Column(clock, TIME, times[own.group], times[own.group]))
    if not out:
        raise InputProblem("none of its channels has a time and samples", file=place)
    return out


def _on_one_base(
    columns: Sequence[_Column], place: str, said: _Once
) -> tuple[Array, dict[str, pa.Array]]:
    bases: list[Array] = []
    base_of: dict[str, int] = {}
    for column in columns:
        for i, time in enumerate(bases):
            if time is column.time or np.array_equal(time, column.time):
                base_of[column.name] = i
                break
        else:
            base_of[column.name] = len(bases)
            bases.append(column.time)
    if len(bases) == 1:
        return bases[0], {c.name: _arrow(c.values) for c in columns}
    for column in columns:
        if not np.all(np.diff(column.time) > 0.0):  # NaN too
            at = int((~(np.diff(column.time) > 0.0)).argmax())
            raise InputProblem(
                f"its time must grow to be brought onto the base of others, but goes from"
                f" {column.time[at]:.9g} s to {column.time[at + 1]:.9g} s",
                file=place,
                column=column.name,
            )
    leader = _leader(columns)
    needed = [c for c in columns if c.target is not None] or [leader]
    base = leader.time
    slack = _EARLY * _step(base)
    first, last = max(c.time[0] for c in needed), min(c.time[-1] for c in needed)
    rows = base[(base >= first - slack) & (base <= last + slack)]
    if len(rows) < 2:
        spans = ", ".join(f"{c.name} {c.time[0]:g} to {c.time[-1]:g} s" for c in needed)
        raise InputProblem(f"its channels do not overlap in time: {spans}", file=place)
    made = {
        c.name: _moved(
            c, rows, place, same=c.time is base or base_of[c.name] == base_of[leader.name]
        )
        for c in columns
    }
    _report(
        columns,
        leader,
        {c.name for c in columns if base_of[c.name] != base_of[leader.name]},
        rows,
        said,
    )
    return rows, made


def _leader(columns: Sequence[_Column]) -> _Column:
    for target in _FIRST:
        for column in columns:
            if column.target == target:
                return column
    return max(columns, key=lambda c: len(c.time))


def _moved(column: _Column, rows: Array, place: str, *, same: bool) -> pa.Array:
    time, values = column.time, column.values
    if same:
        first = int(np.searchsorted(time, rows[0]))
        return _arrow(values[first : first + len(rows)])
    slack = _EARLY * _step(rows)
    # The last digits of a clock decide nothing: what changes with a row is its value.
    before = np.clip(np.searchsorted(time, rows + slack, side="right") - 1, 0, len(time) - 1)
    out = (rows < time[0] - slack) | (rows > time[-1] + slack)
    if column.held:
        return _arrow(values[before], out if column.target is None else None)
    steps = np.diff(time)
    # A row between two samples that lie too far apart, and not on one of them.
    wide = np.append(steps > GAP * _step(time), False)[before] & (rows > time[before] + slack)
    if column.target is None:
        return _arrow(np.where(out | wide, np.nan, np.interp(rows, time, values)))
    if wide.any():
        at = int(before[int(wide.argmax())])
        raise InputProblem(
            f"no samples for {steps[at]:.4g} s from t = {time[at]:.6g} s, though it has one every"
            f" {_step(time):.4g} s; nothing is invented there: cut the log at the gap, or give"
            " the channel anew",
            file=place,
            column=column.name,
        )
    return _arrow(np.interp(rows, time, values))


def _report(
    columns: Sequence[_Column], leader: _Column, others: set[str], rows: Array, said: _Once
) -> None:
    def listing(held: bool) -> str:
        chosen = [c for c in columns if c.name in others and c.held == held]
        more = f" and {len(chosen) - 8} more" if len(chosen) > 8 else ""
        return ", ".join(f"{c.name} ({_rate(c.time)})" for c in chosen[:8]) + more

    line = f"several time bases; the rows are those of {leader.name} ({_rate(leader.time)})"
    if linear := listing(held=False):
        line += f"; interpolated linearly: {linear}"
    if held := listing(held=True):
        line += f"; held from the sample before: {held}"
    dropped = len(leader.time) - len(rows)
    if dropped:
        line += (
            f"; {counted(dropped, 'row')} outside {rows[0]:.6g} to {rows[-1]:.6g} s, where not all"
            " of them"
            " are recorded, left out"
        )
    said("bases", line)
    steps = np.diff(rows)
    if steps.max() > GAP * _step(rows):
        said(
            "gap",
            f"{leader.name} has a gap of {steps.max():.4g} s after {rows[steps.argmax()]:.6g} s",
        )


def _step(time: Array) -> float:
    return float(np.median(np.diff(time))) if len(time) > 1 else 0.0


def _rate(time: Array) -> str:
    step = _step(time)
    return f"{1.0 / step:.4g} Hz" if step else "1 sample"


def _arrow(values: npt.NDArray[Any], missing: npt.NDArray[np.bool_] | None = None) -> pa.Array:
    if values.dtype == np.float64:
        return arrow(values)
    return pa.array(values, mask=missing)


def _joined(parts: Sequence[pa.Array]) -> pa.ChunkedArray:
    kinds = {p.type for p in parts}
    if len(kinds) > 1:
        number = all(pa.types.is_integer(k) or pa.types.is_floating(k) for k in kinds)
        parts = [p.cast(pa.float64() if number else pa.string()) for p in parts]
    return pa.chunked_array(parts)
