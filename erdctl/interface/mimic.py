"""`erdctl.mimic`."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.messages import counted
from erdctl.interface.arguments import Given, ParametersLike, given_parameters
from erdctl.interface.display import draw, frame_of, html, option, text
from erdctl.interface.log import BenchLog, LogLike, Place, log_of, samples, texts
from erdctl.io import documents, pwm
from erdctl.io.temperature import TemperatureGuard, files_of, guarded
from erdctl.mimic.sequence import (
    PwmSequence,
    at_duty,
    held_back,
    idle,
    sequence,
    strain,
    too_hot,
    way_back,
    worth,
)
from erdctl.mimic.trusted import refuse_untrusted
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import Fault, parse_fault
from erdctl.model.simulate import remarks
from erdctl.report.subjects import of_plan

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

REACH = (
    "fault", "damper", "nrmse", "nrmse_paper", "nrmse_plain", "out_of_reach", "missing rms [N]",
    "missing max [N]",
)  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class Mimicked:
    """The PWM sequence that mimics faults, and what it reaches; what `erdctl.mimic` gives.

    sequence : duties of the four amplifiers in `.duties`, by fl, fr, rl, rr, (n,) [1]
    log : motion and healthy duty;  amplifier : its limits;  guard : what held the limit on the
        temperature;  remarks : what was assumed, what the
        effects of a corrected model are worth, and where the amplifier limits the sequence
    """

    sequence: PwmSequence
    log: BenchLog
    given: Given
    faults: tuple[Fault, ...]
    amplifier: Amplifier
    guard: TemperatureGuard
    remarks: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """The manifest that `erdctl mimic` writes, "schema": "erdctl.pwm/1"."""
        found: dict[str, Any] = documents.plain(self._manifest())
        return found

    def table(self, of: Literal["sequence", "reach"] = "sequence") -> pd.DataFrame:
        """The sequence, or how near it comes.

        of : "sequence" has a row for each sample, as `erdctl mimic` writes it: t [s], x [m], the
            duties duty_fl to duty_rr [0..1], forces to expect [N]; "reach" a row for each fault:
            NRMSE [1] against the ideal faulty force, of this sequence and of the paper's inverse,
            out_of_reach part of the time [1], missing force [N]
        """
        option(of, ("sequence", "reach"), "of")
        if of == "sequence":
            return samples(pwm.table(self.sequence, self.log.arrow()))
        rows = [
            {
                "fault": e["fault"], "damper": e["channel"], "nrmse": e["nrmse_compensated"],
                "nrmse_paper": e["nrmse_paper"], "nrmse_plain": e.get("nrmse_plain"),
                "out_of_reach": e["out_of_reach"], "missing rms [N]": e["missing_rms"]["value"],
                "missing max [N]": e["missing_max"]["value"],
            }
            for e in self._manifest()["emulation"]
        ]  # fmt: skip
        return frame_of(rows, REACH).astype({"nrmse_plain": float})

    def plot(
        self,
        kind: str = "mimic",
        *,
        damper: str | None = None,
        records: Sequence[str] | str = (),
        span: tuple[float, float] | None = None,
    ) -> Figure:
        """A matplotlib Figure of one faulty damper.

        kind : mimic (force against velocity), duty (the sequence), time, or another of
            `erdctl plot --help`
        damper : fl, fr, rl or rr; the first with a fault without it
        records : only these;  span : only this time of each record, (start, end) [s]
        """
        plans = self.sequence.plans
        chosen = option(damper or next(iter(plans)), list(plans), "damper")
        subject = of_plan(
            plans[chosen], self.given.parameters, self.sequence.recording,
            static=self.sequence.static,
        )  # fmt: skip
        return draw(subject, kind, records, span)

    def write(self, path: Place) -> None:
        """Write the sequence, and its manifest next to it, as `erdctl mimic -o` does.

        The suffix says the format; .mat is laid out for Simulink.
        """
        name = os.fspath(path)
        pwm.write(self.sequence, self.log.arrow(), name)
        documents.write(self._manifest(), f"{name}.manifest.json")

    def _manifest(self) -> dict[str, Any]:
        return pwm.manifest(
            self.sequence, amplifier=self.amplifier, parameters_sha256=self.given.sha256,
            faults=[str(f) for f in self.faults], temperature=self.guard.document(),
        )  # fmt: skip

    def __repr__(self) -> str:
        rows = [
            f"{r.fault} on {channel}: NRMSE {r.compensated:.4f}, paper's inverse {r.paper:.4f},"
            f" {100 * r.out_of_reach:.1f} % out of reach"
            for channel, plan in self.sequence.plans.items()
            for r in plan.reaches
        ]
        return text(f"Mimicked: {self._title()}", [*rows, *self.remarks])

    def _repr_html_(self) -> str:
        shown = self.table("reach").dropna(axis="columns", how="all")
        return html(self._title(), shown, self.remarks)

    def _title(self) -> str:
        samples = counted(len(self.sequence.recording), "sample")
        return f"{counted(len(self.faults), 'fault')} over {samples}"


def mimic(
    parameters: ParametersLike,
    log: LogLike,
    faults: Sequence[str] | str,
    *,
    duty: float | None = None,
    duty_max: float = 0.45,
    resolution: float = 0.0,
    slew: float | None = None,
    update_rate: float | None = None,
    carrier: float = 25_000.0,
    full_scale: float = 5_000.0,
    max_temperature: float | None = 60.0,
    ignore_temperature: bool = False,
    uncompensated: bool = False,
    date: str | None = None,
    damper: str | None = None,
    operator: str | None = None,
    progress: Callable[[str, str], None] | None = None,
) -> Mimicked:
    """The PWM sequence with which a healthy damper acts as a faulty one.

    parameters : a result of `identify` or `diagnose`, the path of a parameter file, or its dict
    log : motion and healthy duty: what `erdctl.read` gave, or anything that `read` takes
    faults : "KIND=FACTOR@START:END,channel=NAME" in seconds of the record's own time, KIND oil,
        electrical or deformation, FACTOR 1 for healthy, NAME fl, fr, rl or rr, e.g.
        ["oil=0.5@15:31", "electrical=0.8@31:46"]
    duty : healthy duty [0..1], in place of the log's
    duty_max, resolution, slew, update_rate : of the amplifier: highest duty and its smallest step
        [0..1], fastest change [1/s], how often it can change [Hz]; None for no limit
    carrier, full_scale : PWM frequency [Hz], voltage at duty 1 [V]: for the manifest
    max_temperature : refuse a log in which the damper gets hotter [degC]; None for no limit
    ignore_temperature : do without that limit, also where a column that was not read looks like a
        temperature
    uncompensated : the paper's static inverse, which leaves out the lag T_d
    date, damper, operator : of the test, for provenance; a date as ISO 8601
    progress : called with (stage, what) as the work goes on

    Returns a Mimicked: `.table()` the sequence, `.table("reach")` how near each fault comes,
    `.to_dict()` the manifest, `.write("pwm.mat")` both as files, `.plot()`, also "duty".

    Raises InputProblem for a bad log or parameter file and for one that got too hot, UsageProblem
    for faults or limits that make no sense.

    Example:
        pwm = erdctl.mimic(damper, "drive.csv", ["oil=0.5@15:31"], update_rate=200)
        pwm.write("pwm.mat")
    """
    described = texts(faults)
    if not described:
        raise UsageProblem("mimic needs at least one fault, e.g. 'oil=0.5@15:31'")
    amplifier = Amplifier(
        carrier=carrier, full_scale=full_scale, duty_max=duty_max, resolution=resolution,
        slew=math.inf if slew is None else slew, update_rate=update_rate,
    )  # fmt: skip
    chosen = tuple(parse_fault(f) for f in described)
    given = given_parameters(parameters)
    refuse_untrusted(given.parameters, given.name)
    read = log_of(log, keep_table=True).labelled(date, damper, operator)
    guard = guarded(
        read.log, math.inf if max_temperature is None else max_temperature,
        declined=ignore_temperature, say_map="erdctl.read(..., map=[{}]) as the log",
        say_decline="ignore_temperature=True to do without the limit",
    )  # fmt: skip
    heat = None if guard.limit is None else too_hot(read.recording, guard.limit)
    if heat is not None:
        raise InputProblem(
            f"{heat}; max_temperature=None overrides (Sec. 5.4)", file=files_of(read.recording)
        )
    recording = at_duty(read.recording, duty, "duty")
    found = sequence(
        given.parameters, recording, chosen, amplifier, static=uncompensated,
        progress=progress or (lambda stage, what: None),
    )  # fmt: skip
    limited = [f"{line}; duty_max raises it" for line in held_back(found)]
    seen = (
        *guard.lines(), *worth(found), *way_back(found), *strain(found), *limited, *idle(found),
    )  # fmt: skip
    said = (*remarks(given.parameters, recording), *seen)
    return Mimicked(found, read, given, chosen, amplifier, guard, (*read.remarks, *said))
