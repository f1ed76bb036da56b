"""Containers, opened and read in a process of their own.

Their libraries follow what a file says of itself: a damaged one makes them crash, run in circles,
fill the memory or print. None of this may happen to the command, so a second process reads, with
a limit on its time and its memory, and sends a table. It begins with the first container and
serves those after it.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import count
from threading import Lock, Timer
from typing import IO, Any

import pyarrow as pa

from erdctl.core.errors import ComputationProblem, InputProblem, UsageProblem
from erdctl.io.containers.align import aligned
from erdctl.io.containers.channels import Layout
from erdctl.io.containers.limits import OUT_OF_MEMORY, seconds_for, too_much
from erdctl.io.containers.opening import guarded, is_plain, open_container
from erdctl.io.extras import present
from erdctl.io.formats import Format
from erdctl.io.roles import Roles

_START = "import sys; sys.path[:] = {path!r}; from erdctl.io.containers.child import serve; serve()"
_LIBRARIES = {
    Format.MDF: ("asammdf", "mdf", "ASAM MDF files"),
    Format.HDF5: ("h5py", "hdf5", "HDF5 files"),
    Format.TDMS: ("nptdms", "tdms", "NI TDMS files"),
}
# Arrow's own pool reserves a gigabyte with its first bytes: more than the limit leaves by then.
_SETTINGS = {"OPENBLAS_NUM_THREADS": "1", "ARROW_DEFAULT_MEMORY_POOL": "system"}
_PROBLEMS = {p.__name__: p for p in (UsageProblem, ComputationProblem)}


@dataclass(frozen=True, eq=False)
class Container:
    """A container as one table, whose samples are still in the file.

    columns, units, clocks, notes : see `channels.Layout`
    here : the layout itself, where the file is read in this process
    """

    data: str | bytearray
    format: Format
    name: str
    key: int
    columns: tuple[str, ...]
    units: Mapping[str, str]
    clocks: frozenset[str]
    notes: tuple[str, ...]
    here: Layout | None = None

    def table(self, wanted: Sequence[str], roles: Roles) -> pa.Table:
        """The wanted columns as `align.aligned` gives them.

        Raises InputProblem as it does, ComputationProblem if reading takes too long or too much.
        """
        if (layout := self.here) is not None:
            return guarded(
                self.name, self.format, lambda: aligned(layout, wanted, roles, self.name)
            )
        reader = _reader(os.getpid())
        with reader.lock:
            if reader.opened != self.key:  # another file came between
                _open(reader, self.data, self.format, self.name, self.key)
            seconds = roles.seconds
            reply, table = reader.ask(
                {
                    "do": "table",
                    "wanted": list(wanted),
                    "targets": dict(roles.targets),
                    "seconds": [str(seconds.factor), str(seconds.offset)],
                },
                self,
            )
            reader.opened = None
        for line in reply["said"]:
            roles.say(line)
        assert table is not None
        return table


_keys = count(1)


def open_isolated(data: str | bytearray, format: Format, name: str) -> Container:
    """The channels of a file, or of the bytes of one, samples unread; name : for messages.

    Raises InputProblem if it is damaged or too large, ComputationProblem if the library that reads
    it is missing, or does not come to an end.
    """
    if format is Format.MAT and is_plain(data, name):
        # SciPy does not follow what it has not been told, and a second process would take
        # longer to start than the file to read.
        layout = open_container(data, format, name)
        return Container(
            data, format, name, 0, layout.columns, layout.units, layout.clocks, layout.notes, layout
        )
    if format in _LIBRARIES:
        module, extra, purpose = _LIBRARIES[format]
        present(module, extra=extra, purpose=purpose)
    key = next(_keys)
    reader = _reader(os.getpid())
    with reader.lock:
        found = _open(reader, data, format, name, key)
    return Container(
        data,
        format,
        name,
        key,
        tuple(found["columns"]),
        found["units"],
        frozenset(found["clocks"]),
        tuple(found["notes"]),
    )


def _open(
    reader: _ReadingProcess, data: str | bytearray, format: Format, name: str, key: int
) -> dict[str, Any]:
    held = None if isinstance(data, str) else data
    place = Container(data, format, name, key, (), {}, frozenset(), ())
    request = {
        "do": "open",
        "path": os.path.abspath(data) if isinstance(data, str) else None,
        "format": format.value,
        "name": name,
        "bytes": 0 if held is None else len(held),
    }
    reader.opened = None
    reply, _ = reader.ask(request, place, held)
    reader.opened = key
    return reply


@cache
def _reader(process: int) -> _ReadingProcess:
    """The reader of this process; a fork may not share that of its parent."""
    return _ReadingProcess()


class _ReadingProcess:
    """The second process; opened : the key of the container that it holds."""

    def __init__(self) -> None:
        self.lock = Lock()
        self.opened: int | None = None
        self.process: subprocess.Popen[bytes] | None = None

    def ask(
        self, request: dict[str, Any], file: Container, held: bytearray | None = None
    ) -> tuple[dict[str, Any], pa.Table | None]:
        """What the process answers, and the table that follows if one does."""
        process = self.started()
        seconds = seconds_for(_bytes_of(file.data))
        late: list[bool] = []

        def stop() -> None:
            late.append(True)
            process.kill()

        timer = Timer(3.0 * seconds, stop)  # of the clock, on a busy machine
        timer.daemon = True
        timer.start()
        try:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write(json.dumps(request).encode() + b"\n")
            if held is not None:
                process.stdin.write(held)
            process.stdin.flush()
            reply = json.loads(process.stdout.readline())
            table = _received(process.stdout) if reply.get("table") else None
        except (OSError, ValueError, pa.ArrowException):
            raise self.ended(file, late=bool(late), seconds=seconds) from None
        except BaseException:  # Ctrl-C, between a question and its answer
            self.stop()
            raise
        finally:
            timer.cancel()
        if "problem" in reply:
            raise _problem(reply["problem"], reply["text"])
        return reply, table

    def started(self) -> subprocess.Popen[bytes]:
        if self.process is None or self.process.poll() is not None:
            code = _START.format(path=[p or os.getcwd() for p in sys.path])
            try:
                self.process = subprocess.Popen(
                    [sys.executable, "-c", code],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,  # what libraries say is said in one line by erdctl
                    env=os.environ | _SETTINGS,
                )
            except OSError as error:
                raise ComputationProblem(
                    f"cannot start a second process to read files in ({error})"
                ) from None
        return self.process

    def stop(self) -> int:
        process, self.process, self.opened = self.process, None, None
        if process is None:
            return 0
        process.kill()
        code = process.wait()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                try:
                    pipe.close()
                except OSError:
                    continue  # what was still to be written to it has nobody to read it
        return code

    def ended(self, file: Container, *, late: bool, seconds: float) -> Exception:
        """What to say of a process that is there no more."""
        # It may still be about to end by itself, whose reason would be lost if it were killed.
        try:
            code = None if self.process is None else self.process.wait(1.0)
        except subprocess.TimeoutExpired:
            code = None
        self.stop()
        if late or code == -getattr(signal, "SIGXCPU", 0):
            return ComputationProblem(
                f"{file.name}: reading it did not come to an end in {seconds:.0f} s of computing;"
                f" it is damaged or very unusual {file.format.value}: write or copy it again, or"
                " export it as CSV"
            )
        if code == OUT_OF_MEMORY:
            return ComputationProblem(too_much(file.name, file.format, _bytes_of(file.data)))
        return InputProblem(
            f"damaged {file.format.value}: the library that reads it crashes on it; write or copy"
            " it again, or export it as CSV",
            file=file.name,
        )


def _bytes_of(data: str | bytearray) -> int:
    return os.path.getsize(data) if isinstance(data, str) else len(data)


def _received(stream: IO[bytes]) -> pa.Table:
    with pa.ipc.open_stream(stream) as reader:
        return reader.read_all()


def _problem(kind: str, text: str) -> Exception:
    return _PROBLEMS[kind](text) if kind in _PROBLEMS else InputProblem(text)
