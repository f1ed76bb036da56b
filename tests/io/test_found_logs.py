"""Paths, folders, patterns, lists and URLs of logs."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from places import FIXTURES

import erdctl
from erdctl.core.errors import UsageProblem
from erdctl.io.found_logs import find_logs
from erdctl.io.urls import fetch, is_url


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("a/1.csv", "a/2.parquet", "b/c/3.txt", "b/notes.md", "b/.hidden.csv", "r.parquet"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_each_log_once_in_order(lab: Path) -> None:
    found = ["a/1.csv", "a/2.parquet", "b/c/3.txt"]
    assert find_logs([".", "a"]) == [f"./{name}" for name in (*found, "r.parquet")]
    assert find_logs(["b", "a/*", "a/1.csv", str(lab / "a/1.csv")])[-2:] == [
        "a/2.parquet",
        found[2],
    ]
    assert find_logs(["**/*.csv"]) == ["a/1.csv"]
    listed = io.StringIO("b/c/3.txt\n\n  a/1.csv\n")
    assert find_logs(["-"], listed=listed) == ["a/1.csv", "b/c/3.txt"]
    assert find_logs(["gone.csv"]) == ["gone.csv"]  # which is for its row to say


def test_what_a_folder_may_hold_besides(lab: Path) -> None:
    for name in ("a/3.LVM", "a/4.tsv", "a/5.log", "a/6.csv.gz", "a/.7.log"):
        (lab / name).write_text(name)
    said: list[str] = []
    assert find_logs(["a"], report=said.append) == ["a/1.csv", "a/2.parquet", "a/3.LVM", "a/4.tsv"]
    assert said == ["left out in a: 1 .gz, 1 .log; if these are logs, name them, as by a pattern"]
    assert find_logs(["a/*.log"], report=said.append) == ["a/5.log"]


@pytest.mark.parametrize("place", ["c/*.csv", "empty", "file:///no/such/*.csv"])
def test_nothing_there(place: str, lab: Path) -> None:
    (lab / "empty").mkdir()
    with pytest.raises(UsageProblem, match="no log there"):
        find_logs([place])


def test_urls(lab: Path) -> None:
    root = lab.as_uri()
    assert is_url(root)
    assert find_logs([f"{root}/**/*.csv"]) == [f"{root}/a/1.csv", f"{root}/b/.hidden.csv"]
    assert find_logs([f"{root}/a/*"]) == [f"{root}/a/1.csv", f"{root}/a/2.parquet"]
    assert find_logs([f"{root}/a/1.csv"]) == [f"{root}/a/1.csv"]
    assert fetch(f"{root}/a/1.csv") == b"a/1.csv"
    for wrong in (f"{root}/gone.csv", "nonsense://a/b.csv"):
        with pytest.raises(UsageProblem, match=wrong.rpartition("/")[2]):
            fetch(wrong)


def test_a_log_by_url_is_the_same_log() -> None:
    path = FIXTURES / "foreign.csv"
    map = {"t": "Time[ms]", "x": "Defl FL[mm]", "force": "F_fl[N]", "duty": "PWM[%]"}
    a, b = (erdctl.read(p, map=map).recording for p in (path, path.as_uri()))
    assert (a.force == b.force).all()
    assert a.sources[0].sha256 == b.sources[0].sha256
    assert b.sources[0].name == path.as_uri()
    assert a.names == b.names
