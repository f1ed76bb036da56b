"""Results of the commands as subjects of pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.model.effect import Variable
from erdctl.model.faults import effectiveness
from erdctl.model.simulate import simulate
from erdctl.report.subject import Overlay, Programme, Subject

if TYPE_CHECKING:
    from erdctl.diagnose.diagnosis import Diagnosis
    from erdctl.diagnose.residual.localisation import Region
    from erdctl.mimic import Plan
    from erdctl.model.parameters import Parameters

PROGRAMME = ("duty_healthy", "out_of_reach")  # columns of a log that mimic wrote


def overlay(
    recording: Recording, title: str = "log", labels: Sequence[str] | None = None
) -> Overlay | None:
    """Which log each sample is of, or which group of logs; None of a single log.

    labels : of each log, where logs with the same label are drawn alike; else its name
    """
    sources = recording.sources
    if len(sources) < 2 or sum(s.rows for s in sources) != len(recording):
        return None
    told = [s.name for s in sources] if labels is None else labels
    ordered = title == "date"
    names = sorted(set(told)) if ordered else list(dict.fromkeys(told))
    number = np.array([names.index(label) for label in told], dtype=np.int16)
    return Overlay(np.repeat(number, [s.rows for s in sources]), tuple(names), title, ordered)


def about(recording: Recording) -> str:
    """The logs and their size, and the labels of the test."""
    logs = ", ".join(source.name for source in recording.sources[:3])
    more = len(recording.sources) - 3
    if more > 0:
        logs += f" and {more} more"
    shown = [text for name, text in recording.labels.items() if name != "project"]
    size = f"{logs}: {len(recording):,} samples" if logs else f"{len(recording):,} samples"
    return ", ".join([size, *shown])


def of_diagnosis(found: Diagnosis, parameters: Parameters) -> Subject:
    """The model before and after the correction, over the diagnosed recording.

    parameters : of the corrected model, with errors
    """
    recording, signals = found.problem.recording, found.problem.block.signals
    base, best = found.selection.base, found.selection.best
    before = base.model.force(signals, base.values)
    name = "paper's model"
    if found.given is not None:
        before, name = found.given.model.force(signals, found.given.values), "given model"
    effects = " + ".join(f.effect.name for f in found.findings)
    return Subject(
        recording=recording,
        modelled=best.model.force(signals, best.values),
        before=before,
        parameters=parameters,
        regions=tuple(r for r in found.mismatch if r.variable is not Variable.RECORD),
        names=("measured", f"with {effects}" if effects else "corrected model", name),
        about=about(recording),
    )


def of_plan(
    plan: Plan, parameters: Parameters, recording: Recording, *, static: bool = False
) -> Subject:
    """What a damper is to do while it mimics faults.

    recording : motion and healthy duty;  static : the paper's inverse goes to the amplifiers
    """
    r = recording
    return Subject(
        recording=replace(r, duty=plan.duty_paper if static else plan.duty, force=plan.ideal),
        modelled=plan.expected_paper if static else plan.expected,
        parameters=parameters,
        cases={"healthy": simulate(parameters, r)},
        acting={
            str(reach.fault): effectiveness(reach.fault, r.t, r.xdot, r.starts) < 1.0
            for reach in plan.reaches
        },
        programme=Programme(r.duty, plan.out_of_reach),
        names=("ideal faulty force", "force to expect", ""),
        about=about(r),
    )


def of_faults(parameters: Parameters, recording: Recording, faults: list[str]) -> dict[str, Array]:
    """Force (n,) [N] of the healthy damper, and with each fault alone."""
    alone = {fault: simulate(parameters, recording, [fault]) for fault in faults}
    return {"healthy": simulate(parameters, recording), **alone}


def located(recording: Recording, modelled: Array) -> tuple[Region, ...]:
    """Where a model misses a recording's measured force, the sharpest region first."""
    from erdctl.diagnose.problem import prepare
    from erdctl.diagnose.residual.localisation import locate

    if recording.force is None:
        return ()
    return tuple(locate(prepare(recording), (recording.force - modelled) ** 2))


def programme(columns: Mapping[str, Array]) -> Programme | None:
    """The sequence in a log that mimic wrote, out of its columns; None if it is no such log."""
    if not set(PROGRAMME) <= set(columns):
        return None
    healthy, out_of_reach = (columns[name] for name in PROGRAMME)
    return Programme(healthy, np.asarray(out_of_reach > 0.5))
