"""`erdctl campaign run`: the table, the documents, and logs that cannot be done."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from datetime import datetime
from pathlib import Path
from typing import Any

import fleet
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.csv as pc
import pyarrow.parquet as pq
import pytest
from campaigns import AtOnce, document, rows
from typer.testing import CliRunner

import erdctl
from erdctl.campaign import run as room
from erdctl.campaign.labels import Labels
from erdctl.campaign.plan import Job, StepOptions
from erdctl.campaign.work import Done, failed
from erdctl.cli.app import build
from erdctl.core import cluster
from erdctl.core.errors import ComputationProblem
from erdctl.io.campaign_journal import Entry, journal
from erdctl.io.campaign_table import NAME, SCHEMA


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Worker processes are those of `test_campaign_disturbed`."""
    monkeypatch.setattr(room, "here", lambda jobs: room.Crew(AtOnce, lambda: 1))


def campaign(*words: str, code: int = 0) -> str:
    done = CliRunner().invoke(
        build(["campaign"]), ["campaign", "run", *words], catch_exceptions=False
    )
    assert done.exit_code == code, done.stderr
    return done.stderr


def test_the_table_holds_what_the_commands_find(lab: Path) -> None:
    table = lab / "results.parquet"
    schema = pq.read_schema(table)
    assert (schema.names, schema.metadata[b"schema"]) == (SCHEMA.names, NAME.encode())
    found = rows(table)
    assert [r["log"] for r in found] == sorted(r["log"] for r in found)
    row = found[0]
    path = lab / row["log"]
    damper = erdctl.identify(path, damper="D01", date="2020-01-01")
    estimate = damper.parameters.estimates["compression.k_nom"]
    scores = erdctl.validate(damper, path)
    assert row["command"] == "identify"
    assert row["parameter"] == "compression.k_nom"
    assert row["unit"] == "N/m"
    numbers = [row[k] for k in ("value", "stderr", "nrmse", "nrmse_worst", "noise_rms")]
    worst = max(s.nrmse for s in scores.scores.by_duty.values())
    noise = damper.to_dict()["provenance"]["noise_rms"]
    assert numbers == pytest.approx(
        [estimate.value, estimate.stderr, scores.nrmse, worst, noise], rel=1e-9
    )
    assert row["low"] < row["value"] < row["high"]
    assert row["hash"] == damper.log.recording.sources[0].sha256
    assert (row["damper"], row["date"]) == ("D01", datetime(2020, 1, 1))
    assert (row["exit_code"], row["error"], row["verdict"]) == (0, None, None)
    said = document(table, row, "identify")
    assert said["compression"]["k_nom"]["value"] == row["value"]
    assert said["provenance"]["damper"] == "D01"
    assert document(table, row, "validate")["nrmse"] == row["nrmse"]


def test_wear_shows(lab: Path) -> None:
    """The leak in a parameter; play and preload, which the paper's model lacks, in the score."""
    found = rows(lab / "results.parquet")

    def course(damper: str, field: str) -> list[float]:
        return [
            r[field] for r in found
            if r["damper"] == damper and r["parameter"] == "compression.c_vis"
        ]  # fmt: skip

    leak = np.array(course("D01", "value"))
    assert leak[-1] / leak[0] == pytest.approx(0.6, abs=0.02)
    assert np.ptp(course("D04", "value")) < 0.02 * leak[0]
    for damper in ("D02", "D03"):
        nrmse = course(damper, "nrmse")
        assert max(nrmse[:2]) < 0.004 < 0.012 < nrmse[-1]
    assert max(course("D04", "nrmse")) < 0.004


def bad_logs(folder: Path) -> dict[str, tuple[int, str]]:
    """A log that is sound, and those that are not: exit code, and a part of the error."""
    sound = fleet.log(9, 0, fleet.Health())
    folder.mkdir()
    pq.write_table(sound, folder / "sound.parquet")
    data = (folder / "sound.parquet").read_bytes()
    (folder / "cut.parquet").write_bytes(data[: len(data) // 2])
    (folder / "empty.csv").write_bytes(b"")
    pc.write_csv(sound, folder / "text.csv")
    lines = (folder / "text.csv").read_text().splitlines()
    lines[40] = ",".join(["0.195", "n/a", *lines[40].split(",")[2:]])
    (folder / "text.csv").write_text("\n".join(lines))
    still = sound.set_column(1, "x", [np.zeros(len(sound))]).set_column(
        2, "xdot", [np.zeros(len(sound))]
    )
    pq.write_table(still, folder / "still.parquet")
    return {
        "cut.parquet": (3, "damaged or cut off parquet"),
        "empty.csv": (3, "empty; expected a bench log"),
        "gone.csv": (2, "does not exist"),
        "still.parquet": (3, ""),
        "text.csv": (3, "row 41, column 'x'"),
    }


def test_a_bad_log_is_a_row_with_its_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    bad = bad_logs(tmp_path / "logs")
    said = campaign("logs", "logs/gone.csv", "-o", "r.parquet", "--jobs", "1", code=1)
    found = rows(tmp_path / "r.parquet")
    assert len(found) == len(bad) + 10
    for row in found:
        name = row["log"].removeprefix("logs/")
        code, error = bad.get(name, (0, ""))
        assert row["exit_code"] == code, row["error"]
        if code:
            assert error in row["error"]
            assert "\n" not in row["error"]
            assert row["parameter"] is None
            assert row["value"] is None
            assert row["error"] in said
            assert (row["hash"] is None) == (name == "gone.csv")
        else:
            assert row["error"] is None
    assert "error: 5 of 6 could not be done" in said
    # What is bad and unchanged is not tried again; what was not there is.
    said = campaign("logs", "logs/gone.csv", "-o", "r.parquet", "--jobs", "1", code=1)
    assert "1 done now, 5 before" in said
    assert rows(tmp_path / "r.parquet") == found
    # A table among the logs is none of them; a log is not written over.
    said = campaign("logs/sound.parquet", ".", "-o", "r.parquet", "--jobs", "1", code=1)
    assert len(rows(tmp_path / "r.parquet")) == len(bad) - 1 + 10
    assert "written over a log" in campaign("logs", "-o", "logs/sound.parquet", code=2)


def test_only_what_falls_short_is_diagnosed(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for damper in ("D02", "D04"):
        (tmp_path / damper).mkdir()
        shutil.copy(lab / "lab" / damper / "2020-06.parquet", tmp_path / damper)
    campaign("D0?/*.parquet", "-o", "r.parquet", "--diagnose-above", "0.01", "--jobs", "1",
             "--label", fleet.LABEL, "--effects", "backlash,coulomb_friction")  # fmt: skip
    found = rows(tmp_path / "r.parquet")
    worn = [r for r in found if r["damper"] == "D02"]
    sound = [r for r in found if r["damper"] == "D04"]
    assert {r["command"] for r in sound} == {"identify"}
    assert sound[0]["findings"] is None
    assert [r["command"] for r in worn] == ["identify"] * 10 + ["diagnose"] * 12
    assert (worn[0]["verdict"], worn[0]["findings"]) == ("explained", ["backlash"])
    named, unnamed = worn[-2:]
    assert (unnamed["parameter"], unnamed["value"]) == ("coulomb_friction.F_c", None)
    assert 0.0 < unnamed["high"] < 1.0  # from so much on it would have been named
    assert (named["parameter"], named["unit"]) == ("backlash.g", "m")
    assert named["value"] == pytest.approx(2e-3, rel=0.05)
    assert document(tmp_path / "r.parquet", named, "diagnose")["verdict"] == "explained"


def test_one_identification_over_the_logs_of_a_damper(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(lab)
    logs = sorted(str(p.relative_to(lab)) for p in (lab / "lab" / "D04").glob("2020-0[1-3]*"))
    campaign(*logs, "-o", str(tmp_path / "r.parquet"), "--group-by", "damper", "--label",
             fleet.LABEL, "--steps", "inspect,identify", "--jobs", "1")  # fmt: skip
    found = rows(tmp_path / "r.parquet")
    assert {r["log"] for r in found} == {"damper=D04"}
    assert found[0]["logs"] == logs
    assert found[0]["date"] is None
    assert found[0]["nrmse"] is None
    pooled = erdctl.identify(logs)
    values = {r["parameter"]: r["value"] for r in found}
    assert values == pytest.approx(pooled.parameters.values, rel=1e-9)
    assert len(document(tmp_path / "r.parquet", found[0], "inspect")["records"]) == 3 * len(
        fleet.RECORDS
    )


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["no/*.csv"], "no log there"),
        (["-"], "the list is empty"),
        (["a.csv", "--steps", "guess"], "--steps takes"),
        (["a.csv", "--group-by", "damper"], "say with --label"),
        (["a.csv", "--effects", "phlogiston"], "phlogiston"),
        (["a.csv", "--accept", "phlogiston"], "no rig check"),
        (["a.csv", "--cluster", "tcp://a:1", "--jobs", "2"], "--jobs is for this machine"),
    ],
)
def test_what_makes_no_sense_is_refused_before_all(
    words: list[str], error: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert error in campaign(*words, "-o", "r.parquet", code=2)
    assert [p.name for p in tmp_path.iterdir()] == []


def test_no_cluster_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cluster, "PATIENCE", 0.2)
    words = ("a.csv", "-o", "r.parquet", "--cluster")
    assert "none.json: no such scheduler file" in campaign(*words, "none.json", code=2)
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert "pip install 'erdctl[cluster]'" in campaign(*words, "tcp://127.0.0.1:1", code=4)
    monkeypatch.undo()
    pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cluster, "PATIENCE", 0.2)
    said = campaign(*words, "tcp://127.0.0.1:1", code=4)
    assert said.startswith("erdctl: error: --cluster tcp://127.0.0.1:1: no Dask scheduler there")
    assert len(said.splitlines()) == 1


def job(name: str) -> Job:
    return Job(name=name, paths=(name,), labels=Labels(), asked=StepOptions())


class Fragile(Executor):
    """Does jobs in its own way; its workers all die of one that is called so."""

    def __init__(self, deadly: str, begun: list[str], ends: Callable[[], BaseException]) -> None:
        self.deadly, self.begun, self.ends, self.broken = deadly, begun, ends, False

    def submit(self, fn: Any, /, *args: Any, **options: Any) -> Future[Any]:
        (given,) = args
        self.begun.append(given.name)
        self.broken |= given.name == self.deadly
        out: Future[Any] = Future()
        if self.broken:
            out.set_exception(self.ends())
        else:
            key = {"key": given.key, "log": given.name, "logs": [], "version": "0"}
            out.set_result(Done(Entry(**key)))
        return out


def test_of_a_log_that_kills_its_worker_the_others_do_not_suffer(tmp_path: Path) -> None:
    jobs, begun = [job(name) for name in "abcdef"], list[str]()
    crew = room.Crew(lambda: Fragile("a", begun, BrokenExecutor), lambda: 3)
    with journal(str(tmp_path)) as kept:
        room.run(jobs, kept, crew)
        found = {e.log: e for e in room.entries(jobs, kept)}
    assert [*found] == [*"abcdef"]
    assert [name for name, e in found.items() if e.error] == ["a"]
    assert found["a"].error == failed(jobs[0], room.DIED).entry.error
    assert [begun.count(name) for name in "abcd"] == [2, 2, 2, 1]  # among others, and alone


def test_a_cluster_that_has_gone(tmp_path: Path) -> None:
    jobs = [job(name) for name in "abcd"]
    crew = room.Crew(lambda: Fragile("c", [], CancelledError), lambda: 1)
    with journal(str(tmp_path)) as kept:
        with pytest.raises(ComputationProblem, match="what was done is kept"):
            room.run(jobs, kept, crew)
        assert [kept.read(j.key) is not None for j in jobs] == [True, True, False, False]


def test_a_project_file_says_how_logs_are_read_and_of_which_damper(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = pq.read_table(min((lab / "lab").rglob("*.parquet")))
    plain, foreign = (tmp_path / name for name in ("plain.csv", "raw/D07_20240501.csv"))
    foreign.parent.mkdir()
    pc.write_csv(log, plain)
    millimetres = pa.array(1e3 * log["x"].to_numpy())
    other = log.set_column(log.column_names.index("x"), "Weg (mm)", millimetres)
    pc.write_csv(other, foreign)
    (tmp_path / "erdctl.toml").write_text(
        "[labels]\npath = '(?P<damper>D[0-9]+)_(?P<date>[0-9]+)'\ndate = '%Y%m%d'\n"
        "[damper.D07.columns]\nx = 'Weg (mm)[mm]'\nduty = 'duty'\nt = 't'\nforce = 'force'\n"
    )
    monkeypatch.chdir(tmp_path)
    said = campaign("raw", "-o", "by_project.parquet")
    assert "erdctl.toml: columns" in said
    campaign("plain.csv", "-o", "plain.parquet", "--no-project")
    ours, theirs = rows(tmp_path / "by_project.parquet"), rows(tmp_path / "plain.parquet")
    assert {(r["damper"], str(r["date"])[:10]) for r in ours} == {("D07", "2024-05-01")}
    assert [r["value"] for r in ours] == pytest.approx([r["value"] for r in theirs], rel=1e-9)


def test_a_project_file_holds_as_it_does_for_every_other_command(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A log of SI columns, one of two dampers, the command line that wins, labels of both."""
    log = pq.read_table(min((lab / "lab").rglob("*.parquet"))).to_pandas()
    log.to_csv(tmp_path / "A01_20240501_40C.csv", index=False)
    harder = log.assign(force=2 * log["force"])
    two = pd.concat([log.assign(who="FL"), harder.assign(who="FR")])
    two.assign(Weg=1e3 * two.pop("x")).to_csv(tmp_path / "two.csv", index=False)
    (tmp_path / "erdctl.toml").write_text(
        "[labels]\npath = '(?P<damper>A[0-9]+)_(?P<date>[0-9]+)'\ncolumns = {damper = 'who'}\n"
        "[columns]\nx = 'Weg[mm]'\n[where]\nwho = ['FL']\n"
    )
    monkeypatch.chdir(tmp_path)
    logs = ("A01_20240501_40C.csv", "two.csv")
    label = ("--label", "(?P<oil>[0-9]+C)")
    said = campaign(*logs, "-o", "by.parquet", *label)
    assert "by erdctl.toml: columns x; where who\n" in said
    one, left = ([r for r in rows(tmp_path / "by.parquet") if r["log"] == name] for name in logs)
    assert {(r["damper"], str(r["date"])[:10]) for r in one} == {("A01", "2024-05-01")}
    assert dict(one[0]["conditions"]) == {"oil": "40C"}
    assert {r["damper"] for r in left} == {"FL"}
    assert [r["value"] for r in left] == pytest.approx([r["value"] for r in one], rel=1e-6)
    assert "2 before" in campaign(*logs, "-o", "by.parquet", *label)
    campaign("two.csv", "-o", "right.parquet", "--where", "who=FR")
    right = rows(tmp_path / "right.parquet")
    assert {r["damper"] for r in right} == {"FR"}
    stiffness = [r["value"] for r in (*left, *right) if r["parameter"] == "release.k_nom"]
    assert stiffness[1] == pytest.approx(2 * stiffness[0], rel=1e-3)
