"""Time and memory of a diagnosis with the whole catalogue, against one fit of the paper's model.

    pytest -m benchmark -n 0 -s --no-cov tests/benchmarks/test_diagnose_speed.py

The target on two free cores is 60 s for 60,000 samples; machines are shared, so times are printed
and only ratios and memory are held.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from test_speed import ROWS

pytestmark = pytest.mark.benchmark
Array = npt.NDArray[np.float64]
Hidden = Callable[[Array, Array, Array, Array], Array]

RECORDS, RATE = 20, 500.0
SAMPLES = 60_000 if ROWS > 1_000_000 else 12_000
GROWTH = 2 if ROWS > 1_000_000 else 1  # the double only where it is to be reported
MOST_MIB = 1024
MARGIN = 1.25  # on a cost that grows as the number of samples
ERDCTL = str(Path(sys.executable).with_name("erdctl"))
MEASURE = """
import json, resource, subprocess, sys, time
start = time.perf_counter()
run = subprocess.run(sys.argv[1:], capture_output=True, text=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps({"wall": time.perf_counter() - start, "cpu": used.ru_utime + used.ru_stime,
                  "mib": used.ru_maxrss / 1024}))
sys.exit(run.stderr if run.returncode else 0)
"""


@dataclass(frozen=True)
class Cost:
    """Wall time and processor time [s] and highest resident memory [MiB] of one command."""

    wall: float
    cpu: float
    mib: float


def cost(*command: str) -> Cost:
    run = subprocess.run(
        [sys.executable, "-c", MEASURE, *command], capture_output=True, text=True, check=True
    )
    return Cost(**json.loads(run.stdout))


def seal_friction(t: Array, x: Array, xdot: Array, duty: Array) -> Array:
    return 1.5 * np.sign(xdot)


def make_log(path: Path, samples: int, hidden: Hidden = seal_friction) -> Path:
    """Sines and mixed motion under held and stepped duty; a smooth sign law and what is hidden
    are what the paper's model lacks, so that the search goes its whole way."""
    rng = np.random.default_rng(8)
    t = np.arange(samples // RECORDS) / RATE
    columns: dict[str, list[np.ndarray]] = {n: [] for n in ("t", "x", "xdot", "duty", "force")}
    for k in range(RECORDS):
        x, xdot = np.zeros((2, len(t)))
        for i in range(1 + 4 * (k % 3 == 0)):
            w = 2 * np.pi * (0.6 + 0.35 * ((k + 3 * i) % 11))
            a, phase = 0.10 / w / (1 + i), rng.uniform(0, 2 * np.pi)
            x += a * np.sin(w * t + phase)
            xdot += a * w * np.cos(w * t + phase)
        levels = rng.permutation([0.0, 0.1, 0.2, 0.35, 0.5]) if k % 2 else [0.1 * (k % 5)]
        duty = np.asarray(levels)[(t / 0.7).astype(int) % len(levels)]
        force = 400 * x + 80 * xdot + 14 * duty**0.5 * np.tanh(xdot / 0.01)
        force += hidden(t, x, xdot, duty) + 0.3 * rng.standard_normal(len(t))
        for name, values in zip(columns, (t, x, xdot, duty, force), strict=True):
            columns[name].append(values)
    names = np.repeat([f"r{k:02d}" for k in range(RECORDS)], len(t))
    pq.write_table(pa.table({n: np.concatenate(c) for n, c in columns.items()})
                   .append_column("record", pa.array(names)), path)  # fmt: skip
    return path


@pytest.mark.long
def test_whole_catalogue(tmp_path: Path) -> None:
    """One test for all figures: they are ratios of the same few runs."""
    out = str(tmp_path / "out.json")
    once = make_log(tmp_path / "once.parquet", SAMPLES)
    twice = make_log(tmp_path / "twice.parquet", GROWTH * SAMPLES)
    plain = cost(ERDCTL, "identify", str(once), "-o", out)
    double = cost(ERDCTL, "diagnose", str(twice), "-o", out)  # first, as it may compile
    single = cost(ERDCTL, "diagnose", str(once), "-o", out) if GROWTH > 1 else double
    document = json.loads(Path(out).read_text())
    growth = double.cpu / single.cpu
    print(f"\n{'what':44}{'wall, s':>9}{'cpu, s':>9}{'MiB':>7}")
    for what, c in (
        (f"identify, {SAMPLES:,} samples", plain),
        (f"diagnose, {RECORDS} records, {SAMPLES:,} samples", single),
        (f"diagnose, {RECORDS} records, {GROWTH * SAMPLES:,} samples", double),
    ):
        print(f"{what:44}{c.wall:9.1f}{c.cpu:9.1f}{c.mib:7.0f}")
    print(f"diagnose over one fit of the paper's model {single.cpu / plain.cpu:10.1f}")
    print(f"{GROWTH} times the samples over once {growth:23.2f}  at most {2 * MARGIN:.2f}")
    print("found:", document["verdict"], [f["effect"] for f in document["findings"]])
    assert document["findings"]
    assert single.mib < MOST_MIB
    assert growth < 2 * MARGIN
