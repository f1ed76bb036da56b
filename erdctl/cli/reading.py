"""Logs as every command reads them: with a sign of life on a terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Concatenate, ParamSpec

from erdctl.cli.in_force import IN_FORCE
from erdctl.io import logs
from erdctl.io.logs import Log
from erdctl.report.text import progress

P = ParamSpec("P")


def _shown(
    work: Callable[Concatenate[Sequence[str], P], Log],
) -> Callable[Concatenate[Sequence[str], P], Log]:
    def read(paths: Sequence[str], /, *args: P.args, **options: P.kwargs) -> Log:
        project = IN_FORCE.get()
        by = {} if project is None else {"project": project.reading}
        try:
            with progress() as step:
                told = {"progress": step, **by, **options}
                return work(paths, *args, **told)  # type: ignore[arg-type]  # options more than given
        finally:
            if project is not None:
                project.tell()

    return read


read_logs = _shown(logs.read_logs)


def labelled(log: Log, labels: Mapping[str, str]) -> Log:
    """A log with the date, damper and operator that the user gave, and what the project says."""
    project = IN_FORCE.get()
    by = {} if project is None else project.label()
    labels = {**log.recording.labels, **labels, **by}
    return replace(log, recording=replace(log.recording, labels=labels)) if labels else log
