"""The process that reads containers: questions on standard input, tables on standard output."""

from __future__ import annotations

import json
import os
import signal
import sys
from fractions import Fraction
from typing import Any, BinaryIO

import pyarrow as pa

from erdctl.core.errors import ComputationProblem, ErdctlError, InputProblem, UsageProblem
from erdctl.io.containers.align import aligned
from erdctl.io.containers.channels import Layout
from erdctl.io.containers.limits import OUT_OF_MEMORY, limit, too_much
from erdctl.io.containers.opening import check_samples, guarded, open_container
from erdctl.io.formats import Format
from erdctl.io.roles import Roles
from erdctl.io.units import Conversion

_PIPE = 1 << 20  # bytes in a pipe, where the system lets one choose


def serve() -> None:
    """Answer until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who asks
    questions, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    _widen(answers)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)  # whatever a library prints is no table
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115  # for as long as the process lives
    server = _Answering()
    while line := questions.readline():
        question = json.loads(line)
        try:
            reply, table = server.answer(question, questions)
        except ErdctlError as error:
            reply, table = {"problem": _kind(error), "text": str(error)}, None
        except MemoryError:
            text = too_much(server.name, server.format, server.size)
            reply, table = {"problem": "ComputationProblem", "text": text}, None
        if "problem" in reply:
            server.layout = None
        answers.write(json.dumps(reply).encode() + b"\n")
        if table is not None:
            try:
                with pa.ipc.new_stream(answers, table.schema) as writer:
                    writer.write_table(table)
            except MemoryError:
                os._exit(OUT_OF_MEMORY)  # half a table is sent: no other answer would be read
            del table
        answers.flush()


class _Answering:
    """layout : of the container that was opened last, until its table is sent."""

    def __init__(self) -> None:
        self.layout: Layout | None = None
        self.name, self.format, self.size = "", Format.MAT, 0

    def answer(
        self, question: dict[str, Any], questions: BinaryIO
    ) -> tuple[dict[str, Any], pa.Table | None]:
        if question["do"] == "open":
            return self.opened(question, questions), None
        layout, said = self.layout, list[str]()
        if layout is None:
            raise ComputationProblem(f"{self.name}: is not open any more; give it anew")
        self.layout = None
        factor, offset = map(Fraction, question["seconds"])
        roles = Roles(question["targets"], Conversion(factor, offset), said.append)
        wanted = question["wanted"]
        columns = check_samples(layout, wanted, self.size, self.name)
        limit(self.size, columns)
        table = guarded(self.name, self.format, lambda: aligned(layout, wanted, roles, self.name))
        return {"said": said, "table": True}, table

    def opened(self, question: dict[str, Any], questions: BinaryIO) -> dict[str, Any]:
        self.layout = None
        self.name, self.format = question["name"], Format(question["format"])
        data: str | bytearray = question["path"] or bytearray()
        if isinstance(data, bytearray):
            data = bytearray(question["bytes"])
            questions.readinto(data)  # type: ignore[attr-defined]  # of a BufferedReader
        self.size = os.path.getsize(data) if isinstance(data, str) else len(data)
        limit(self.size)
        self.layout = open_container(data, self.format, self.name)
        return {
            "columns": self.layout.columns,
            "units": self.layout.units,
            "clocks": sorted(self.layout.clocks),
            "notes": self.layout.notes,
        }


def _kind(error: ErdctlError) -> str:
    """The nearest of the errors that the other side knows."""
    kinds = (InputProblem, UsageProblem, ComputationProblem)
    return next((k.__name__ for k in kinds if isinstance(error, k)), "InputProblem")


def _widen(pipe: BinaryIO) -> None:
    try:
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, _PIPE)
    except (ImportError, AttributeError, OSError):
        return  # a narrow pipe is slower, no more
