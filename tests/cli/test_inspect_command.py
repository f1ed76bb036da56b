"""`erdctl inspect` as users call it: files, pipes, bad logs, a terminal."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build

APP = build(["inspect", "identify"])
BAD = FIXTURES / "bad"
INDEX = json.loads((BAD / "index.json").read_text())


def inspect(*words: object, data: bytes | None = None) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "erdctl", "inspect", *map(str, words)]
    return subprocess.run(command, input=data, capture_output=True)


def test_maps_channels_and_what_is_not_used() -> None:
    maps = ["t=Time[ms]", "x=Defl FL[mm]", "force=F_fl[N]", "duty=PWM[%]"]
    run = inspect(FIXTURES / "foreign.csv", "--json", *(w for m in maps for w in ("--map", m)))
    document = json.loads(run.stdout)
    channels = {c["name"]: c for c in document["channels"]}
    assert channels["x"]["column"] == "Defl FL"
    assert channels["x"]["factor"] == pytest.approx(1e-3)
    assert channels["x"]["range"] == pytest.approx([-0.012, 0.012], abs=1e-4)
    assert document["other_columns"] == ["Oil [degC]"]
    assert "Savitzky" in document["xdot"]
    assert document["records"][0]["rate"] == pytest.approx(500.0)
    assert b"Records" not in run.stderr  # one or the other


def test_several_logs_and_a_pipe(tmp_path: Path) -> None:
    log = FIXTURES / "schedule_60s.csv"
    alone = json.loads(inspect("-", "--json", data=log.read_bytes()).stdout)
    assert alone["records"][0]["temperature"][1] == pytest.approx(29.0, abs=0.5)
    two = json.loads(inspect(log, FIXTURES / "healthy_campaign.parquet", "--json").stdout)
    assert len(two["records"]) == 25
    assert len(two["logs"]) == 2
    assert two["samples"] == 72_000


def test_a_drive_without_force_is_inspected(tmp_path: Path) -> None:
    drive = tmp_path / "drive.csv"
    pd.read_csv(FIXTURES / "schedule_60s.csv").drop(columns="force").to_csv(drive, index=False)
    run = inspect(drive)
    assert run.returncode == 0
    assert b"no column force" in run.stderr


def test_words_for_a_constant_duty() -> None:
    text = inspect(FIXTURES / "schedule_60s.csv").stderr.decode()
    lines = [row for row in text.splitlines() if "cannot be identified" in row]
    assert any("compression.T_d, release.T_d" in row and "--drive" in row for row in lines)
    assert any("sigma" in row and "beta" in row for row in lines)
    field = ("field_threshold", "field_saturation", "input_delay", "supply_slew",
             "rise_decay_asymmetry")  # fmt: skip
    assert all(any(name in row for row in lines) for name in field)


@pytest.mark.parametrize(
    "case", [c for c in INDEX["cases"] if c["command"] == "identify"], ids=lambda c: c["file"]
)
def test_a_bad_log_is_one_line(case: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(BAD)
    result = CliRunner().invoke(APP, ["inspect", case["file"]])
    if case["file"] == "missing_force.csv":  # a drive, which is as good for inspect
        assert result.exit_code == 0
        return
    assert result.exit_code == 3
    assert result.stdout == ""
    errors = [row for row in result.stderr.splitlines() if row.startswith("erdctl: error:")]
    assert len(errors) == 1
    for word in case["mentions"]:
        assert word.casefold() in errors[0].casefold()


def log_of(path: Path, force: Any, **more: Any) -> Path:
    t = np.arange(400) * 0.005
    x = 0.01 * np.sin(6.0 * t)
    columns = {"t": t, "x": x, "xdot": 0.06 * np.cos(6.0 * t), "duty": 0.2, "force": force}
    pd.DataFrame({**columns, **more}).to_csv(path, index=False)
    return path


def test_a_force_without_steps_is_not_said_to_come_in_any(tmp_path: Path) -> None:
    """The least difference of 400 noisy values is chance; of a force in steps of 0.5 N it is 0.5 N,
    and of a constant one there is none."""
    noisy = np.random.default_rng(1).normal(0.0, 3.0, 400)
    for force, said in (
        (noisy, "smallest difference seen between two values of the force is"),
        (0.5 * np.rint(noisy / 0.5), "two values of the force is 0.5 N"),
        (np.full(400, 5.0), "every value seen of the force is the same"),
    ):
        text = inspect(log_of(tmp_path / "log.csv", force)).stderr.decode()
        assert said in text
        assert "in steps of" not in text


def test_the_zero_of_a_unit_is_shown_with_its_factor(tmp_path: Path) -> None:
    """70 degF are 70 x 0.5556 - 17.78 = 21.11 degC; a log of other units has no such column."""
    log = log_of(tmp_path / "log.csv", np.arange(400.0), temp=np.linspace(70.0, 74.0, 400))
    row = next(
        line.split() for line in
        inspect(log, "--map", "temperature=temp[degF]").stderr.decode().splitlines()
        if "temperature" in line
    )  # fmt: skip
    assert row[2:4] == ["0.5556", "-17.78"]
    assert "plus" not in inspect(log).stderr.decode()
