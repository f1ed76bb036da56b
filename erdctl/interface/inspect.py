"""`erdctl.inspect`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from erdctl.bench.inspection import Inspection
from erdctl.bench.inspection import inspect as inspected
from erdctl.core.messages import counted
from erdctl.effects import catalogue
from erdctl.interface.display import frame_of, html, option, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of
from erdctl.io import documents
from erdctl.io.inspection import subject_of, to_json

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

TABLES = ("coverage", "records", "channels", "duty")
COVERAGE = ("kind", "name", "identifiable", "reason", "drive")


@dataclass(frozen=True, eq=False, repr=False)
class Inspected:
    """What a log holds, and what it can show; what `erdctl.inspect` gives."""

    found: Inspection
    log: BenchLog

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was assumed of the log when it was read, and what is wrong with it."""
        return (*self.log.remarks, *self.found.rig.lines())

    def to_dict(self) -> dict[str, Any]:
        """The document of `erdctl inspect --json`, "schema": "erdctl.inspection/1"."""
        found: dict[str, Any] = documents.plain(to_json(self.found, subject_of(self.log.log)))
        return found

    def table(
        self, of: Literal["coverage", "records", "channels", "duty"] = "coverage"
    ) -> pd.DataFrame:
        """What can be identified, or what is in the log.

        of : "coverage" has a row for each parameter and effect: whether the log identifies it,
            else why not and a drive that would show it; "records" sampling, stroke [m], speed
            [m/s], force [N]; "channels" columns and their conversion to SI; "duty" time [s] at each
            level [1]
        """
        option(of, TABLES, "of")
        document = self.to_dict()
        if of == "channels":
            rows = [
                {**c, "low": (c["range"] or [None])[0], "high": (c["range"] or [None])[-1]}
                for c in document["channels"]
            ]
            columns = ("name", "column", "factor", "offset", "low", "high", "unit")
            return frame_of(rows, columns)
        if of == "duty":
            levels = [
                {"duty": d["duty"], "time [s]": d["seconds"]} for d in document["duty_levels"]
            ]
            return frame_of(levels, ("duty", "time [s]"))
        if of == "records":
            records = [_record(r) for r in document["records"]]
            return frame_of(records, tuple(_record(document["records"][0])))
        covers = [
            {
                "kind": kind, "name": c["name"], "identifiable": c["identifiable"],
                "reason": c["reason"],
                "drive": None if c["identifiable"] else "; ".join(c["drives"]),
            }
            for kind, listed in (("parameter", "parameters"), ("effect", "effects"))
            for c in document[listed]
        ]  # fmt: skip
        return frame_of(covers, COVERAGE)

    def plot(
        self,
        kind: str | None = None,
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure of the log; see the same of what `erdctl.read` gives."""
        return self.log.plot(kind, records=records, span=span)

    def write(self, path: Place) -> None:
        """Write the document as JSON, as `erdctl inspect --json` prints it."""
        documents.write(to_json(self.found, subject_of(self.log.log)), os.fspath(path))

    def __repr__(self) -> str:
        return text(f"Inspected: {self._title()}", [*self._lines(), *self.remarks])

    def _repr_html_(self) -> str:
        return html(self._title(), self.table("records"), [*self._lines(), *self.remarks])

    def _title(self) -> str:
        records = counted(len(self.found.records), "record")
        return f"{counted(self.found.samples, 'sample')}, {self.found.duration:.6g} s in {records}"

    def _lines(self) -> list[str]:
        noise, out = self.found.noise, []
        if noise is not None:
            out.append(f"force noise about {noise.rms:.2g} N rms, a guess before any fit")
        for what, covers in (
            ("parameters", self.found.parameters),
            ("effects", self.found.effects),
        ):
            able = [c for c in covers if c.lack is None]
            out.append(f"{len(able)} of {len(covers)} {what} can be identified")
            out += [f"not {c.name}: {c.lack.reason}" for c in covers if c.lack is not None]
        return out


def _record(r: dict[str, Any]) -> dict[str, Any]:
    force, hottest = r["force"] or [None, None], (r["temperature"] or [None])[-1]
    return {
        "record": r["name"], "samples": r["samples"], "duration [s]": r["duration"],
        "rate [Hz]": r["rate"], "gaps": r["gaps"], "stroke [m]": r["x"][1] - r["x"][0],
        "speed [m/s]": r["speed"], "duty low": r["duty"][0], "duty high": r["duty"][1],
        "force low [N]": force[0], "force high [N]": force[1], "hottest [degC]": hottest,
    }  # fmt: skip


def inspect(
    log: LogLike,
    *,
    date: str | None = None,
    damper: str | None = None,
    operator: str | None = None,
) -> Inspected:
    """Say what is in a log, and what it can and cannot show, before anything is fitted.

    log : what `erdctl.read` gave, or anything that `read` takes; a force is not needed
    date, damper, operator : of the test, for provenance; a date as ISO 8601

    Returns an Inspected: `.table()` has a row for each parameter of the paper's model and each
    effect of the catalogue, whether the log identifies it, else the reason and a drive that would
    show it; `.table("records")`, `.table("channels")` and `.table("duty")` say what is in the log;
    `.to_dict()` is the document of `erdctl inspect --json`. identify and diagnose decide by the
    same rules.

    Raises InputProblem for a bad log, UsageProblem for one that is not there.

    Example:
        erdctl.inspect("bench.csv").table().query("not identifiable")
    """
    given = log_of(log, want_force=True).labelled(date, damper, operator)
    return Inspected(inspected(given.recording, catalogue()), given)
