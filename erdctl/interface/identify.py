"""`erdctl.identify`."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from erdctl.bench.rig import look
from erdctl.core.workers import one_thread
from erdctl.estimate.identify import identify as identified
from erdctl.estimate.method import Method
from erdctl.interface.display import draw, frame_of, html, option, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of
from erdctl.io import documents
from erdctl.io.identification import parameters_of, residual_of
from erdctl.io.parameters import to_document
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import simulate
from erdctl.report.readable import error_of
from erdctl.report.subject import Subject
from erdctl.report.subjects import about

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

COLUMNS = ("parameter", "value", "stderr", "unit", "two_step", "assumed", "reason")


@dataclass(frozen=True, eq=False, repr=False)
class Identified:
    """Parameters of a damper and how they were found; what `erdctl.identify` gives.

    parameters : values by full name in `.values`, e.g. "compression.T_d" [s]
    log : that they were identified from;  rig : what is wrong with it, a line each
    """

    parameters: Parameters
    log: BenchLog
    rig: tuple[str, ...] = ()

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was assumed of the log, parameters without a value, and warnings of the fit."""
        p = self.parameters
        return (*self.log.remarks, *self.rig, *p.caveats(), *p.warnings)

    def to_dict(self) -> dict[str, Any]:
        """The parameter file, "schema": "erdctl.parameters/1"."""
        found: dict[str, Any] = documents.plain(to_document(self.parameters))
        return found

    def table(self) -> pd.DataFrame:
        """One row a parameter: value, standard error, SI unit, value by the paper's two steps.

        A parameter that the log does not identify has no value but a reason, and in `assumed` what
        a simulation takes.
        """
        steps = self.parameters.fits["two_step"]["values"]
        rows = [
            {
                "parameter": name, "value": e.value, "stderr": e.stderr, "unit": e.unit,
                "two_step": steps.get(name), "assumed": e.assumed,
                "reason": _bound(e) if e.at_bound else e.reason,
            }
            for name, e in self.parameters.estimates.items()
        ]  # fmt: skip
        return frame_of(rows, COLUMNS).astype(
            {"value": float, "stderr": float, "two_step": float, "assumed": float}
        )

    def plot(
        self,
        kind: str = "loops",
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure of the log and the model over it.

        kind : loops, yield-force, static, time, misfit, or another of `erdctl plot --help`
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        r = self.log.recording
        subject = Subject(
            recording=r, modelled=simulate(self.parameters, r), parameters=self.parameters,
            about=about(r),
        )  # fmt: skip
        return draw(subject, kind, records, span, locate=True)

    def write(self, path: Place) -> None:
        """Write the parameter file, as `erdctl identify -o` does."""
        documents.write(to_document(self.parameters), os.fspath(path))

    def __repr__(self) -> str:
        rows = [
            f"{name:18} {'not identified' if e.value is None else f'{e.value:.5g}'}"
            + ("" if e.stderr is None else f" +- {e.stderr:.2g}")
            + f" {e.unit}".removesuffix(" 1")
            + (f" ({_bound(e)})" if e.at_bound else "")
            for name, e in self.parameters.estimates.items()
        ]
        return text(f"Identified: {self._title()}", [*rows, *self.remarks])

    def _repr_html_(self) -> str:
        shown = self.table().dropna(axis="columns", how="all")
        return html(self._title(), shown, self.remarks)

    def _title(self) -> str:
        return residual_of(self.parameters.fits)


def _bound(e: Estimate) -> str:
    """That a value lies at its bound, and the side that is left, in SI."""
    return error_of(None, at_bound=True, value=e.value, within=e.within)


def identify(
    log: LogLike,
    *,
    method: Literal["joint", "two-step"] = "joint",
    robust: bool = False,
    accept: Sequence[str] = (),
    date: str | None = None,
    damper: str | None = None,
    operator: str | None = None,
    progress: Callable[[str, str], None] | None = None,
) -> Identified:
    """Identify the paper's damper model from a bench log, with standard errors.

    log : what `erdctl.read` gave, or anything that `read` takes; with a measured force
    method : "joint" fits all parameters together, "two-step" as the paper does
    robust : weigh outliers down
    accept : codes of rig checks whose findings are right as they are, see `inspect`
    date, damper, operator : of the test, for provenance; a date as ISO 8601
    progress : called with (stage, what) as the work goes on

    Returns an Identified: `.table()` parameters, errors and SI units; `.parameters.values` numbers
    by name; `.to_dict()` and `.write(path)` the parameter file of `erdctl identify`; `.plot()`,
    also "yield-force". It goes as it is into simulate, validate, diagnose and mimic. What the log
    does not identify has no value but a reason, see `.remarks`.

    Raises InputProblem if the log identifies nothing at all, or is wrong as a whole.

    Example:
        damper = erdctl.identify("bench.parquet")
        damper.write("damper.json")
    """
    chosen = Method(option(method, list(Method), "method"))
    given = log_of(log, need_force=True).labelled(date, damper, operator)
    rig = look(given.recording).accept(accept)
    rig.refuse()
    recording = rig.usable()
    with one_thread():
        found = identified(
            recording, robust=robust, progress=progress or (lambda stage, what: None)
        )
    parameters = parameters_of(found, chosen, recording, rig.to_json())
    return Identified(parameters, given, tuple(rig.lines()))
