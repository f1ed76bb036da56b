"""`erdctl.simulate`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from erdctl.bench.drive import drives
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array
from erdctl.export.as_block import as_block
from erdctl.interface.arguments import ParametersLike, given_parameters
from erdctl.interface.display import draw, frame_of, html, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of, samples, texts, with_force
from erdctl.io.logs import Log
from erdctl.io.tables import write_table
from erdctl.model.parameters import Parameters
from erdctl.model.simulate import Remarks
from erdctl.model.simulate import simulate as simulated
from erdctl.report.subject import Subject
from erdctl.report.subjects import about, of_faults

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Simulated:
    """The force of a damper over a log; what `erdctl.simulate` gives. It is a log again.

    parameters : that were simulated;  log : with the modelled force;  faults : of the damper
    remarks : what was assumed of the log, and where the simulation goes beyond what was identified
    """

    parameters: Parameters
    log: BenchLog
    faults: tuple[str, ...]
    remarks: tuple[str, ...]

    def as_log(self) -> BenchLog:
        """The log with the modelled force, for `validate`."""
        return self.log

    @property
    def force(self) -> Array:
        """(n,) modelled force [N]."""
        force = self.log.log.force_model
        assert force is not None
        return force

    def to_dict(self) -> dict[str, list[Any]]:
        """The columns of the table that `erdctl simulate` writes, by name."""
        found: dict[str, list[Any]] = self.table().to_dict(orient="list")
        return found

    def table(self) -> pd.DataFrame:
        """One row a sample: the log's columns, in SI, and `force_model` [N]."""
        return samples(self.log.arrow())

    def plot(
        self,
        kind: str | None = None,
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure: with faults healthy against faulty, else loops.

        kind : loops, time, motion, faults, static, or another of `erdctl plot --help`
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        r = self.log.recording
        faults = [*self.faults]
        subject = Subject(
            recording=r, modelled=self.force, parameters=self.parameters,
            cases=of_faults(self.parameters, r, faults) if faults else {}, about=about(r),
        )  # fmt: skip
        return draw(subject, kind or ("faults" if faults else "loops"), records, span, locate=True)

    def write(self, path: Place) -> None:
        """Write the table, as `erdctl simulate -o` does; the suffix says the format."""
        write_table(self.log.arrow(), os.fspath(path))

    def __repr__(self) -> str:
        return text(f"Simulated: {self._title()}", self.remarks)

    def _repr_html_(self) -> str:
        r = self.log.recording
        ends = zip(r.names, r.slices, strict=True)
        rows = [
            {"record": n, "lowest [N]": self.force[s].min(), "highest [N]": self.force[s].max()}
            for n, s in ends
        ]
        frame = frame_of(rows, ("record", "lowest [N]", "highest [N]"))
        return html(self._title(), frame, self.remarks)

    def _title(self) -> str:
        low, high = float(np.min(self.force)), float(np.max(self.force))
        faults = f", with {', '.join(self.faults)}" if self.faults else ""
        return f"{about(self.log.recording)}, {low:.4g} to {high:.4g} N{faults}"


def simulate(
    parameters: ParametersLike,
    log: LogLike | None = None,
    *,
    faults: Sequence[str] | str = (),
    drive: Sequence[str] | str = (),
    causal: bool = False,
) -> Simulated:
    """Simulate the force of a damper over a log or a described drive, healthy or with faults.

    parameters : a result of `identify` or `diagnose`, the path of a parameter file, or its dict
    log : motion and duty: what `erdctl.read` gave, or anything that `read` takes
    faults : "KIND=FACTOR@START:END" in seconds of the record's own time, KIND oil, electrical or
        deformation, FACTOR 1 for healthy, e.g. ["oil=0.5@15:31", "electrical=0.8"]
    drive : in place of a log, e.g. "sine:freq=1,amp=0.01,duty=0.2" (Hz, m, 1); of several, one
        record each; see `erdctl simulate --help`
    causal : as the block has it that `erdctl export` writes (C, FMU): effects of the bench are
        left out. What is known at a sample is of the past alone with and without

    Returns a Simulated: `.force` (n,) [N], `.table()` the log's columns and force_model, `.plot()`,
    `.write(path)`. `.remarks` says where it goes beyond what the parameters were identified on.

    Raises InputProblem for a bad log or parameter file, UsageProblem for a fault or drive that
    makes no sense.

    Example:
        faulty = erdctl.simulate("damper.json", "drive.csv", faults=["oil=0.5@15:31"])
        faulty.table()["force_model"]
    """
    wanted, described = texts(faults), texts(drive)
    if (log is None) == (not described):
        raise UsageProblem("simulate needs either a log or a drive, e.g. drive='sine:freq=1'")
    found = given_parameters(parameters).parameters
    found, told = as_block(found) if causal else (found, [])
    given = (
        BenchLog(Log(drives(described)))
        if log is None
        else log_of(log, want_force=True, keep_table=True)
    )
    remarks = Remarks(found, wanted)
    remarks.add(given.recording)
    said = (*given.remarks, *told, *remarks.lines(), *remarks.of_faults())
    force = simulated(found, given.recording, wanted)
    return Simulated(found, with_force(given, force), tuple(wanted), said)
