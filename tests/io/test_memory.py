"""Logs that cannot fit are refused before they are read."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from erdctl.core.errors import InputProblem
from erdctl.io import memory
from erdctl.io.sources import open_source
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


def test_a_limit_of_the_process_counts(log: Callable[[str], str]) -> None:
    program = (
        "import resource, sys\n"
        "from erdctl.core.memory import available\n"
        "from erdctl.io.logs import read_logs\n"
        "import pyarrow.parquet\n"
        "pages = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (pages + 2_000_000,) * 2)\n"
        "print(available())\n"
        "try:\n"
        "    read_logs([sys.argv[1]], need_force=False, report=print)\n"
        "except Exception as error:\n"
        "    print(type(error).__name__, error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, log(".parquet")], capture_output=True, text=True
    )
    free, message = done.stdout.splitlines()
    assert 0 <= int(free) <= 2_000_000
    assert message.startswith("InputProblem")
    assert "too large" in message
