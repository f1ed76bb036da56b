"""Logs larger than memory: time against pyarrow reading and writing them, and memory used.

    pytest -m benchmark -n 0 -s --no-cov tests/benchmarks/test_long_log_speed.py

with ERDCTL_BENCH_LONG_ROWS=20000000 for what the targets are of. Both in turn, the median of the
ratios; a test fails at twice its target only: machines are shared.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from places import FIXTURES

pytestmark = pytest.mark.benchmark

ROWS = int(os.environ.get("ERDCTL_BENCH_LONG_ROWS", "2500000"))
RECORD, GROUP = 200_000, 1_000_000
PAIRS = 3 if ROWS > 5_000_000 else 1
TARGET, SLACK, MIB = 1.5, 2.0, 1024.0
ERDCTL = [str(Path(sys.executable).with_name("erdctl"))]
PARAMS = str(FIXTURES / "table_2.json")
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
# Row group by row group, so that it holds no more than one either.
FLOOR = """
import sys, pyarrow.parquet as pq
file, writer = pq.ParquetFile(sys.argv[1], pre_buffer=False), None
for group in range(file.num_row_groups):
    table = file.read_row_group(group)
    table = table.append_column("force_model", table["force"])
    writer = writer or pq.ParquetWriter(sys.argv[2], table.schema)
    writer.write_table(table)
writer.close()
"""
MEASURED = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, capture_output=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


@pytest.fixture(scope="module")
def long(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign with duty steps and noise, written a million rows at a time."""
    path = tmp_path_factory.mktemp("long") / "log.parquet"
    rng, writer = np.random.default_rng(4), None
    for first in range(0, ROWS, GROUP):
        i = np.arange(first, min(first + GROUP, ROWS))
        t, record = (i % RECORD) * 1e-3, i // RECORD
        w = 2 * np.pi * (0.5 + 0.25 * (record % 9))
        x, xdot = 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t)
        duty = np.array([0.0, 0.1, 0.3, 0.2])[(t // 1.7).astype(int) % 4]
        force = 220 * x + 66 * xdot + 14 * duty**0.3 * np.sign(xdot)
        names = pa.array([f"r{k}" for k in range(int(record[0]), int(record[-1]) + 1)])
        columns = {"t": t, "x": x, "xdot": xdot, "duty": duty}
        columns["force"] = force + 0.3 * rng.standard_normal(len(i))
        table = pa.table({**columns, "record": names.take(pa.array(record - record[0]))})
        writer = writer or pq.ParquetWriter(path, table.schema)
        writer.write_table(table)
    assert writer is not None
    writer.close()
    return path


def measured(command: list[str]) -> tuple[float, float]:
    """Seconds, and highest resident memory [MiB]."""
    start = time.perf_counter()
    run = subprocess.run(
        [sys.executable, "-c", MEASURED, *command], capture_output=True, text=True, check=True,
        env=ENVIRONMENT,
    )  # fmt: skip
    return time.perf_counter() - start, int(run.stdout) / 1024


@pytest.mark.parametrize("command", ["simulate", "validate", "inspect", "convert"])
def test_a_log_larger_than_memory(long: Path, command: str) -> None:
    out = str(long.parent / "out.parquet")
    arguments = {
        "simulate": [PARAMS, str(long), "-o", out],
        "validate": [PARAMS, str(long), "--json"],
        "inspect": [str(long), "--json"],
        "convert": [str(long), out],
    }[command]
    ratios, most = [], 0.0
    for _ in range(PAIRS):
        floor, _ = measured([sys.executable, "-c", FLOOR, str(long), out])
        ours, memory = measured([*ERDCTL, command, *arguments])
        ratios.append(ours / floor)
        most = max(most, memory)
    ratio = statistics.median(ratios)
    print(
        f"\n{command}, {ROWS:,} rows: {ratio:.2f} times pyarrow reading and writing (target"
        f" {TARGET}), {most:.0f} MiB (target {MIB:.0f})"
    )
    assert most < MIB
    # Of a log of a second or two, starting is a good part.
    assert ROWS < 5_000_000 or ratio < SLACK * TARGET
