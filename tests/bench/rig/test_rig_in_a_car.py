"""A sound rig in a car: motion of few samples a cycle, a duty that switches at reversals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import quarter_car

from erdctl.bench.rig import Rig, look
from erdctl.io.logs import read_logs


def rig(table: pd.DataFrame, folder: Path) -> Rig:
    file = folder / "car.parquet"
    table.to_parquet(file)
    read = read_logs([str(file)], need_force=True, report=lambda line: None)
    return look(read.recording)


@pytest.mark.few(2)
@pytest.mark.parametrize("measured", [True, False])
@pytest.mark.parametrize("rate", [100, 200, 500, 1000])
def test_a_sound_log_has_no_fault(rate: int, measured: bool, tmp_path: Path) -> None:
    """Of 32 such logs 12 had spikes, jumps, a noisy velocity, or gains of 0.06: the motion itself,
    held against lines, trapezoids, and a model that a handful of samples told."""
    said = []
    for seed in range(6):
        table = quarter_car.log(seed, rate)
        found = rig(table if measured else table.drop(columns="xdot"), tmp_path)
        said += [(seed, f.code, f.text) for f in found.faults]
    assert not said


@pytest.mark.parametrize("rate", [200, 500])
def test_faults_are_found_beside_such_a_motion(rate: int, tmp_path: Path) -> None:
    table = quarter_car.log(7, rate, velocity=1e-5)
    assert not rig(table, tmp_path).faults
    third = np.flatnonzero(table["record"] == "r2")
    spiky, noisy = table.copy(), table.copy()
    at = third[[len(third) // 3, len(third) // 2, 2 * len(third) // 3]]
    spiky.loc[at, "x"] += 0.004
    assert {(f.code, f.record) for f in rig(spiky, tmp_path).faults} == {("x_spikes", 2)}
    noise = 0.2 * float(table["xdot"].std())
    noisy["xdot"] += noise * np.random.default_rng(1).standard_normal(len(table))
    assert "velocity_noise" in {f.code for f in rig(noisy, tmp_path).faults}
    fastest = third[1 + int(np.argmax(np.abs(table["xdot"].to_numpy()[third[5:-5]])))]
    lost = table.drop(index=range(fastest, fastest + 4)).reset_index(drop=True)
    rest = lost["record"] == "r2"
    lost.loc[rest, "t"] = np.arange(rest.sum()) / rate
    assert {(f.code, f.record) for f in rig(lost, tmp_path).faults} == {("x_jumps", 2)}
