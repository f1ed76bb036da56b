"""The second process may crash, hang or talk: one line says it, and the next file is read."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import ComputationProblem, InputProblem
from erdctl.io.containers import isolated
from erdctl.io.containers.opening import guarded
from erdctl.io.formats import Format
from erdctl.io.sources import open_source, read_source

Write = Callable[..., Path]
Read = Callable[..., pa.Table]


@pytest.fixture
def log(tdms: Write) -> Path:
    step = {"wf_increment": 1e-3, "unit_string": "m"}
    force = {"wf_increment": 1e-3, "unit_string": "N"}
    return tdms({"log": {"x": (X, step), "force": (F, force)}})


@pytest.fixture
def fresh() -> Iterator[None]:
    """A process of its own, before and after."""
    isolated._reader(os.getpid()).stop()
    yield
    isolated._reader(os.getpid()).stop()


@pytest.mark.usefixtures("fresh")
@pytest.mark.parametrize(
    "does",
    ["import os; os.abort()", "raise SystemExit(1)", "print('not JSON')", "import os; os.close(1)"],
)
def test_a_crash(log: Path, converted: Read, monkeypatch: pytest.MonkeyPatch, does: str) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(isolated, "_START", f"{does}; import time; time.sleep(30)")
        with pytest.raises(InputProblem, match="damaged tdms: the library that reads it crashes"):
            converted(log)
    assert np.array_equal(converted(log)["x"], X)


@pytest.mark.usefixtures("fresh")
def test_no_end(log: Path, converted: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(isolated, "_START", "while True: pass")
        patched.setattr(isolated, "seconds_for", lambda size: 0.5)
        with pytest.raises(ComputationProblem, match=r"log.tdms: reading it did not come to an"):
            converted(log)
    assert np.array_equal(converted(log)["x"], X)


def test_another_file_in_between(log: Path, mdf: Write) -> None:
    first = open_source(str(log))
    second = open_source(str(mdf([("bench", T, {"x": X, "force": F})])))
    for source in (first, second, first):
        table, _ = read_source(source)
        assert np.array_equal(table["x"], X)


def test_the_process_ends_with_the_command(log: Path) -> None:
    program = (
        "import sys, os\n"
        "from erdctl.io.containers import isolated\n"
        "from erdctl.io.sources import open_source\n"
        "open_source(sys.argv[1])\n"
        "print(isolated._reader(os.getpid()).process.pid)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(log)], capture_output=True, text=True, check=True
    )
    pid = int(done.stdout)
    for _ in range(100):
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return
        subprocess.run([sys.executable, "-c", "import time; time.sleep(0.05)"], check=True)
    pytest.fail("still there")


@pytest.mark.usefixtures("fresh")
def test_too_much_memory(log: Path, converted: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    start = isolated._START.replace(
        "serve()", "import erdctl.io.containers.limits as l; l._BYTES = 1 << 16; serve()"
    )
    monkeypatch.setattr(isolated, "_START", start)
    with pytest.raises((ComputationProblem, InputProblem), match=r"more memory|damaged"):
        converted(log)


@pytest.mark.usefixtures("fresh")
def test_no_memory_for_the_table(
    log: Path, converted: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half of it is sent: only the exit code is left to say why it ends."""
    fails = (
        "import pyarrow as pa\n"
        "def no(*_): raise pa.lib.ArrowMemoryError('malloc of size 256 failed')\n"
        "import erdctl.io.containers.child as c; c.pa.ipc.new_stream = no\n"
    )
    monkeypatch.setattr(
        isolated, "_START", isolated._START.replace("from erd", f"\n{fails}from erd")
    )
    with pytest.raises(ComputationProblem, match="takes more memory than a sound tdms"):
        converted(log)


@pytest.mark.usefixtures("fresh")
def test_a_few_samples(tdms: Write, converted: Read) -> None:
    """Arrow's own pool would reserve more than the limit leaves to so small a file."""
    step = {"wf_increment": 1e-3, "unit_string": "m"}
    assert np.array_equal(converted(tdms({"log": {"x": (X[:8], step)}}))["x"], X[:8])


def test_a_library_that_takes_want_of_memory_for_damage() -> None:
    def read() -> None:
        try:
            raise MemoryError
        except MemoryError as error:
            raise ValueError("cannot read") from error

    with pytest.raises(MemoryError):
        guarded("log.tdms", Format.TDMS, read)
