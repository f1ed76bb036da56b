"""Logs that cannot fit are refused before they are read."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from erdctl.core.errors import ComputationProblem, ExitCode, InputProblem
from erdctl.io import memory
from erdctl.io.sources import open_source, read_source
from erdctl.io.tables import write_table


@pytest.fixture
def log(tmp_path: Path) -> Callable[[str], str]:
    def log(suffix: str) -> str:
        path = str(tmp_path / f"log{suffix}")
        rng = np.random.default_rng(0)
        write_table(pa.table({c: rng.normal(size=50_000) for c in ("t", "x", "u", "v")}), path)
        return path

    return log


@pytest.mark.parametrize(
    ("suffix", "tolerance"), [(".csv", 0.02), (".parquet", 0.0), (".arrow", 0.01)]
)
def test_expected_rows(log: Callable[[str], str], suffix: str, tolerance: float) -> None:
    rows = memory.expected_rows(open_source(log(suffix)))
    assert abs(rows - 50_000) <= tolerance * 50_000


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".arrow"])
def test_too_large(log: Callable[[str], str], suffix: str, monkeypatch: pytest.MonkeyPatch) -> None:
    source = open_source(log(suffix))
    monkeypatch.setattr("erdctl.core.memory.available", lambda: 3_000_000)
    memory.check_fits(source, 2)  # 2.4 MB
    with pytest.raises(InputProblem) as caught:
        memory.check_fits(source, 4)
    text = str(caught.value)
    assert "too large: its 4 columns need about 0.0048 GB" in text or suffix != ".parquet"
    assert "and 0.003 GB are free; split it into several logs" in text


def test_nothing_is_refused_where_the_system_does_not_tell(
    log: Callable[[str], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("erdctl.core.memory.available", lambda: None)
    memory.check_fits(open_source(log(".csv")), 1000)


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".arrow"])
def test_a_limit_of_the_process_counts(log: Callable[[str], str], suffix: str) -> None:
    free, message = _read_within(log(suffix), 2_000_000, imported=True)
    assert 0 <= int(free) <= 2_000_000
    assert message.startswith("InputProblem")
    assert "too large" in message


@pytest.mark.parametrize("imported", [True, False])
@pytest.mark.parametrize("bytes", [0, 100_000, 400_000])
def test_a_limit_that_is_reached_before_the_samples(
    log: Callable[[str], str], bytes: int, imported: bool
) -> None:
    _, message = _read_within(log(".parquet"), bytes, imported=imported)
    assert message.startswith("ComputationProblem out of memory while reading") or (
        "too large" in message
    )


def _read_within(path: str, bytes: int, *, imported: bool) -> list[str]:
    """What a process says that may take so many bytes more: what is free, and of the log.

    imported : whether all that reading needs was imported before
    """
    program = (
        "import contextlib, resource, sys\n"
        "from erdctl.core.errors import InputProblem\n"
        "from erdctl.core.memory import available\n"
        "from erdctl.io.logs import read_logs\n"
        "import pyarrow.parquet\n"
        "path, more, imported = sys.argv[1:]\n"
        "if imported == 'True':\n"
        "    with contextlib.suppress(InputProblem):\n"
        "        read_logs([path], need_force=False, report=lambda text: None)\n"
        "pages = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "whole = resource.getrlimit(resource.RLIMIT_AS)\n"
        "resource.setrlimit(resource.RLIMIT_AS, (pages + int(more), whole[1]))\n"
        "print(available())\n"
        "try:\n"
        "    read_logs([path], need_force=False, report=print)\n"
        "except Exception as error:\n"
        # To print it takes memory, too, which is not what is looked at.
        "    resource.setrlimit(resource.RLIMIT_AS, whole)\n"
        "    print(type(error).__name__, error)\n"
    )
    for _ in range(5):
        done = subprocess.run(
            [sys.executable, "-c", program, path, str(bytes), str(imported)],
            capture_output=True,
            text=True,
        )
        # The C library ends a process in which a thread of Arrow's first runs just at the limit.
        if "thread-local data" not in done.stderr:
            break
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.mark.parametrize("megabytes", [120, 300, 480, 560, 700])
@pytest.mark.parametrize("command", ["inspect", "identify", "diagnose"])
def test_less_than_the_libraries_take(
    log: Callable[[str], str], command: str, megabytes: int
) -> None:
    """Linear algebra waited for ever, or ended with the exit code of a check that failed."""
    size = 1_000_000 * megabytes
    done = subprocess.run(
        [sys.executable, "-m", "erdctl", command, log(".parquet")],
        capture_output=True,
        text=True,
        timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)),
    )
    assert done.returncode == ExitCode.NOT_COMPLETED
    assert done.stderr.startswith(
        f"erdctl: error: out of memory: this process may have 0.{megabytes // 100}"
    )
    assert done.stderr.count("\n") == 1


def test_no_thread_is_no_damage(log: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> None:
    """A file was called damaged, to be written again, where a limit left no thread to read it."""

    def exhausted(*_: object, **__: object) -> None:
        raise pa.ArrowException("Unknown error: Failed to launch worker thread")

    for suffix, reader in (
        (".csv", "pyarrow.csv.read_csv"),
        (".parquet", "pyarrow.parquet.ParquetFile"),
    ):
        path = log(suffix)
        with monkeypatch.context() as patch:
            patch.setattr(reader, exhausted)
            with pytest.raises(ComputationProblem, match="no thread can be started to read"):
                read_source(open_source(path))
