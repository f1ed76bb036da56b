"""Runs commands in one process, many one after the other: a request a line, an answer a line.

Requests come on one descriptor and answers go to another, so that whatever a command, or a library
below it, writes to the standard streams goes to files of the request.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import time
import traceback
from pathlib import Path
from typing import Any

LIMIT = 8 << 30  # bytes of address space; a program that needs more is stopped by MemoryError


def main() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (LIMIT, LIMIT))
    requests = os.fdopen(int(sys.argv[1]))
    answers = os.fdopen(int(sys.argv[2]), "w", buffering=1)
    from erdctl.cli.app import run

    for line in requests:
        request = json.loads(line)
        answers.write(json.dumps(answer(run, request)) + "\n")


def answer(run: Any, request: dict[str, Any]) -> dict[str, Any]:
    """Exit code, or the traceback of what was raised; seconds; peak of memory, and held [bytes]."""
    os.chdir(request["folder"])
    streams = [os.open(request["stdin"] or os.devnull, os.O_RDONLY)]
    streams += [os.open(f, os.O_WRONLY | os.O_CREAT | os.O_TRUNC) for f in (".out", ".err")]
    for number, descriptor in enumerate(streams):
        os.dup2(descriptor, number)
        os.close(descriptor)
    sys.stdin = os.fdopen(0, closefd=False)
    sys.stdout = os.fdopen(1, "w", closefd=False, errors="backslashreplace")
    sys.stderr = os.fdopen(2, "w", closefd=False, errors="backslashreplace")
    sys.argv = ["erdctl", *request["words"]]
    _forget_peak()
    begin, code, trace = time.perf_counter(), None, None
    try:
        code = int(run(request["words"]))
    except BaseException:  # noqa: BLE001  # whatever it is, it is what we are looking for
        trace = traceback.format_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    return {
        "code": code,
        "trace": trace,
        "seconds": time.perf_counter() - begin,
        "peak": _memory("VmHWM"),
        "held": _memory("VmRSS"),
    }


def _forget_peak() -> None:
    """Peaks are counted from here on; without /proc they are those of the whole process."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def _memory(what: str) -> int:
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
        return next(int(x.split()[1]) * 1024 for x in lines if x.startswith(what))
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


if __name__ == "__main__":
    main()
