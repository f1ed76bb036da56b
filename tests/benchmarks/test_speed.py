"""Time and memory of whole commands against a floor measured in the same run; prints a table.

    pytest -m benchmark -n 0 -s --no-cov tests/benchmarks
    ERDCTL_BENCH_ROWS=10000000 pytest -m benchmark -n 0 -s --no-cov tests/benchmarks

A ratio is the median over pairs of runs in turn, so that a drifting machine slows both alike. A
test fails at twice its target only: machines are shared, and a ratio scatters.
"""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from places import FIXTURES

pytestmark = pytest.mark.benchmark

ROWS = int(os.environ.get("ERDCTL_BENCH_ROWS", "1000000"))
SHORT = 60_000
PAIRS = 5 if ROWS > 1_000_000 else 3  # few where a run is only to show that nothing broke
SLACK = 2.0
ERDCTL = [str(Path(sys.executable).with_name("erdctl"))]
PARAMS = str(FIXTURES / "table_2.json")
REPORT: list[tuple[str, float, float, str]] = []
# Bytecode is kept, as an installed package has it.
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}


def make_log(path: Path, rows: int) -> Path:
    """A campaign with duty steps and noise, in records of at most 200,000 samples."""
    rng = np.random.default_rng(4)
    per = min(200_000, max(rows // 4, 1))
    i = np.arange(rows)
    t = (i % per) * 1e-3
    record = i // per
    frequency = 0.5 + 0.25 * (record % 9)
    w = 2 * np.pi * frequency
    x, xdot = 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t)
    duty = np.array([0.0, 0.1, 0.3, 0.2])[(t // 1.7).astype(int) % 4]
    force = 220 * x + 66 * xdot + 14 * duty**0.3 * np.sign(xdot) + 0.3 * rng.standard_normal(rows)
    names = pa.array([f"r{k}" for k in range(int(record[-1]) + 1)])
    text = pa.DictionaryArray.from_arrays(pa.array(record.astype(np.int32)), names)
    columns = {"t": t, "x": x, "xdot": xdot, "duty": duty, "force": force}
    table = pa.table({**columns, "record": text.cast(pa.string())})
    pq.write_table(table, path)
    return path


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("bench")
    return {
        "long": make_log(folder / "long.parquet", ROWS),
        "short": make_log(folder / "short.parquet", SHORT),
        "folder": folder,
    }


@pytest.fixture(scope="module", autouse=True)
def report() -> Iterator[None]:
    yield
    print(f"\n{'what':58}{'ratio':>8}{'target':>8}  floor")
    for what, ratio, target, floor in REPORT:
        print(f"{what:58}{ratio:8.2f}{target:8.1f}  {floor}")


def seconds(*commands: list[str]) -> float:
    start = time.perf_counter()
    for command in commands:
        subprocess.run(command, check=True, capture_output=True, env=ENVIRONMENT)
    return time.perf_counter() - start


def peak_mib(command: list[str]) -> float:
    """Highest resident memory of one command [MiB], as its own only child reports it."""
    code = (
        "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True,"
        " capture_output=True); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, *command], capture_output=True, text=True, check=True
    )
    return int(run.stdout) / 1024


def compare(
    what: str, target: float, floor: str, ours: list[list[str]], base: list[list[str]]
) -> None:
    ratios = []
    if PAIRS > 3:
        seconds(*ours), seconds(*base)  # a median of three leaves out a first run that compiles
    for _ in range(PAIRS):
        ratios.append(seconds(*ours) / seconds(*base))
    ratio = statistics.median(ratios)
    REPORT.append((what, ratio, target, floor))
    assert ratio < SLACK * target


def python(code: str) -> list[str]:
    return [sys.executable, "-c", code]


def test_help_starts_like_typer() -> None:
    compare("erdctl --help", 2.0, "import typer", [[*ERDCTL, "--help"]], [python("import typer")])


def test_short_log(logs: dict[str, Path]) -> None:
    out = logs["folder"] / "out.parquet"
    ours = [
        [*ERDCTL, "simulate", PARAMS, str(logs["short"]), "-o", str(out)],
        [*ERDCTL, "validate", PARAMS, str(logs["short"])],
    ]
    base = [python("import numpy, pyarrow.parquet")]
    what = f"simulate and validate, together, {SHORT:,} rows"
    compare(what, 3.0, "import numpy, pyarrow.parquet", ours, base)


def test_simulate_long(logs: dict[str, Path]) -> None:
    out = logs["folder"] / "out.parquet"
    copy = (
        "import pyarrow.parquet as pq, sys; t = pq.read_table(sys.argv[1]);"
        " pq.write_table(t.append_column('force_model', t['force']), sys.argv[2])"
    )
    ours = [[*ERDCTL, "simulate", PARAMS, str(logs["long"]), "-o", str(out)]]
    base = [[*python(copy), str(logs["long"]), str(out)]]
    what = f"simulate Parquet to Parquet, {ROWS:,} rows"
    compare(what, 1.5, "pyarrow reads and writes the same columns", ours, base)


def test_inspect_long(logs: dict[str, Path]) -> None:
    read = "import pyarrow.parquet as pq, sys; t = pq.read_table(sys.argv[1]);"
    read += " [t[c].to_numpy() for c in ('t', 'x', 'xdot', 'duty', 'force')]"
    ours = [[*ERDCTL, "inspect", str(logs["long"]), "--json"]]
    base = [[*python(read), str(logs["long"])]]
    compare(f"inspect, {ROWS:,} rows", 3.0, "pyarrow reads the same columns", ours, base)


def test_identify_long(logs: dict[str, Path]) -> None:
    solve = (
        "import numpy as np, pyarrow.parquet as pq, sys; t = pq.read_table(sys.argv[1]);"
        " a = np.column_stack([t['x'].to_numpy(), t['xdot'].to_numpy()]);"
        " np.linalg.lstsq(a, t['force'].to_numpy(), rcond=None)"
    )
    out = logs["folder"] / "params.json"
    ours = [[*ERDCTL, "identify", str(logs["long"]), "-o", str(out)]]
    base = [[*python(solve), str(logs["long"])]]
    what = f"identify, {ROWS:,} rows"
    compare(what, 10.0, "pyarrow reads, one two-column lstsq", ours, base)
    c_vis = json.loads(out.read_text())["compression"]["c_vis"]["value"]
    assert c_vis == pytest.approx(66, rel=0.01)


@pytest.mark.parametrize("command", ["inspect", "identify", "simulate"])
def test_memory_long(logs: dict[str, Path], command: str) -> None:
    out = str(logs["folder"] / ("m.json" if command == "identify" else "m.parquet"))
    arguments = [str(logs["long"]), *([] if command == "inspect" else ["-o", out])]
    if command == "simulate":
        arguments.insert(0, PARAMS)
    start = peak_mib([*ERDCTL, "--help"]) if ROWS < 5_000_000 else 0.0
    table = pq.read_table(logs["long"])
    in_memory = table.nbytes / 2**20
    ratio = (peak_mib([*ERDCTL, command, *arguments]) - start) / in_memory
    REPORT.append((f"peak memory of {command}, {ROWS:,} rows", ratio, 4.0, "the log in memory"))
    # A short log is dwarfed by the libraries' own memory.
    assert ROWS < 5_000_000 or ratio < 4.0 * SLACK


def test_limits_are_not_set() -> None:
    """The figures above hold for a process without a memory limit."""
    assert resource.getrlimit(resource.RLIMIT_AS)[0] == resource.RLIM_INFINITY
