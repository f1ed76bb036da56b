"""`erdctl.diagnose`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from erdctl.core.errors import UsageProblem
from erdctl.core.workers import one_thread
from erdctl.diagnose.corrected import parameters as corrected
from erdctl.diagnose.diagnosis import Diagnosis
from erdctl.diagnose.diagnosis import diagnose as diagnosed
from erdctl.diagnose.jobs import worthwhile
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.diagnose.record_effects import Varying
from erdctl.diagnose.thresholds import MOST_EFFECTS
from erdctl.effects import candidates
from erdctl.interface.arguments import ParametersLike, given_parameters
from erdctl.interface.display import draw, frame_of, html, option, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of, texts
from erdctl.io import documents
from erdctl.io.diagnosis import to_json
from erdctl.model.parameters import Parameters
from erdctl.report.subjects import of_diagnosis

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

TABLES = ("findings", "scores", "mismatch", "untestable", "undetected")
UNDETECTED = ("effect", "parameter", "size", "unit", "force_rms", "beyond_rms", "reason")
FINDINGS = (
    "effect", "parameter", "value", "stderr", "unit", "equivalent", "gain_unseen",
    "nrmse_before", "nrmse_after",
)  # fmt: skip
MISMATCH = ("variable", "low", "high", "unit", "share", "text")
SI = {
    "xdot": "m/s", "x": "m", "duty": "1", "t": "s", "since_reversal": "s", "since_duty_step": "s",
    "dissipated_energy": "J", "record": "",
}  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosed:
    """Where a model fails and what was left out of it; what `erdctl.diagnose` gives.

    document : see `to_dict`;  found : as the rest of erdctl takes it;  log : that was diagnosed
    """

    document: Mapping[str, Any]
    found: Diagnosis
    log: BenchLog

    @property
    def verdict(self) -> str:
        """adequate: the model reaches the noise; explained: findings, and the rest is noise;
        unexplained: a misfit remains that no effect of the catalogue explains."""
        return str(self.document["verdict"])

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects that were found, the one that explains most first."""
        return tuple(f["effect"] for f in self.document["findings"])

    @property
    def parameters(self) -> Parameters:
        """Of the corrected model; values by full name in `.values`, e.g. "input_delay.tau" [s]."""
        return corrected(self.found)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was assumed of the log when it was read, and what is wrong with it."""
        return (*self.log.remarks, *self.found.rig.lines())

    def to_dict(self) -> dict[str, Any]:
        """The document of `erdctl diagnose`, "schema": "erdctl.diagnosis/1"."""
        found: dict[str, Any] = documents.plain(self.document)
        return found

    def table(
        self,
        of: Literal["findings", "scores", "mismatch", "untestable", "undetected"] = "findings",
    ) -> pd.DataFrame:
        """What was found.

        of : "findings" has a row for each parameter of each effect found: value, standard error, SI
            unit, look-alikes, NRMSE [1] on data that the fit had not seen without and with it;
            "scores" NRMSE [1] per duty [1], before and after; "mismatch" where the misfit lives, in
            SI; "untestable" effects that the log cannot show, and why; "undetected" effects that
            were not named: from which size the log would have shown each, and the force it makes
        """
        option(of, TABLES, "of")
        d = self.document
        if of == "scores":
            return self._scores()
        if of == "mismatch":
            rows = [
                {**m["where"], "unit": SI.get(m["where"]["variable"], ""), "share": m["share"],
                 "text": m["text"]}
                for m in d["mismatch"]
            ]  # fmt: skip
            return frame_of(rows, MISMATCH)
        if of == "untestable":
            lacking = [{"effect": k, "reason": v} for k, v in d["not_testable"].items()]
            return frame_of(lacking, ("effect", "reason"))
        if of == "undetected":
            rows = [{k: u[k] for k in UNDETECTED} for u in d["undetected"]]
            return frame_of(rows, UNDETECTED)
        findings = [
            {
                "effect": f["effect"], "parameter": symbol, "value": v["value"],
                "stderr": v["stderr"], "unit": v["unit"], "equivalent": ", ".join(f["equivalent"]),
                "gain_unseen": f["evidence"]["gain_unseen"], **f["heldout"],
            }
            for f in d["findings"]
            for symbol, v in f["parameters"].items()
        ]  # fmt: skip
        return frame_of(findings, FINDINGS)

    def _scores(self) -> pd.DataFrame:
        models = [m for m in ("baseline", "refitted", "corrected") if m in self.document]
        rows = []
        for i, level in enumerate(self.document["baseline"]["nrmse_by_duty"]):
            at = {f"nrmse {m}": self.document[m]["nrmse_by_duty"][i]["nrmse"] for m in models}
            rows.append({"duty": level["duty"], **at})
        rows.append({"duty": "all", **{f"nrmse {m}": self.document[m]["nrmse"] for m in models}})
        return frame_of(rows, ("duty", *(f"nrmse {m}" for m in models)))

    def plot(
        self,
        kind: str = "before-after",
        *,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure of the model before and after the correction.

        kind : before-after, misfit, loops, time, yield-force, or another of `erdctl plot --help`
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        return draw(of_diagnosis(self.found, self.parameters), kind, records, span)

    def write(self, path: Place) -> None:
        """Write the document as JSON, as `erdctl diagnose -o` does."""
        documents.write(self.document, os.fspath(path))

    def __repr__(self) -> str:
        return text(f"Diagnosed: {self._title()}", [*self._lines(), *self.remarks])

    def _repr_html_(self) -> str:
        return html(self._title(), self.table("scores"), [*self._lines(), *self.remarks])

    def _title(self) -> str:
        before, after = (self.document[m]["nrmse"] for m in ("baseline", "corrected"))
        return f"{self.verdict}, NRMSE {before:.4f}, corrected {after:.4f}"

    def _lines(self) -> list[str]:
        d = self.document
        out = [f"{f['effect']}: {f['text']}" for f in d["findings"]]
        out += [f"where: {m['text']}" for m in d["mismatch"]]
        out += [f"given: {d['as_fault']['text']}"] if "as_fault" in d else []
        return [*out, f"remains: {d['remaining']['text']}"]


def diagnose(
    log: LogLike,
    *,
    parameters: ParametersLike | None = None,
    effects: Sequence[str] | str | None = None,
    exclude: Sequence[str] | str | None = None,
    record_gains: bool = False,
    record_offsets: bool = False,
    accept: Sequence[str] = (),
    max_effects: int = MOST_EFFECTS,
    seed: int = 0,
    jobs: int | None = None,
    date: str | None = None,
    damper: str | None = None,
    operator: str | None = None,
    progress: Callable[[str, str], None] | None = None,
) -> Diagnosed:
    """Locate a mismatch between log and model, name the physics left out, show the fit improve.

    log : what `erdctl.read` gave, or anything that `read` takes; with a measured force
    parameters : of the model to answer for, in place of the paper's fitted to this log: a result of
        `identify` or `diagnose`, the path of a parameter file, or its dict
    effects, exclude : names of effects to test only, or not to test; see `erdctl.effects`
    record_gains, record_offsets : a free gain [1], or zero [N], of the force for each record
    accept : codes of rig checks whose findings are right as they are, see `inspect`
    max_effects : name at most so many;  seed : of the regression that looks at what remains
    jobs : worker processes; the result is the same for any number. By default all cores where that
        is worth it, and 1 in a script, since workers import the script again: give a number there
        only below `if __name__ == "__main__":`
    date, damper, operator : of the test, for provenance; a date as ISO 8601
    progress : called with (stage, what) as the work goes on

    Returns a Diagnosed: `.verdict` adequate, explained or unexplained; `.effects` names; `.table()`
    the parameters found, `.table("scores")` NRMSE before and after; `.to_dict()` and `.write(path)`
    the document of `erdctl diagnose`; `.plot()`, also "misfit". It goes as it is into simulate,
    validate and mimic, as its corrected parameters. Takes seconds to minutes.

    Raises InputProblem for a log too short or too still, UsageProblem for an unknown effect.

    Example:
        found = erdctl.diagnose("bench.parquet")
        found.verdict, found.effects
    """
    if not 1 <= max_effects <= MOST_EFFECTS:
        raise UsageProblem(f"max_effects is 1 to {MOST_EFFECTS}, not {max_effects}")
    tested = candidates(texts(effects), texts(exclude))
    given = None if parameters is None else given_parameters(parameters)
    read = log_of(log, need_force=True).labelled(date, damper, operator)
    with one_thread():
        run = partial(
            diagnosed, candidates=tested, most=max_effects, seed=seed,
            given=None if given is None else given.parameters,
            free=Varying(gain=record_gains, offset=record_offsets), accepted=accept,
            jobs=jobs or (1 if _in_script() else worthwhile(read.recording, tested)),
            progress=progress or (lambda stage, what: None),
        )  # fmt: skip
        found = with_a_fault_once(run, read.recording)
    file = None if given is None else {"name": given.name, "sha256": given.sha256}
    return Diagnosed(to_json(found, file), found, read)


def _in_script() -> bool:
    """Whether workers would run the user's program again, as they do for one that is a file."""
    return getattr(sys.modules.get("__main__"), "__file__", None) is not None
