"""Bench logs: files and streams as one validated Recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.messages import as_text
from erdctl.core.progress import Progress, told
from erdctl.core.recording import Array, Index, Recording, Source, concatenate
from erdctl.io.channels import take_channels, with_own_label
from erdctl.io.checks import Place, check_time, remark_on_time
from erdctl.io.columns import to_numbers, to_records
from erdctl.io.consistency import check_consistency
from erdctl.io.dampers import Where, chosen_rows, needed_columns, parse_where
from erdctl.io.joins import runs
from erdctl.io.maps import Mapping as ColumnMapping
from erdctl.io.maps import parse_maps
from erdctl.io.memory import check_fits
from erdctl.io.names_of_logs import names_of, qualified, refuse_repeated, stem
from erdctl.io.plan import ColumnPlan, Report, in_contract_names, plan_columns, read_planned
from erdctl.io.sources import STDIN, open_source
from erdctl.io.text.options import TextOptions, TextSpec, parse_text_options
from erdctl.io.units import RECORD

if TYPE_CHECKING:
    from erdctl.io.project.labels import Labels
    from erdctl.io.project.reading import ProjectReading

Held = Mapping[str, bytearray]

FORCES = ("force", "force_model")


@dataclass(frozen=True)
class ColumnMap:
    """One of the contract's columns: the log's own column, times factor plus offset, is SI."""

    name: str
    column: str
    factor: float
    offset: float


@dataclass(frozen=True, eq=False)
class Log:
    """One or more logs as they were read.

    table : all columns of the log, in its order and row by row as in the recording; mapped
        columns bear the contract's name and are SI (only if asked for)
    force_model : (n,) [N] if the log has it (only where force is needed or wanted)
    channels : what was read, and from which columns;  unread : columns that were not
    others : (n,) further columns that were asked for and are there
    units : as the file states them for columns, apart from those in names like `x [mm]`
    labels : what the log is of by the project file, of several logs what all are of
    """

    recording: Recording
    table: pa.Table | None = None
    force_model: Array | None = None
    channels: tuple[ColumnMap, ...] = ()
    unread: tuple[str, ...] = ()
    others: dict[str, Array] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    labels: Labels | None = None


def read_logs(
    paths: Sequence[str],
    *,
    maps: Sequence[str] = (),
    text: TextSpec = None,
    where: Sequence[str] = (),
    need_force: bool,
    want_force: bool = False,
    keep_table: bool = False,
    want_hash: bool = False,
    others: Sequence[str] = (),
    held: Held = MappingProxyType({}),
    project: ProjectReading | None = None,
    report: Report,
    progress: Progress = lambda stage, what: None,
) -> Log:
    """Read and validate bench logs (any format of `Format`; "-" is standard input).

    maps, text, where : options `--map`, `--text` and `--where`, for all logs alike
    need_force : else force is read only if mapped, or with want_force where the log has it
    keep_table : keep all columns, for a single log;  want_hash : SHA-256 of each log
    others : columns of numbers to read where they are there, of a single log
    held : bytes of logs that are in memory, by what `paths` calls them
    project : what a project file says, where the options do not
    report : takes a line for everything that was assumed or derived
    progress : called with what is being read

    Records keep their names; of several logs they become "stem:record". A log without a column
    `record` is one record called like the file, or several where its time begins anew.
    Raises UsageProblem (no such file, wrong map), InputProblem with file, row and column.
    """
    if not paths:
        raise UsageProblem("no log given")
    if keep_table and len(paths) > 1:
        raise ValueError("keep_table is for a single log")
    mappings, chosen, written = parse_maps(maps), parse_where(where), parse_text_options(text)
    refuse_repeated(paths)
    logs = [
        _read(
            path,
            mappings,
            text=None if written == TextOptions() else written,
            where=chosen,
            need_force=need_force,
            want_force=want_force or need_force,
            keep_table=keep_table,
            want_hash=want_hash,
            others=others if len(paths) == 1 else (),
            held=held,
            project=project,
            spec=text,
            report=report,
        )
        for path in told(paths, progress, "reading")
    ]
    if len(logs) == 1:
        return logs[0]
    recordings = [
        replace(log.recording, names=qualified(log.recording.names, label))
        for log, label in zip(logs, names_of(paths), strict=True)
    ]
    pooled = ", ".join(p if p != STDIN else "stdin" for p in paths[:8])
    more = "" if len(paths) <= 8 else f" and {len(paths) - 8} more"
    report(f"{len(paths)} logs are taken together as one damper: {pooled}{more}")
    if len({r.temperature is None for r in recordings}) > 1:
        report("not all logs have a column temperature; it is left out")
    models = [log.force_model for log in logs if log.force_model is not None]
    together = None if project is None else project.of_all([log.labels for log in logs], report)
    pool = concatenate(recordings)
    return Log(
        pool if together is None else replace(pool, labels=together.texts()),
        force_model=np.concatenate(models) if len(models) == len(logs) else None,
        channels=tuple(dict.fromkeys(c for log in logs for c in log.channels)),
        unread=tuple(dict.fromkeys(name for log in logs for name in log.unread)),
        units={name: unit for log in logs for name, unit in log.units.items()},
        labels=together,
    )


def _read(
    path: str,
    mappings: Sequence[ColumnMapping],
    *,
    text: TextOptions | None,
    where: Sequence[Where],
    need_force: bool,
    want_force: bool,
    keep_table: bool,
    want_hash: bool,
    others: Sequence[str],
    held: Held,
    project: ProjectReading | None,
    spec: TextSpec,
    report: Report,
) -> Log:
    assumed = None
    if project is not None:
        text, assumed = project.text(path, spec)
    source = open_source(path, held.get(path), text=text, assumed=assumed)

    def say(line: str) -> None:
        report(f"{source.name}: {line}")

    needed = ["t", "x", "force"] if need_force else ["t", "x"]
    labels = None
    if project is not None:
        told = project.of_log(source, mappings, where, needed=needed, say=say)
        mappings, where, labels = told.mappings, told.where, told.labels
    plan = plan_columns(
        source,
        mappings,
        needed=needed,
        left=() if want_force else FORCES,
        say=say,
    )
    planned = [column for column, _ in plan.values()]
    extra = [name for name in others if name in source.columns and name not in planned]
    choosing = needed_columns(source.columns, where, source.name)
    wanted = source.columns if keep_table else tuple(dict.fromkeys([*planned, *extra, *choosing]))
    check_fits(source, len(wanted))
    table, plan, digest = read_planned(
        source, plan, mappings, wanted, others=extra, want_hash=want_hash, say=say
    )
    rows = table.num_rows
    if not rows:
        raise InputProblem("a header but no samples", file=source.name)
    kept = chosen_rows(table, where, source.name) if choosing else None
    table = table if kept is None else table.take(kept)
    place = Place(
        source.name,
        lambda sample: source.row_of(sample if kept is None else int(kept[sample]), rows),
    )
    found = {name: to_numbers(table.column(name), name, place) for name in extra}
    table = in_contract_names(table, plan, say)
    starts, names = _records(table, plan, place)
    narrow = table.schema.field("t").type == pa.float32()
    channels, table = take_channels(table, plan, place, keep_table=keep_table)
    if RECORD not in plan:
        starts, names = runs(channels["t"], channels["x"], starts, stem(path), place, say)
    recording = _recording(channels, starts, names, place, plan, narrow=narrow, say=say)
    recording = replace(
        recording,
        names=names or (stem(path),),
        sources=(Source(as_text(path), digest, rows),),
        labels={} if labels is None else labels.texts(),
    )
    return Log(
        recording,
        table=with_own_label(table, source, plan, starts, names) if keep_table else None,
        force_model=channels.get("force_model"),
        channels=mapped(plan),
        unread=unread(source.columns, plan),
        others=found,
        units=dict(source.units),
        labels=labels,
    )


def mapped(plan: ColumnPlan) -> tuple[ColumnMap, ...]:
    """Where each of the contract's columns comes from."""
    return tuple(
        ColumnMap(target, column, float(convert.factor), float(convert.offset))
        for target, (column, convert) in plan.items()
    )


def unread(columns: Sequence[str], plan: ColumnPlan) -> tuple[str, ...]:
    """The columns of a log that nobody asked for."""
    taken = {column for column, _ in plan.values()}
    return tuple(c for c in columns if c not in taken)


def _records(table: pa.Table, plan: ColumnPlan, place: Place) -> tuple[Index, tuple[str, ...]]:
    """Offsets and names of the records; no names if the log does not tell records apart."""
    if RECORD not in plan:
        return np.array([0, table.num_rows], dtype=np.intp), ()
    return to_records(table.column(RECORD), plan[RECORD][0], place)


def _recording(
    channels: dict[str, Array],
    starts: Index,
    names: tuple[str, ...],
    place: Place,
    plan: ColumnPlan,
    *,
    narrow: bool,
    say: Report,
) -> Recording:
    t, x = channels["t"], channels["x"]
    check_time(t, starts, names or None, place, source=plan["t"][0], narrow=narrow)
    remark = remark_on_time(t, starts)
    if remark:
        say(remark)
    note = "measured"
    if "xdot" in channels:
        xdot = channels["xdot"]
        own = {n: plan[n][0] for n in ("t", "x", "xdot")}
        check_consistency(t, x, xdot, starts, place, sources=own)
    else:
        from erdctl.bench.differentiation import derive_xdot

        xdot, note = derive_xdot(t, x, starts, file=place.file, row_of=place.row_of)
        say(f"no column xdot; {note}")
    if "duty" not in channels:
        say("no column duty; taken as 0 (no control)")
    return Recording(
        t=t,
        x=x,
        xdot=xdot,
        duty=channels["duty"] if "duty" in channels else np.zeros_like(t),
        force=channels.get("force"),
        temperature=channels.get("temperature"),
        starts=starts,
        names=names or ("",),
        xdot_note=note,
    )
