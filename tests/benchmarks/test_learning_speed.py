"""What it costs to learn what no effect explains, against the diagnosis without that.

    ERDCTL_BENCH_ROWS=10000000 pytest -m benchmark -n 0 -s --no-cov \\
        tests/benchmarks/test_learning_speed.py

Processor time of one process, on logs of 20 records and 60,000 samples in which the paper's model
lacks an effect and a law that is in no catalogue. Eight diagnoses of a minute: only where asked
for.
"""

from __future__ import annotations

import time
from pathlib import Path
from statistics import median

import numpy as np
import pytest
from test_diagnose_speed import SAMPLES, Array, make_log
from test_speed import ROWS

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs

pytestmark = [
    pytest.mark.benchmark,
    pytest.mark.skipif(ROWS <= 1_000_000, reason="eight diagnoses: ERDCTL_BENCH_ROWS=10000000"),
]
TARGET = 1.5


def worn_bore(t: Array, x: Array, xdot: Array, duty: Array) -> Array:
    """A drag where the piston has passed less often."""
    return 2.0 * np.exp(-((x / 0.004 - 0.3) ** 2)) * np.sign(xdot)


def settling(t: Array, x: Array, xdot: Array, duty: Array) -> Array:
    """Particles that motion stirs up again."""
    travel = np.cumsum(np.abs(xdot)) * (t[1] - t[0])
    return -8.0 * duty**0.5 * np.exp(-travel / 0.05) * np.tanh(xdot / 0.01)


def duty_viscosity(t: Array, x: Array, xdot: Array, duty: Array) -> Array:
    """A viscosity that rises and falls with the duty."""
    return 30.0 * np.sin(12.0 * duty) * xdot


def swarming(t: Array, x: Array, xdot: Array, duty: Array) -> Array:
    """A yield force of the deflection and the duty together."""
    return 10.0 * duty**0.5 * (x / 0.01) * (duty / 0.5) * np.tanh(xdot / 0.01)


HIDDEN = (worn_bore, settling, duty_viscosity, swarming)


def took(log: Recording, *, learning: bool) -> tuple[float, str]:
    """Processor time [s], and what is said."""
    start = time.process_time()
    found = diagnose(log, list(catalogue()), learning=learning)
    used = time.process_time() - start
    laws = found.learned.laws if found.learned is not None else ()
    return used, ", ".join([*(f.effect.name for f in found.findings), *(w.law.name for w in laws)])


def test_a_law_costs_half_of_the_search_at_most(tmp_path: Path) -> None:
    ratios = []
    print(f"\n{'hidden':16}{'without, s':>11}{'with, s':>9}{'ratio':>7}  said")
    for hidden in HIDDEN:
        path = make_log(tmp_path / f"{hidden.__name__}.parquet", SAMPLES, hidden)
        log = read_logs([str(path)], need_force=True, report=lambda line: None).recording
        without, _ = took(log, learning=False)
        whole, said = took(log, learning=True)
        ratios.append(whole / without)
        print(f"{hidden.__name__:16}{without:11.1f}{whole:9.1f}{ratios[-1]:7.2f}  {said}")
    print(f"median {median(ratios):.2f}  at most {TARGET}")
    assert median(ratios) < 2.0 * TARGET  # a machine that others share
