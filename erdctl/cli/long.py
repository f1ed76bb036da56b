"""Commands over a log that is read in stretches, and never as a whole."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from erdctl.bench.inspection import Inspection
    from erdctl.bench.rig import Rig
    from erdctl.io.drawn import Drawn
    from erdctl.io.inspection import InspectionFile
    from erdctl.io.long_logs import LongLog
    from erdctl.model.parameters import Parameters
    from erdctl.score.nrmse import Normalise, Validation

REPLACED = "the force_model that the log has is not in what is written: a new one is in its place"
UNMODELLED = "the log has no column force_model; give a parameter file before it"


@contextmanager
def opened(
    paths: Sequence[str], options: dict[str, Any], least: int = 0
) -> Iterator[LongLog | None]:
    """A log that is to be read in stretches, with a sign of life on a terminal; else None.

    least : samples, below which it is not
    """
    from erdctl.cli.in_force import IN_FORCE
    from erdctl.io.long_logs import open_long
    from erdctl.report.text import progress, say

    project = IN_FORCE.get()
    by = None if project is None else project.reading
    with progress() as step:
        log = open_long(paths, least=least, project=by, report=say, progress=step, **options)
        if log is not None and project is not None:
            project.tell()
            log.labels |= project.label()
        yield log


def simulate_long(
    parameters: Parameters,
    path: str,
    faults: Sequence[str],
    output: str,
    format: str | None,
    options: dict[str, Any],
) -> bool:
    """Write the log with `force_model`, if it is one to be read in stretches; whether it is."""
    from erdctl.io.tables import append_column, behind, table_writer
    from erdctl.model.simulate import Remarks, Simulation
    from erdctl.report.text import say

    with opened([path], options) as log:
        if log is None:
            return False
        simulation, remarks = Simulation(parameters, faults), Remarks(parameters, faults)
        again = False
        with table_writer(output, format) as writer, behind(writer) as write:
            for read in log.stretches(cut=simulation.cuts):
                force = simulation.force(read.stretch)
                remarks.add(read.stretch.own)
                assert read.table is not None  # what a log is written with
                again = again or "force_model" in read.table.column_names
                write(append_column(read.table, "force_model", force))
            simulation.finish()
    for line in [*([REPLACED] if again else []), *remarks.lines()]:
        say(line)
    for line in remarks.of_faults():
        say(line, "warning")
    return True


def validate_long(
    parameters: Parameters | None,
    paths: Sequence[str],
    normalise: Normalise,
    options: dict[str, Any],
) -> tuple[Validation, Rig, float, dict[str, str]] | None:
    """Scores, faults of the rig, the largest force [N], and what a project says the log is of.

    None for a log that is read whole.
    """
    from erdctl.bench.rig import Looking
    from erdctl.core.errors import InputProblem
    from erdctl.model.simulate import Remarks, Simulation
    from erdctl.report.text import say
    from erdctl.score.nrmse import Scoring

    with opened(paths, options) as log:
        if log is None:
            return None
        simulation = remarks = None
        if parameters is not None:
            simulation, remarks = Simulation(parameters), Remarks(parameters)
        tally, looking = Scoring(normalise), Looking(log.outline.starts, log.outline.names)
        for read in log.stretches(cut=simulation is None or simulation.cuts):
            modelled = read.force_model
            if simulation is not None and remarks is not None:
                modelled = simulation.force(read.stretch)
                remarks.add(read.stretch.own)
            if modelled is None:
                raise InputProblem(UNMODELLED, file=paths[0])
            for part in read.stretch.parts():
                first = part.first - read.stretch.first
                its = modelled[first : first + len(part)]
                tally.add(part, its)
                looking.add(part, its)
        if simulation is not None and remarks is not None:
            simulation.finish()
            for line in remarks.lines():
                say(line)
    return tally.found(), looking.rig(), tally.peak, log.labels


def inspect_long(
    paths: Sequence[str], options: dict[str, Any], labels: Mapping[str, str]
) -> tuple[Inspection, InspectionFile] | None:
    """What is in a log, and its document; None for a log that is read whole."""
    from erdctl.bench.counts import Ends
    from erdctl.bench.inspection import Inspecting
    from erdctl.core.recording import CHANNELS
    from erdctl.effects import catalogue
    from erdctl.io.inspection import InspectedLog, to_json

    with opened(paths, options) as log:
        if log is None:
            return None
        inspecting = Inspecting(log.outline.starts, log.outline.names)
        ends = {c.name: Ends() for c in log.channels}
        for read in log.stretches():
            inspecting.add(read.stretch)
            own = read.stretch.own
            seen = {**{n: getattr(own, n) for n in CHANNELS}, "force_model": read.force_model}
            for name, values in seen.items():
                if name in ends and values is not None:
                    ends[name].add(values)
    found = inspecting.found(catalogue(), log.xdot_note)
    ranges = {name: [e.low, e.high] for name, e in ends.items() if e.low <= e.high}
    labels = {**log.labels, **labels}
    subject = InspectedLog(log.sources, log.channels, log.unread, labels, ranges)
    return found, to_json(found, subject)


def drawn_long(paths: Sequence[str], options: dict[str, Any]) -> Drawn | None:
    """A sample of a log of more samples than are fitted; None for one that is read whole."""
    from erdctl.io import drawn
    from erdctl.report.text import say

    with opened(paths, options, least=drawn.MOST) as log:
        if log is None:
            return None
        found = drawn.draw(log, drawn.MOST)
    say(str(found))
    return found
