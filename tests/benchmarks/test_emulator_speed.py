"""Time of one step of the exported emulator, against one `exp` of the same machine and run.

pytest -m benchmark -n 0 -s --no-cov tests/benchmarks/test_emulator_speed.py
"""

from __future__ import annotations

import ctypes
import shutil
import statistics
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from places import FIXTURES

from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters

pytestmark = [
    pytest.mark.benchmark,
    pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler"),
]

STEPS = 1_000_000
LONGEST = 2e-6  # s
EXPONENTIALS = 150  # that a step may take the time of
PAIRS = 5

# Both over the same motion; the sums are for no compiler to leave anything out.
PROGRAM = """
#include "em.h"
#include <math.h>
double steps(const double *rows, long n, double resolution, double slew, double period);
double exponentials(const double *rows, long n);
double steps(const double *rows, long n, double resolution, double slew, double period)
{
    em_params p;
    em_state s;
    double sum = 0.0;
    long i;
    em_defaults(&p);
    p.resolution = resolution;
    p.slew = slew;
    p.update_period = period;
    em_init(&s, &p);
    em_faults(&s, 0.7, 0.9, 0.8);
    for (i = 0; i < n; i++)
        sum += em_step(&s, 0.001, rows[3 * i], rows[3 * i + 1], rows[3 * i + 2], 25.0);
    return sum;
}
double exponentials(const double *rows, long n)
{
    double sum = 0.0;
    long i;
    for (i = 0; i < n; i++)
        sum += exp(-fabs(rows[3 * i + 1]));
    return sum;
}
"""


def rough(n: int) -> np.ndarray:
    """(n, 3) x, xdot, duty of a rough road at 1 kHz; the duty changes at every sample."""
    rng, t = np.random.default_rng(1), 0.001 * np.arange(n)
    w = 2.0 * np.pi * rng.uniform(0.7, 14.0, 12)
    phase = t[:, None] * w + rng.uniform(0.0, 6.3, 12)
    x, xdot = np.sin(phase) @ (0.06 / w), 0.06 * np.cos(phase).sum(axis=1)
    return np.ascontiguousarray(np.stack([x, xdot, rng.uniform(0.05, 0.4, n)], axis=1))


def test_a_step_takes_less_than_two_microseconds(tmp_path: Path) -> None:
    parameters = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
    block = write_emulator(parameters, prefix="em")
    (tmp_path / "em.h").write_text(block.header)
    (tmp_path / "em.c").write_text(block.source)
    (tmp_path / "bench.c").write_text(PROGRAM)
    subprocess.run(
        ["gcc", "-std=c99", "-O2", "-shared", "-fPIC", "em.c", "bench.c", "-o", "em.so", "-lm"],
        cwd=tmp_path, check=True,
    )  # fmt: skip
    library, rows = ctypes.CDLL(str(tmp_path / "em.so")), rough(STEPS)
    data, n = rows.ctypes.data_as(ctypes.c_void_p), ctypes.c_long(STEPS)

    def took(name: str, *limits: float) -> float:
        function = getattr(library, name)
        function.restype = ctypes.c_double
        start = time.perf_counter()
        function(data, n, *map(ctypes.c_double, limits))
        return (time.perf_counter() - start) / STEPS

    took("exponentials")
    print()
    for name, limits in (("no limits", (0.0, 0.0, 0.0)), ("all limits", (0.001, 5.0, 0.002))):
        pairs = [(took("steps", *limits), took("exponentials")) for _ in range(PAIRS)]
        best = min(step for step, _ in pairs)
        ratio = statistics.median(step / one for step, one in pairs)
        print(f"emulator, {name}: {1e9 * best:.0f} ns a step, {ratio:.0f} times one exp")
        assert best < LONGEST
        assert ratio < EXPONENTIALS
