"""Logs as every command reads them: with a sign of life on a terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Concatenate, ParamSpec

from erdctl.io import logs
from erdctl.io.logs import Log
from erdctl.report.text import progress

P = ParamSpec("P")


def _shown(
    work: Callable[Concatenate[Sequence[str], P], Log],
) -> Callable[Concatenate[Sequence[str], P], Log]:
    def read(paths: Sequence[str], /, *args: P.args, **options: P.kwargs) -> Log:
        with progress() as step:
            told = {"progress": step, **options}
            return work(paths, *args, **told)  # type: ignore[arg-type]  # one option more than given

    return read


read_logs = _shown(logs.read_logs)


def labelled(log: Log, labels: Mapping[str, str]) -> Log:
    """A log with the date, damper and operator that the user gave."""
    return replace(log, recording=replace(log.recording, labels=labels)) if labels else log
