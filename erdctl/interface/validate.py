"""`erdctl.validate`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from erdctl.bench.rig import Rig, look
from erdctl.bench.unknown_direction import UnknownDirection, unknown_direction
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.interface.arguments import ParametersLike, given_parameters
from erdctl.interface.display import draw, frame_of, html, option, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of
from erdctl.io import documents
from erdctl.io.validation import to_json
from erdctl.model.parameters import Parameters
from erdctl.model.simulate import remarks, simulate
from erdctl.report.subject import Subject
from erdctl.report.subjects import about
from erdctl.score.nrmse import Normalise, Validation
from erdctl.score.nrmse import validate as scores_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Validated:
    """How well a model reproduces a log; what `erdctl.validate` gives.

    scores : NRMSE [1], rms [N] and samples, overall and by duty, direction and record
    log : that it was held against;  modelled : (n,) [N];  parameters : None if the log had the
        modelled force;  remarks : what was assumed;  rig : what is wrong with the log
    """

    scores: Validation
    log: BenchLog
    modelled: Array
    parameters: Parameters | None
    remarks: tuple[str, ...]
    rig: Rig

    @property
    def unknown(self) -> UnknownDirection | None:
        """What lies where the rod rests or turns, if most of the squared error does."""
        r = self.log.recording
        assert r.force is not None
        return unknown_direction(Signals.of(r), r.force - self.modelled)

    @property
    def nrmse(self) -> float:
        """NRMSE over all samples [1]."""
        return self.scores.overall.nrmse

    def to_dict(self) -> dict[str, Any]:
        """The document of `erdctl validate --json`, "schema": "erdctl.validation/1"."""
        found: dict[str, Any] = documents.plain(self._document())
        return found

    def _document(self) -> dict[str, Any]:
        labels, rig = self.log.recording.labels, self.rig.to_json()
        return to_json(self.scores, labels, rig, self.unknown)

    def table(self) -> pd.DataFrame:
        """One row a group of samples: by (all, duty, direction, record), group, samples, rms [N]
        and nrmse [1]."""
        v = self.scores
        groups = [
            *(("duty", level, s) for level, s in v.by_duty.items()), ("all", "all", v.overall),
            *(("direction", name, s) for name, s in v.by_direction.items()),
            *(("record", name, s) for name, s in v.by_record.items()),
        ]  # fmt: skip
        rows = [
            {"by": by, "group": group, "samples": s.samples, "rms [N]": s.rms, "nrmse": s.nrmse}
            for by, group, s in groups
        ]
        return frame_of(rows, ("by", "group", "samples", "rms [N]", "nrmse"))

    def plot(
        self,
        kind: str = "loops",
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure of measured and modelled force.

        kind : loops, time, misfit, static, or another of `erdctl plot --help`
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        r = self.log.recording
        subject = Subject(
            recording=r, modelled=self.modelled, parameters=self.parameters, about=about(r)
        )
        return draw(subject, kind, records, span, locate=True)

    def write(self, path: Place) -> None:
        """Write the document as JSON, as `erdctl validate --json` prints it."""
        documents.write(self._document(), os.fspath(path))

    def __repr__(self) -> str:
        rows = [f"{100 * d:3g} %  {s.nrmse:.4f}" for d, s in self.scores.by_duty.items()]
        return text(f"Validated: {self._title()}", [*rows, *self.remarks])

    def _repr_html_(self) -> str:
        return html(self._title(), self.table(), self.remarks)

    def _title(self) -> str:
        s, over = self.scores.overall, self.scores.normalise.words
        return f"NRMSE {s.nrmse:.4f} over the {over} of the force, {s.rms:.4g} N rms"


def validate(
    parameters: ParametersLike | None,
    log: LogLike,
    *,
    normalise: Literal["range", "std", "mean", "rms"] = "range",
    date: str | None = None,
    damper: str | None = None,
    operator: str | None = None,
) -> Validated:
    """Compare a model with a measured force: NRMSE per PWM level, direction and record.

    parameters : a result of `identify` or `diagnose`, the path of a parameter file, or its dict;
        None for a log that has the modelled force already, as `simulate` gives it
    log : what `erdctl.read` or `erdctl.simulate` gave, or anything that `read` takes
    normalise : what the error is divided by, of the measured force of the group; "range" is
        highest less lowest
    date, damper, operator : of the test, for provenance; a date as ISO 8601

    Returns a Validated: `.nrmse` [1], `.table()` one row a group, `.to_dict()` the document of
    `erdctl validate --json`, `.plot()`.

    Raises InputProblem for a log without a force, or without a model of it.

    Example:
        erdctl.validate(damper, "other.csv").table()
        erdctl.validate(None, erdctl.simulate(damper, "other.csv"))
    """
    over = Normalise(option(normalise, list(Normalise), "normalise"))
    found = None if parameters is None else given_parameters(parameters).parameters
    given = log_of(log, need_force=True).labelled(date, damper, operator)
    r, modelled, said = given.recording, given.log.force_model, given.remarks
    if found is not None:
        modelled, said = simulate(found, r), (*said, *remarks(found, r))
    if modelled is None:
        raise InputProblem(
            "the log has no column force_model; give parameters before it",
            file=r.sources[0].name if r.sources else None,
        )
    rig = look(r, modelled)
    said = (*said, *rig.lines())
    return Validated(scores_of(r, modelled, over), given, modelled, found, said, rig)
