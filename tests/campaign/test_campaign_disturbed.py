"""The table is the same bit for bit, whoever did the work and whatever came between."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import fleet
import pytest
from campaigns import DAMPERS, MONTHS, AtOnce, begun, entries, rows, run
from dask_workers import DaskWorkers
from typer.testing import CliRunner

from erdctl.campaign import run as room
from erdctl.cli.app import build

ALL = DAMPERS * MONTHS


@pytest.fixture
def here(lab: Path, tmp_path: Path) -> Path:
    """The same logs, of which nothing is done."""
    (tmp_path / "lab").symlink_to(lab / "lab")
    return tmp_path


def until(done: int, folder: Path, process: subprocess.Popen[str]) -> None:
    """Wait for so many logs; the campaign must not be over by then."""
    end = time.monotonic() + 120.0
    while len(entries(folder)) < done:
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < end, "no progress"
        time.sleep(0.01)


def same(lab: Path, here: Path, logs: int = ALL) -> None:
    """The table of an undisturbed campaign, no log lost and none there twice."""
    assert (here / "results.parquet").read_bytes() == (lab / "results.parquet").read_bytes()
    found = [(r["log"], r["command"], r["parameter"]) for r in rows(here / "results.parquet")]
    assert len(found) == len(set(found))
    assert sum(command == "identify" for _, command, _ in found) == 10 * logs
    assert len(entries(here / "results")) == logs


def test_killed_at_random_moments_and_taken_up(
    lab: Path, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A kill -9 loses what was in hand; measure_campaign.py does it 50 times."""
    monkeypatch.chdir(here)
    draw = random.Random(4)
    before = 0
    for by in (signal.SIGKILL, signal.SIGTERM):
        process = begun(here, "results.parquet", "--jobs", "2")
        until(before + draw.randint(1, 7), here / "results", process)
        if by is signal.SIGTERM:  # and one at a time in a folder
            said = command("campaign", "run", "lab", "-o", "other.parquet", "--label", fleet.LABEL,
                           "--keep", "results", code=2)  # fmt: skip
            assert "another campaign is at work there" in said
        process.send_signal(by)
        said = process.communicate()[1]
        assert ("stopped by SIGTERM" in said) == (by is signal.SIGTERM)
        kept = len(entries(here / "results"))
        assert before < kept < ALL
        assert not (here / "results.parquet").exists()
        before = kept
    said = run(here, "results.parquet", "--jobs", "1")
    assert f"{ALL - before} done now, {before} before" in said
    same(lab, here)
    assert not [*here.rglob("*.tmp")]


def test_nothing_is_done_twice_unless_it_changed(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the bytes of a log; by options and version see `test_campaign_plan`."""
    monkeypatch.setattr(room, "here", lambda jobs: room.Crew(AtOnce, lambda: 1))
    monkeypatch.chdir(tmp_path)
    shutil.copytree(lab / "lab", tmp_path / "lab")
    shutil.copytree(lab / "results", tmp_path / "results")
    again = ("campaign", "run", "lab", "--label", fleet.LABEL, "-o")
    assert f"0 done now, {ALL} before" in command(*again, "results.parquet")
    same(lab, tmp_path)
    shutil.copyfile("lab/D04/2020-02.parquet", "lab/D01/2020-01.parquet")
    said = command(*again, "again.parquet", "--keep", "results")
    assert f"1 done now, {ALL - 1} before" in said
    hashes = {r["log"]: r["hash"] for r in rows(tmp_path / "again.parquet")}
    assert hashes["lab/D01/2020-01.parquet"] == hashes["lab/D04/2020-02.parquet"]
    assert len({*hashes.values()}) == ALL - 1


@pytest.fixture
def three_workers(tmp_path: Path) -> Iterator[DaskWorkers]:
    pytest.importorskip("distributed")
    found = DaskWorkers(tmp_path, 3)
    yield found
    found.end()


@pytest.mark.long
def test_a_cluster_that_loses_a_worker(
    tmp_path: Path, three_workers: DaskWorkers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """120 logs by two workers here; by three on a cluster, one killed half-way: the same table.

    And a diagnosis by those that are left.
    """
    logs, here = 120, tmp_path / "here"
    few = ("--effects", "backlash,force_offset")
    short = ("--diagnose-above", "0.05", *few)  # the last months of what wears
    fleet.write(tmp_path / "lab", 12, logs // 12)
    here.mkdir()
    (here / "lab").symlink_to(tmp_path / "lab")
    assert f"{logs} done now, 0 before" in run(here, "results.parquet", "--jobs", "2", *short)
    process = begun(tmp_path, "results.parquet", "--cluster", str(three_workers.file), *short)
    until(logs // 2, tmp_path / "results", process)
    os.kill(three_workers.workers[0].pid, signal.SIGKILL)
    said = process.communicate()[1]
    assert process.returncode == 0, said
    assert f"{logs} done now, 0 before" in said
    same(here, tmp_path, logs)
    found = rows(tmp_path / "results.parquet")
    assert {r["damper"] for r in found if r["command"] == "diagnose"} == {"D07", "D11"}
    monkeypatch.chdir(tmp_path)
    log = "lab/D07/2020-10.parquet"
    for name, more in (("here", ("--jobs", "1")), ("there", ("--cluster", "scheduler.json"))):
        command("diagnose", log, *few, "--max-effects", "1", "-o", f"{name}.json", *more)
    assert Path("here.json").read_bytes() == Path("there.json").read_bytes()


def command(*words: str, code: int = 0) -> str:
    done = CliRunner().invoke(build([words[0]]), [*words], catch_exceptions=False)
    assert done.exit_code == code, done.stderr
    return done.stderr
