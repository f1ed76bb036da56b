"""`erdctl export`: files by suffix, whole or none, exit codes, and what is said."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from dampers import damper
from places import FIXTURES, ROOT
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.export.targets import TARGETS
from erdctl.io.documents import encode, plain
from erdctl.io.parameters import to_document

APP = build(["export", "simulate"])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copy(FIXTURES / "table_2.json", tmp_path / "damper.json")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(words: str, given: bytes | None = None) -> Any:
    return CliRunner().invoke(APP, words.split(), input=given)


def files(folder: Path) -> set[str]:
    return {p.name for p in folder.iterdir()}


@pytest.mark.parametrize(
    ("name", "beside"),
    [
        ("d.dpr", []), ("d.csv", []), ("d.mat", []), ("d.c", ["d.h"]), ("D.CSV", []),
        ("x y.c", ["x y.h"]),
    ],
)  # fmt: skip
def test_each_suffix_makes_its_file(name: str, beside: list[str], folder: Path) -> None:
    done = CliRunner().invoke(APP, ["export", "damper.json", "-o", name])
    assert done.exit_code == 0, done.output
    assert done.stdout == ""
    assert files(folder) == {"damper.json", name, *beside}


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("-o d.txt", "suffix '.txt'"),
        ("-o d", "no suffix"),
        ("-o -", "no suffix"),
        ("", "--output"),
        ("-o d.dpr --duty 1.2", "0..1"),
        ("-o d.dpr --duty nan", "0..1"),
        ("-o d.csv --duty -0.1", "0..1"),
        ("-o d.dpr --duty 0.1 --duty 0.2", "one curve"),
        ("-o d.csv --speed 0", "--speed"),
        ("-o d.csv --speed nan", "--speed"),
        ("-o d.csv --points 1", "--points"),
        ("-o d.csv --amplitude 0", "--amplitude"),
        ("-o d.csv --positive extension", "only for .dpr"),
        ("-o d.csv --emulate oil", ".c"),
        ("-o d.c --duty 0.3", "means nothing for a .c"),
        ("-o d.c --emulate leak", "known are oil, electrical, deformation"),
        ("-o d.c --emulate oil,oil", "twice"),
        ("-o d.c --slew 3", "add --emulate"),
        ("-o d.c --emulate oil --duty-max 2", "highest duty"),
        ("-o d.c --emulate oil --max-temperature nan", "temperature"),
        ("-o d.dpr --fmi 3", "only for .fmu"),
        ("-o nowhere/d.csv", "make it first"),
        ("-o nowhere/d.c", "make it first"),
    ],
)
def test_what_makes_no_sense_is_wrong_usage(words: str, why: str, folder: Path) -> None:
    done = run(f"export damper.json {words}")
    assert done.exit_code == 2, done.output
    assert why in " ".join(done.stderr.split())
    assert files(folder) == {"damper.json"}


@pytest.mark.parametrize("suffix", [".dpr", ".c"])
@pytest.mark.parametrize(
    "given", [b"", b"no JSON", b"{}", b'{"schema": "erdctl.pwm/1"}', b"[" * 9999]
)
def test_unreadable_parameters_are_bad_input(given: bytes, suffix: str, folder: Path) -> None:
    done = run(f"export - -o d{suffix}", given)
    assert done.exit_code == 3, done.output
    assert "stdin" in done.stderr
    assert files(folder) == {"damper.json"}


def test_a_missing_file_is_wrong_usage(folder: Path) -> None:
    assert run("export none.json -o d.csv").exit_code == 2


def test_a_recording_at_fault_gives_no_damper(folder: Path) -> None:
    document = json.loads(Path("damper.json").read_text())
    rig = {"code": "sign", "record": None, "blocks": True, "text": "the force is upside down"}
    document["provenance"]["rig"] = [rig]
    done = run("export - -o d.c", json.dumps(document).encode())
    assert done.exit_code == 3
    assert "upside down" in done.stderr


def test_stdin_and_a_diagnosis_are_taken(folder: Path) -> None:
    params = plain(to_document(damper("coulomb_friction")))
    diagnosis = {"schema": "erdctl.diagnosis/1", "corrected": {"params": params}}
    assert run("export - -o a.csv", encode(params)).exit_code == 0
    assert run("export - -o b.csv", encode(diagnosis)).exit_code == 0
    a, b = (pd.read_csv(f, comment="#") for f in ("a.csv", "b.csv"))
    pd.testing.assert_frame_equal(a, b)


def test_what_belongs_to_the_bench_is_left_out_and_said(folder: Path) -> None:
    Path("p.json").write_bytes(encode(to_document(damper("force_drift", "coulomb_friction"))))
    for name in ("d.dpr", "d.csv", "d.mat", "d.c"):
        done = run(f"export p.json -o {name}")
        assert done.exit_code == 0, done.output
        assert "left out" in done.stderr, name
        assert "force_drift" in done.stderr, name
        assert "coulomb_friction" not in done.stderr, name


def test_what_the_table_costs_is_said_and_quiet_says_nothing(folder: Path) -> None:
    assert "NRMSE" in run("export damper.json -o d.dpr").stderr
    assert run("export damper.json -o d.dpr --quiet").stderr == ""


def test_inputs_are_never_written_over(folder: Path) -> None:
    before = Path("damper.json").read_bytes()
    for suffix in TARGETS:
        shutil.copy("damper.json", f"p{suffix}")
        done = run(f"export p{suffix} -o p{suffix}")
        assert done.exit_code == 2, done.output
        assert Path(f"p{suffix}").read_bytes() == before
    # The header is named by nobody, and still must not take the place of what is read.
    shutil.copy("damper.json", "q.h")
    done = run("export q.h -o q.c")
    assert done.exit_code == 2, done.output
    assert Path("q.h").read_bytes() == before
    assert not Path("q.c").exists()


def test_source_and_header_come_together_or_not_at_all(folder: Path) -> None:
    Path("d.c").write_text("before")
    Path("d.h").mkdir()
    done = run("export damper.json -o d.c")
    assert done.exit_code == 2, done.output
    assert Path("d.c").read_text() == "before"
    assert files(folder) == {"damper.json", "d.c", "d.h"}


def test_the_source_finds_its_header_by_whatever_name(folder: Path) -> None:
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    for name, words in (("front left.c", ()), ("2-mimic.c", ("--emulate", "electrical,oil"))):
        done = CliRunner().invoke(APP, ["export", "damper.json", "-o", name, *words])
        assert done.exit_code == 0, done.output
        strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", name, "-o", "o"]
        subprocess.run([compiler, *strict], check=True)


def test_the_table_follows_simulate_in_the_shell(folder: Path) -> None:
    """A triangle at 50 mm/s under duty 0.3, settled, at mid-stroke: as the table says."""
    assert run("export damper.json -o d.csv --duty 0.3 --points 100 --speed 0.1").exit_code == 0
    drive = "triangle:speed=0.05,amp=0.02,duration=4,duty=0.3"
    assert run(f"simulate damper.json --drive {drive} -o s.csv").exit_code == 0
    table, found = pd.read_csv("d.csv", comment="#"), pd.read_csv("s.csv")
    for way in (-1.0, 1.0):
        row = table.iloc[(table["xdot"] - way * 0.05).abs().argmin()]
        there = found[(found["xdot"] * way > 0) & (found["x"].abs() < 2e-4) & (found["t"] > 1.0)]
        # The row is a hair beside 50 mm/s, and the lag has had longer on a triangle.
        assert there["force_model"].mean() == pytest.approx(row["force"], rel=0.02)


def test_start_up_imports_no_writer() -> None:
    code = (
        "import sys; from erdctl.cli.app import build; build()\n"
        "heavy = ('numpy', 'scipy', 'erdctl.export')\n"
        "print([m for m in sys.modules if m.startswith(heavy)])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    # The words of the help alone, which the pages have too.
    assert done.stdout.strip() == "['erdctl.export', 'erdctl.export.serves']"


def test_every_suffix_is_in_the_help() -> None:
    said = run("export --help").stdout
    for suffix in TARGETS:
        assert suffix in said
    for place in ("dSPACE", "Simulink", "Adams Car", "multibody"):
        assert place in said, place


@pytest.mark.parametrize("logs", [5, [3], [{"name": "a*/ b\n"}]])
@pytest.mark.parametrize("words", ["-o d.c", "-o e.c --emulate oil", "-o d.dpr", "-o d.csv"])
def test_a_provenance_of_any_kind_does_no_harm(folder: Path, logs: object, words: str) -> None:
    document = json.loads((FIXTURES / "table_2.json").read_text())
    (folder / "odd.json").write_text(json.dumps(document | {"provenance": {"logs": logs}}))
    done = run(f"export odd.json {words}")
    assert done.exit_code == 0, done.output
    for source in folder.glob("*.c"):
        assert "a*/" not in source.read_text()
