"""Logs of many rows, read in stretches: never more of them in memory than one stretch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from erdctl.core.messages import as_text
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Array, Recording, Source
from erdctl.core.stretches import LONG, Extent, Gathered, Stretch, cut_at, extents
from erdctl.io.batches import Incoming, long_source, read_batches
from erdctl.io.channels import take_channels, with_own_label
from erdctl.io.checks import Place, check_growth, check_lengths, remark_on_time
from erdctl.io.consistency import check_blocks, consistency_blocks
from erdctl.io.dampers import needed_columns, parse_where
from erdctl.io.logs import FORCES, ColumnMap, mapped, unread
from erdctl.io.maps import parse_maps
from erdctl.io.names_of_logs import stem
from erdctl.io.outline import Outline, outline, place_behind
from erdctl.io.plan import ColumnPlan, Report, in_contract_names, plan_columns
from erdctl.io.sources import TableSource, sha256_of
from erdctl.io.units import RECORD

if TYPE_CHECKING:
    from erdctl.io.project.reading import ProjectReading

MORE = 1 << 16  # samples that are read at once to find a place to cut


@dataclass(frozen=True, eq=False)
class ReadStretch:
    """A stretch as it was read; table, force_model : of its own samples, as in `Log`."""

    stretch: Stretch
    table: pa.Table | None
    force_model: Array | None


@dataclass(eq=False)
class LongLog:
    """A log whose stretches are read one after the other; what `Log` has, as far as it goes on.

    labels : what it is of by the project file
    xdot_note : how xdot was obtained, when all is read
    """

    source: TableSource
    plan: ColumnPlan
    outline: Outline
    keep_table: bool
    want_hash: bool
    say: Report
    progress: Progress
    labels: dict[str, str] = field(default_factory=dict)
    xdot_note: str = "measured"
    digest: str = ""
    _notes: dict[str, None] = field(default_factory=dict)
    _told: bool = False  # what is to be said once

    @property
    def samples(self) -> int:
        """How many there are."""
        return int(self.outline.starts[-1])

    @property
    def channels(self) -> tuple[ColumnMap, ...]:
        """What is read, and from which columns."""
        return mapped(self.plan)

    @property
    def unread(self) -> tuple[str, ...]:
        """Columns that are not read."""
        return unread(self.source.columns, self.plan)

    @property
    def sources(self) -> tuple[Source, ...]:
        """The file, with its hash if that was wanted and all is read."""
        return (Source(as_text(self.source.path), self.digest, self.samples),)

    def stretches(self, *, cut: bool = True) -> Iterator[ReadStretch]:
        """All of the log; cut : whether a record longer than a stretch may be divided.

        Raises InputProblem where a sample is wrong, and, at the end, if the channels contradict one
        another.
        """
        starts, names = self.outline.starts, self.outline.names
        check_lengths(starts, names if self.outline.named else None, self._place(0))
        blocks = consistency_blocks(starts) if "xdot" in self.plan else []
        seen = Gathered([ends for _, parts in blocks for ends in parts])
        columns = [column for column, _ in self.plan.values()]
        wanted = self.source.columns if self.keep_table else tuple(dict.fromkeys(columns))
        labels = [self.plan[RECORD][0]] if RECORD in self.plan else []
        with ThreadPoolExecutor(1) as pool:
            digest: Future[str] | None = None
            if self.want_hash:
                digest = pool.submit(sha256_of, self.source.data)
            rows = Incoming(read_batches(self.source, wanted, labels))
            for extent in extents(starts):
                cuts = cut and extent.behind == extent.record + 1 and "xdot" in self.plan
                self._warn(extent, cuts)
                for found in self._parts(rows, extent, cuts):
                    seen.add(found.stretch)
                    yield found
            if digest is not None:
                self.digest = digest.result()
        self._finish(blocks, seen)

    def _parts(self, rows: Incoming, e: Extent, cuts: bool) -> Iterator[ReadStretch]:
        a = e.first
        while a < e.end:
            self.progress("reading", part_of(f"{self.samples} samples", a + 1, self.samples))
            left = e.end - a
            if not cuts or left <= LONG + LONG // 2:
                length = left
                recording, table, model = self._take(rows.next(left), e, a)
            else:
                there, found = LONG + MORE, None
                while found is None:
                    there = min(there, left)
                    recording, table, model = self._take(rows.next(there), e, a)
                    found = cut_at(recording.xdot, left)
                    there += MORE if there < 2 * LONG else there
                length = found
            ahead = length < left
            recording = recording.window(
                slice(0, length + ahead), None if a > e.first or ahead else recording.starts,
                recording.names,
            )  # fmt: skip
            stretch = Stretch(recording, a, e.record, begun=a > e.first, ahead=ahead)
            yield ReadStretch(
                stretch,
                table.slice(0, length) if self.keep_table else None,
                None if model is None else model[:length],
            )
            rows.take(length)
            a += length

    def _take(
        self, table: pa.Table, e: Extent, first: int
    ) -> tuple[Recording, pa.Table, Array | None]:
        """The next samples, checked; `first` of them, of records that begin in an extent."""
        say: Report = _unheard if self._told else self.say
        place, plan = self._place(first), self.plan
        table = in_contract_names(table, plan, say)
        narrow = table.schema.field("t").type == pa.float32()
        channels, table = take_channels(table, plan, place, keep_table=self.keep_table)
        names = self.outline.names[e.record : e.behind]
        starts = self.outline.starts[e.record : e.behind + 1] - e.first
        if table.num_rows < e.samples and len(names) == 1:
            starts = np.array([0, len(channels["t"])], dtype=np.intp)
        t, x = channels["t"], channels["x"]
        known = names if self.outline.named else None
        check_growth(t, starts, known, place, source=plan["t"][0], narrow=narrow)
        if not self._told and (remark := remark_on_time(t, starts)):
            say(remark)
        if "duty" not in channels:
            say("no column duty; taken as 0 (no control)")
        self._told = True
        note = "measured"
        if "xdot" not in channels:
            from erdctl.bench.differentiation import derive_xdot

            channels["xdot"], note = derive_xdot(
                t, x, starts, file=place.file, row_of=place.row_of, notes=self._notes
            )
            self.xdot_note = note
        if self.keep_table:
            table = with_own_label(table, self.source, plan, starts, names)
        recording = Recording(
            t=t,
            x=x,
            xdot=channels["xdot"],
            duty=channels["duty"] if "duty" in channels else np.zeros_like(t),
            force=channels.get("force"),
            temperature=channels.get("temperature"),
            starts=starts,
            names=names,
            xdot_note=note,
        )
        return recording, table, channels.get("force_model")

    def _finish(self, blocks: Sequence[tuple[int, list[tuple[int, int]]]], seen: Gathered) -> None:
        if "xdot" not in self.plan:
            self.say(f"no column xdot; {self.xdot_note}")
        own = {str(n): self.plan[n][0] for n in ("t", "x", "xdot") if n in self.plan}
        gathered = iter(seen.blocks())
        for first, parts in blocks:
            records = [next(gathered) for _ in parts]
            channels = [(r.t, r.x, r.xdot) for r in records]
            check_blocks(channels, first, self._place(0), sources=own)

    def _warn(self, e: Extent, cuts: bool) -> None:
        if cuts or e.behind > e.record + 1 or e.samples <= LONG + LONG // 2:
            return
        why = "this model remembers more than the yield force from sample to sample"
        if "xdot" not in self.plan:
            why = "xdot is to be derived from x"
        self.say(
            f"record '{self.outline.names[e.record]}' has {e.samples} samples and is taken into"
            f" memory as a whole, since {why}"
        )

    def _place(self, first: int) -> Place:
        return place_behind(self.source.name, first)


def _unheard(line: str) -> None:
    """For what was said already."""


def open_long(
    paths: Sequence[str],
    *,
    maps: Sequence[str] = (),
    where: Sequence[str] = (),
    need_force: bool,
    want_force: bool = False,
    keep_table: bool = False,
    want_hash: bool = False,
    least: int = 0,
    project: ProjectReading | None = None,
    report: Report,
    progress: Progress = lambda stage, what: None,
) -> LongLog | None:
    """A log that is to be read in stretches; None for one that `read_logs` reads as well.

    That is a file in Parquet or Arrow of very many rows (`long_source`), all of which are wanted,
    and no column of which says what the log is of.
    least : rows, of which it has more.  Else arguments and errors are those of `read_logs`.
    """
    source = long_source(paths)
    if source is None or (source.rows or 0) <= least:
        return None
    mappings, wheres = parse_maps(maps), parse_where(where)
    said: list[str] = []

    def say(line: str) -> None:
        report(f"{source.name}: {line}")

    needed = ["t", "x", "force"] if need_force else ["t", "x"]
    labels = {}
    if project is not None:
        if {*project.project.content.labels.columns.values()} & {*source.columns}:
            return None
        told = project.of_log(source, mappings, wheres, needed=needed, say=said.append)
        mappings, wheres, labels = told.mappings, told.where, told.labels.texts()
    plan = plan_columns(
        source,
        mappings,
        needed=needed,
        left=() if want_force or need_force else FORCES,
        say=said.append,
    )
    assert source.schema is not None
    if pa.types.is_temporal(source.schema.field(plan["t"][0]).type):
        return None
    choosing = needed_columns(source.columns, wheres, source.name)
    found = outline(source, plan, choosing, wheres, stem(source.path), said.append)
    if found is None:
        return None
    for line in said:
        say(line)
    return LongLog(source, plan, found, keep_table, want_hash, say, progress, labels)
