"""Logs as every command reads them: with a sign of life on a terminal."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Concatenate, ParamSpec, TypeVar

from erdctl.io import logs
from erdctl.report.text import progress

P = ParamSpec("P")
T = TypeVar("T")


def _shown(
    work: Callable[Concatenate[Sequence[str], P], T],
) -> Callable[Concatenate[Sequence[str], P], T]:
    def read(paths: Sequence[str], /, *args: P.args, **options: P.kwargs) -> T:
        with progress() as step:
            step("reading", ", ".join(paths))
            return work(paths, *args, **options)

    return read


read_logs = _shown(logs.read_logs)
