"""A fault that does nothing in a log is said to, however the log is read."""

from __future__ import annotations

from pathlib import Path
from unittest import mock

import pandas as pd
import pyarrow.parquet as pq
import pytest
from places import FIXTURES
from pyarrow import csv
from typer.testing import CliRunner

import erdctl
from erdctl.cli.app import build
from erdctl.model.faults import parse_fault

TABLE_2, LOG = FIXTURES / "table_2.json", FIXTURES / "schedule_60s.csv"
FAULTS = {
    "oil=0.5@100:200": True, "oil=0.5@-9:0": True, "electrical=1.0": True, "oil=0.5@59": False,
    "oil=flow:50": True, "oil=0.5": False,
}  # fmt: skip


def sentence(fault: str) -> str:
    does_nothing = "does nothing in this log, from 0 to 59.995 s: force_model is as without it"
    return f"{parse_fault(fault)} {does_nothing}"


def said(log: Path, *faults: str, more: tuple[str, ...] = ("--quiet",)) -> str:
    options = [word for fault in faults for word in ("--fault", fault)]
    words = ["simulate", str(TABLE_2), str(log), "--format", "parquet", *more, *options]
    run = CliRunner().invoke(build(), words)
    assert run.exit_code == 0
    return run.stderr


@pytest.mark.parametrize("stretches", [False, True])
def test_a_fault_that_does_nothing_is_warned_of(stretches: bool, tmp_path: Path) -> None:
    log = tmp_path / "log.parquet"
    pq.write_table(csv.read_csv(LOG), log)
    with (
        mock.patch("erdctl.io.batches.SMALL", 0),
        mock.patch("erdctl.io.batches.STREAMED", 1 if stretches else 1 << 60),
    ):
        lines = said(log, *FAULTS).splitlines()
    idle = [fault for fault, is_idle in FAULTS.items() if is_idle]
    assert lines == [f"erdctl: warning: {sentence(fault)}" for fault in idle]


@pytest.mark.parametrize(("fault", "idle"), [("electrical=0.5", True), ("deformation=0.5", False)])
def test_a_field_that_never_is_has_no_electrical_fault(
    fault: str, idle: bool, tmp_path: Path
) -> None:
    log = pd.read_csv(LOG).assign(duty=0.0)
    found = erdctl.simulate(TABLE_2, log, faults=[fault])
    assert [r for r in found.remarks if "does nothing" in r] == [sentence(fault)] * idle
    sequence = erdctl.mimic(TABLE_2, log, [fault])
    assert any("does nothing" in r for r in sequence.remarks) == idle


@pytest.mark.parametrize("stretches", [False, True])
def test_a_force_model_that_goes_is_said_to(stretches: bool, tmp_path: Path) -> None:
    log = tmp_path / "log.parquet"
    pd.read_csv(LOG).assign(force_model=1.0).to_parquet(log)
    with (
        mock.patch("erdctl.io.batches.SMALL", 0),
        mock.patch("erdctl.io.batches.STREAMED", 1 if stretches else 1 << 60),
    ):
        assert "the force_model that the log has is not in what is written" in said(log, more=())


def test_dampers_are_one_here() -> None:
    faults = ["oil=0.5,channel=rl", "oil=0.5"]
    found = erdctl.simulate(TABLE_2, LOG, faults=faults)
    assert "faults of channels fl and rl act together on the one damper here" in found.remarks
    alone = erdctl.simulate(TABLE_2, LOG, faults=faults[:1])
    assert not any("channels" in r for r in alone.remarks)


def test_a_call_has_it_among_its_remarks() -> None:
    found = erdctl.simulate(TABLE_2, LOG, faults=["oil=0.5@100:200", "oil=0.5"])
    assert [r for r in found.remarks if "does nothing" in r] == [sentence("oil=0.5@100:200")]
