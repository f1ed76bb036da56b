"""What MAT, HDF5, MDF4 and TDMS files hold: channels with samples, unit and time base each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.io.dampers import DAMPER, damper_of
from erdctl.io.named import plainly
from erdctl.io.stored import stored_unit
from erdctl.io.units import RECORD

TIME = "t"  # the column that a container's own time bases become


@dataclass(frozen=True, eq=False)
class Samples:
    """values : (n,) numbers, logicals or text;  time : (n,) [s], None if the file has none.

    why : there is no time, where there is more to say than that;  said : what was done to them
    """

    values: npt.NDArray[Any]
    time: Array | None = None
    why: str | None = None
    said: str | None = None


@dataclass(frozen=True, eq=False)
class Channel:
    """One measured quantity.

    unit : as the file spells it, None if it states none;  timed : its samples come with a time
    count : how many samples the file says it has, None if it is not known before loading
    """

    name: str
    unit: str | None
    load: Callable[[], Samples]
    timed: bool = False
    count: int | None = None


@dataclass(frozen=True, eq=False)
class ChannelGroup:
    """Channels that the file keeps together.

    clock : the channel that their time was taken from, as the file calls it, and clock_unit what
    it was in (None: nothing is said, s was assumed)
    record : the file says that this is a record, whatever the others hold
    notes : what was assumed
    """

    name: str
    channels: tuple[Channel, ...]
    clock: str | None = None
    clock_unit: str | None = "s"
    record: bool = False
    notes: tuple[str, ...] = ()

    @property
    def timed(self) -> bool:
        return any(c.timed for c in self.channels)


@dataclass(frozen=True, eq=False)
class Member:
    """A channel in its record; those of one `group` share an untimed length."""

    group: int
    channel: Channel


@dataclass(frozen=True, eq=False)
class Layout:
    """A container as one table with records.

    records : name (None: the file does not tell records apart) and its channels by column
    units : of the columns that have one;  clocks : names that `t` has in the file
    notes : what was left out;  dampers : of each record, where they are of several
    """

    records: tuple[tuple[str | None, dict[str, Member]], ...]
    columns: tuple[str, ...]
    units: dict[str, str]
    clocks: frozenset[str]
    notes: tuple[str, ...]
    dampers: tuple[str, ...] = ()


def arrange(groups: Iterable[ChannelGroup], file: str, notes: Sequence[str] = ()) -> Layout:
    """The table that the groups of a file make.

    Groups with the same channels are records of one test after another, and have a column `damper`
    where they are called after several dampers; other groups belong to one record, and a name that
    several of them have becomes GROUP/NAME.
    Raises InputProblem if there are no channels.
    """
    found = [g for g in groups if g.channels]
    said = list(notes)
    if not found:
        why = f" ({'; '.join(said)})" if said else ""
        raise InputProblem(f"no channels with samples in it{why}", file=file)
    marked = [g for g in found if g.record]
    if marked and len(marked) < len(found):
        rest = ", ".join(g.name for g in found if not g.record)
        said.append(f"only its records are read; left out: {rest}")
        found = marked
    said += dict.fromkeys(note for g in found for note in g.notes)
    timed = any(g.timed for g in found)
    names = [{c.name for c in g.channels} for g in found]
    records: list[tuple[str | None, dict[str, Member]]]
    if marked or (len(found) > 1 and all(n == names[0] for n in names)):
        members = [_of_record(g, timed=timed) for g in found]
        common, some = set.intersection(*map(set, members)), set().union(*members)
        if some - common:
            said.append(f"not in every record, left out: {', '.join(sorted(some - common))}")
        members = [{c: m for c, m in one.items() if c in common} for one in members]
        records = list(zip(_unique([g.name for g in found]), members, strict=True))
    else:
        records = [(None, _together(found, timed=timed))]
    dampers = _dampers(found) if len(records) > 1 and not marked else ()
    first = records[0][1]
    columns = [*([TIME] if timed else []), *first]
    if records[0][0] is not None and RECORD not in first:
        columns.append(RECORD)
    if dampers:
        columns.append(DAMPER)
    units = _units(records, file)
    clock_units = {g.clock_unit for g in found if g.timed}
    if timed and None not in clock_units:
        units[TIME] = "s" if len(clock_units) > 1 else str(clock_units.pop())
    clocks = frozenset(g.clock for g in found if g.clock is not None) - {TIME}
    return Layout(tuple(records), tuple(columns), units, clocks, tuple(said), dampers)


def _dampers(groups: Sequence[ChannelGroup]) -> tuple[str, ...]:
    """Whose records these are, where their names say so of all, and of more than one damper."""
    if any(plainly(c.name) == DAMPER for c in groups[0].channels):
        return ()
    found = [d for g in groups if (d := damper_of(g.name)) is not None]
    return tuple(found) if len(found) == len(groups) and len(set(found)) > 1 else ()


def _of_record(group: ChannelGroup, *, timed: bool) -> dict[str, Member]:
    """The channels of a record, by names that do not depend on what the record is called."""
    taken = [TIME] if timed else []
    names = _unique([*taken, *(c.name for c in group.channels)])[len(taken) :]
    members = [Member(0, c) for c in group.channels]
    return dict(zip(names, members, strict=True))


def _together(groups: Sequence[ChannelGroup], *, timed: bool) -> dict[str, Member]:
    chosen = [(i, g, c) for i, g in enumerate(groups) for c in g.channels]
    count = Counter(c.name for _, _, c in chosen)
    names = [
        f"{g.name}/{c.name}" if count[c.name] > 1 or (timed and c.name == TIME) else c.name
        for _, g, c in chosen
    ]
    members = [Member(i, c) for i, _, c in chosen]
    return dict(zip(_unique(names), members, strict=True))


def _unique(names: Sequence[str]) -> list[str]:
    out: list[str] = []
    for name in names:
        new, copy = name, 2
        while new in out:
            new, copy = f"{name} ({copy})", copy + 1
        out.append(new)
    return out


def _units(records: Sequence[tuple[str | None, dict[str, Member]]], file: str) -> dict[str, str]:
    out: dict[str, str] = {}
    first = records[0][1]
    for column, member in first.items():
        units = {r: stored_unit(m[column].channel.unit) for r, m in records}
        if len(set(units.values())) > 1:
            said = ", ".join(f"{u or 'none'} in record '{r}'" for r, u in list(units.items())[:3])
            raise InputProblem(
                f"its unit differs from record to record: {said}; give them one by one",
                file=file,
                column=column,
            )
        unit = stored_unit(member.channel.unit)
        if unit is not None:
            out[column] = unit
    return out
