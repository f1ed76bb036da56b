"""Files as labs hand them over: one command reads each, and says what it assumed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from lab_files import ALL, LabFile, samples
from places import SHARED
from rig import real

from erdctl.io.logs import read_logs


def maps_of(lab: LabFile) -> list[str]:
    return [o for o in lab.options if o != "--map"]


@pytest.mark.parametrize("make", ALL, ids=lambda make: make.__name__)
def test_one_call_reads_it(make: Callable[[], LabFile], tmp_path: Path) -> None:
    lab, said = make(), []
    path = tmp_path / lab.name
    path.write_bytes(lab.data)
    recording = read_logs(
        [str(path)], maps=maps_of(lab), need_force=True, report=said.append
    ).recording
    want = samples()
    assert np.abs(recording.t - recording.t[0] - want["t"]).max() < 1e-9
    assert np.abs(recording.x - want["x"]).max() < 5e-8
    assert np.abs(recording.force - want["force"]).max() < 5e-4
    if "duty" in str(said) and "no column duty" not in str(said):
        assert np.array_equal(recording.duty, want["duty"])
    assumed = [line for line in said if "read as: " in line]
    assert len(assumed) == 1, said
    for words in lab.assumed:
        assert words in assumed[0], assumed[0]


def test_one_command_reads_it(tmp_path: Path) -> None:
    """As a user types it; the line is on stderr, the document on stdout."""
    lab = ALL[1]()
    path = tmp_path / lab.name
    path.write_bytes(lab.data)
    done = subprocess.run(
        [sys.executable, "-m", "erdctl", "inspect", str(path), "--json", *lab.options],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert f"{path}: read as: UTF-8, tabs, decimal comma, LabVIEW measurement" in done.stderr
    assert done.stdout.startswith("{")


@pytest.mark.real_data
def test_the_recorder_gives_what_its_lab_published() -> None:
    """The same test as a published record, which begins 8.465 s later and has its means removed."""
    said: list[str] = []
    path = real("mr_recorder.txt", SHARED)
    log = read_logs(
        [str(path)], maps=["force=CHANNEL0[980.665 N]", "x=CHANNEL1[0.01 m]"],
        need_force=True, report=said.append,
    ).recording  # fmt: skip
    assert len(log) == 4000
    assert np.abs(log.t - np.arange(4000) * 0.005).max() < 1e-12
    for words in ("header in line 7", "'Events' absent in some rows", "mm/dd/yyyy"):
        assert words in said[0]
    raw = pq.read_table(real("mr_raw.parquet", SHARED)).to_pandas()
    record = raw[raw["record"] == "25mm_0.5Hz_0A"].iloc[: 4000 - 1693]
    assert np.ptp(record["x"].to_numpy() - log.x[1693:]) < 1e-12
    assert np.ptp(record["force"].to_numpy() - log.force[1693:]) < 1e-9
