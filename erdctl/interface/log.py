"""`erdctl.read`: bench logs in memory, and what other functions take for a log."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
import pyarrow as pa

from erdctl.bench.inspection import inspect
from erdctl.core.errors import InputProblem
from erdctl.core.labels import labels_of
from erdctl.core.messages import counted
from erdctl.core.recording import Recording
from erdctl.effects import catalogue
from erdctl.interface.display import draw, frame_of, html, text
from erdctl.io import documents
from erdctl.io.csv_out import typed
from erdctl.io.inspection import subject_of, to_json
from erdctl.io.logs import Log, read_logs
from erdctl.io.stored import PLAIN, si
from erdctl.io.tables import append_column, table_of, write_table
from erdctl.io.text.options import TextSpec
from erdctl.io.units import UNITS, listed
from erdctl.report.subject import Subject
from erdctl.report.subjects import PROGRAMME, about, programme

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from erdctl.io.project.reading import ProjectReading

FRAME = "DataFrame"  # what messages and records call a log that is one


@runtime_checkable
class Frame(Protocol):
    """A pandas DataFrame, as far as it is needed."""

    @property
    def columns(self) -> Any: ...
    @property
    def index(self) -> Any: ...
    def reset_index(self) -> Any: ...


@runtime_checkable
class IsLog(Protocol):
    """A result that is a log again: of `read`, and of `simulate`."""

    def as_log(self) -> BenchLog: ...


Place: TypeAlias = str | os.PathLike[str]
Logs: TypeAlias = Place | Frame | Sequence[Place | Frame]
Maps: TypeAlias = Mapping[str, str] | Sequence[str] | str | None
LogLike: TypeAlias = IsLog | Logs


@dataclass(frozen=True, eq=False, repr=False)
class BenchLog:
    """One or more bench logs, read and checked; what `erdctl.read` gives.

    log : as the rest of erdctl takes it;  remarks : what was assumed, converted or derived
    """

    log: Log
    remarks: tuple[str, ...] = ()

    @property
    def recording(self) -> Recording:
        """Channels as arrays (n,) in SI: t, x, xdot, duty, force; offsets and names of records."""
        return self.log.recording

    def as_log(self) -> BenchLog:
        """Itself: where a log is wanted, a result that is one may stand."""
        return self

    def __len__(self) -> int:
        return len(self.recording)

    def labelled(
        self, date: str | None = None, damper: str | None = None, operator: str | None = None
    ) -> BenchLog:
        """The log with date (ISO 8601), damper and operator of the test, for provenance."""
        labels = labels_of(date, damper, operator)
        if not labels:
            return self
        recording = replace(self.recording, labels={**self.recording.labels, **labels})
        return replace(self, log=replace(self.log, recording=recording))

    def to_dict(self) -> dict[str, Any]:
        """What the log holds and can show: the document of `erdctl.inspect`."""
        found = inspect(self.recording, catalogue())
        document: dict[str, Any] = documents.plain(to_json(found, subject_of(self.log)))
        return document

    def table(self) -> pd.DataFrame:
        """One row a sample: t [s], x [m], xdot [m/s], duty [1], force [N], record, and the rest.

        Columns have erdctl's names and are SI; `attrs["units"]` says so again. Of a single log all
        columns, of several those that erdctl knows. An xdot or duty that the log lacks is added.
        """
        table = self.arrow()
        for name in ("xdot", "duty"):
            if name not in table.column_names:
                table = append_column(table, name, getattr(self.recording, name))
        return samples(table)

    def arrow(self) -> pa.Table:
        """The log's own columns as an Arrow table, those that erdctl knows in SI."""
        if self.log.table is not None:
            return self.log.table
        table, modelled = table_of(self.recording), self.log.force_model
        return table if modelled is None else append_column(table, "force_model", modelled)

    def plot(
        self,
        kind: str | None = None,
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure: loops, or the motion of a log without a force.

        kind : loops, motion, peak-force, average, slow, or another of `erdctl plot --help`
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        r, modelled = self.recording, self.log.force_model
        bare = r.force is None and modelled is None
        subject = Subject(
            recording=r, modelled=modelled, programme=programme(self.log.others), about=about(r)
        )
        return draw(subject, kind or ("motion" if bare else "loops"), records, span, locate=True)

    def write(self, path: Place) -> None:
        """Write the samples to a file: CSV, Parquet, Arrow, MAT, MDF4 or TDMS by its suffix."""
        write_table(self.arrow(), os.fspath(path))

    def __repr__(self) -> str:
        ranges = [
            f"{row['channel']:12} {row['lowest']:.6g} to {row['highest']:.6g}"
            + (f" {row['unit']}" if row["unit"] != PLAIN else "")
            for row in self._ranges()
        ]
        return text(f"BenchLog: {self._title()}", [*ranges, *self.remarks])

    def _repr_html_(self) -> str:
        columns = ("channel", "lowest", "highest", "unit")
        return html(self._title(), frame_of(self._ranges(), columns), self.remarks)

    def _title(self) -> str:
        r = self.recording
        steps = r.step[r.step > 0]
        rate = f" at {1.0 / float(np.median(steps)):.4g} Hz" if len(steps) else ""
        count = counted(len(r.names), "record")
        names = ", ".join(r.names[:4]) + (", ..." if len(r.names) > 4 else "")
        return f"{about(r)} in {count}{rate} ({names})"

    def _ranges(self) -> list[dict[str, Any]]:
        found = {name: getattr(self.recording, name, None) for name in UNITS}
        found["force_model"] = self.log.force_model
        return [
            {"channel": name, "lowest": v.min(), "highest": v.max(), "unit": si(name)}
            for name, v in found.items()
            if v is not None and len(v)
        ]


def read(paths: Logs, *, map: Maps = None, text: TextSpec = None, where: Maps = None) -> BenchLog:
    """Read and check one or more bench logs.

    paths : a path, a pandas DataFrame, or a list of them. Files are CSV or another lab's text,
        Parquet, Arrow, MAT, MDF4 or TDMS, as the command line reads them. Needed are time t [s]
        and deflection x [m, compression +]; xdot [m/s], duty [0..1], force [N], temperature [degC]
        and record (the name of the test that a sample belongs to) are taken where they are there.
        xdot is derived from x where it is missing, and a missing duty is 0. A named index of a
        frame is a column.
    map : which of the log's own columns is which, and its unit, where that differs:
        {"x": "Defl FL[mm]", "force": "F_fl[kN]"}, or as on the command line ["x=Defl FL[mm]"].
        A minus before the name changes the sign.
    text : how a text log is written, where that is not clear: {"decimal": "comma", "date": "dmy"},
        or as on the command line "decimal=comma,date=dmy"
    where : only these rows, {"damper": "FL"}

    Returns a BenchLog: `.table()` samples in SI as a frame, `.plot()`, `.recording` with arrays,
    `.write(path)` in another format. What was assumed, converted or derived is in `.remarks`, and
    shown with the log; nothing is printed.

    Raises InputProblem (a bad log: file, row, column, what to do) and UsageProblem (no such file, a
    map that makes no sense), both ErdctlError.

    Example:
        log = erdctl.read("lab.csv", map={"t": "Time[ms]", "x": "Defl FL[mm]", "force": "F_fl[N]"})
        log.plot("motion", span=(0, 5))
    """
    return open_log(paths, map=map, text=text, where=where, want_force=True, keep_table=True)


def open_log(
    paths: Logs,
    *,
    map: Maps = None,
    text: TextSpec = None,
    where: Maps = None,
    need_force: bool = False,
    want_force: bool = False,
    keep_table: bool = False,
    project: ProjectReading | None = None,
) -> BenchLog:
    """Logs out of paths and frames; the options are those of `erdctl.io.logs.read_logs`.

    keep_table : of a single log
    """
    given = [*paths] if isinstance(paths, Sequence) and not isinstance(paths, str) else [paths]
    frames = [p for p in given if isinstance(p, Frame)]
    names: list[str] = []
    held: dict[str, bytearray] = {}
    for p in given:
        if isinstance(p, Frame):
            name = FRAME if len(frames) == 1 else f"{FRAME} {len(held) + 1}"
            held[name] = _arrow_file(p, name)
        else:
            name = os.fsdecode(p)
        names.append(name)
    remarks: list[str] = []
    log = read_logs(
        names, maps=maps_of(map), text=text, where=maps_of(where), need_force=need_force,
        want_force=want_force, keep_table=keep_table and len(names) == 1, want_hash=True,
        others=PROGRAMME if want_force else (), held=held, project=project, report=remarks.append,
    )  # fmt: skip
    return BenchLog(log, tuple(remarks))


def log_of(
    log: LogLike, *, need_force: bool = False, want_force: bool = False, keep_table: bool = False
) -> BenchLog:
    """What a function is given as its log, read if it is not yet.

    Raises InputProblem if the force is needed and not there.
    """
    if not isinstance(log, IsLog):
        return open_log(log, need_force=need_force, want_force=want_force, keep_table=keep_table)
    found = log.as_log()
    recording = found.recording
    if need_force and recording.force is None:
        more = f"; the log has {listed(found.log.unread)} besides" if found.log.unread else ""
        raise InputProblem(
            f"no column 'force'{more}; say which it is: read(..., map={{'force': 'NAME[UNIT]'}})",
            file=recording.sources[0].name if recording.sources else None,
            column="force",
        )
    return found


def with_force(given: BenchLog, force: Any) -> BenchLog:
    """The log with a modelled force (n,) [N] as its column `force_model`."""
    table = append_column(given.arrow(), "force_model", force)
    return replace(given, log=replace(given.log, force_model=force, table=table))


def samples(table: pa.Table) -> pd.DataFrame:
    """A table of samples as a frame; contract columns are SI."""
    table = typed(table)
    frame = table.to_pandas()
    forces = ("force_healthy", "force_ideal", "force_expected")
    known = {**{name: si(name) for name in UNITS}, **dict.fromkeys(forces, si("force"))}
    frame.attrs = {"units": {n: u for n, u in known.items() if n in table.column_names}}
    return frame


def maps_of(map: Maps) -> list[str]:
    """Options of `--map`, as text, out of what a user may give."""
    if map is None:
        return []
    if isinstance(map, str):
        return [map]
    return [f"{k}={v}" for k, v in map.items()] if isinstance(map, Mapping) else [*map]


def texts(given: Sequence[str] | str | None) -> list[str]:
    """Names or faults, of which one may stand alone."""
    return [given] if isinstance(given, str) else [*(given or ())]


def _arrow_file(frame: Any, name: str) -> bytearray:
    """A frame as the bytes of an Arrow stream: it is checked, and hashed, like any other log."""
    if any(level is not None for level in frame.index.names):
        frame = frame.reset_index()
    sink = pa.BufferOutputStream()
    try:
        table = pa.Table.from_pandas(frame, preserve_index=False)
        with pa.ipc.new_stream(sink, table.schema) as writer:
            writer.write_table(table)
    except (pa.ArrowException, ValueError, TypeError) as error:
        reason = str(error).splitlines()[0][:200]
        raise InputProblem(f"not a table of numbers and texts ({reason})", file=name) from None
    return bytearray(sink.getvalue())
