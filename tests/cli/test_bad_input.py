"""Every kind of bad input: one line with the place, the documented exit code, nothing written."""

from __future__ import annotations

import json
import math
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build

APP = build()
BAD = FIXTURES / "bad"
INDEX = json.loads((BAD / "index.json").read_text())
TABLE_2 = json.loads((FIXTURES / "table_2.json").read_text())


def run(*arguments: str, data: bytes | None = None) -> Any:
    return CliRunner().invoke(APP, list(arguments), input=data, catch_exceptions=True)


def check_clean(result: Any) -> None:
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("case", INDEX["cases"], ids=lambda c: c["file"])
def test_bad_file(case: dict[str, Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(BAD)
    out = tmp_path / "out.json"
    result = run(*case["arguments"], *(["-o", str(out)] if case["command"] != "validate" else []))
    check_clean(result)
    assert result.exit_code == case["exit_code"], result.stderr
    errors = [line for line in result.stderr.splitlines() if line.startswith("erdctl: error:")]
    assert len(errors) == 1, result.stderr
    for word in case["mentions"]:
        assert word.casefold() in errors[0].casefold(), errors[0]
    assert not os.listdir(tmp_path)
    assert result.stdout == ""


def test_the_good_log_is_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(BAD)
    assert run("identify", INDEX["good"]).exit_code == 0


@st.composite
def logs(draw: st.DrawFn) -> dict[str, Any]:
    """Logs that are mostly sound, in sizes down to nothing, with some values spoiled."""
    n = draw(st.integers(2, 80))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    t = np.cumsum(rng.uniform(1e-4, 0.1, n))
    columns: dict[str, Any] = {
        "t": t,
        "x": rng.uniform(-0.02, 0.02, n),
        "duty": rng.choice([0.0, 0.1, 0.3, 1.0], n),
        "force": rng.normal(size=n) * draw(st.sampled_from([0.0, 1.0, 1e6])),
    }
    if draw(st.booleans()):
        columns["xdot"] = rng.normal(size=n) * draw(st.sampled_from([0.0, 0.1]))
    if draw(st.booleans()):
        columns["record"] = np.sort(rng.integers(0, 3, n)).astype(str)
    for _ in range(draw(st.integers(0, 2))):
        name = draw(st.sampled_from(["t", "x", "duty", "force"]))
        at = draw(st.integers(0, n - 1))
        value = draw(st.sampled_from([math.nan, math.inf, -1.0, 0.0, 1e9, 1e300, 5e-324]))
        columns[name] = columns[name].copy()
        columns[name][at] = value
    if draw(st.integers(0, 9)) == 0:
        del columns[draw(st.sampled_from(["t", "x", "force"]))]
    return columns


FUZZ = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@FUZZ
@given(columns=logs(), command=st.sampled_from(["identify", "simulate", "validate", "mimic"]))
def test_any_log_gives_numbers_or_one_line(
    columns: dict[str, Any], command: str, tmp_path: Path
) -> None:
    log, out = tmp_path / "log.parquet", tmp_path / "out"
    pq.write_table(pa.table(columns), log)
    params = str(FIXTURES / "table_2.json")
    arguments = {
        "identify": ["identify", str(log)],
        "simulate": ["simulate", params, str(log)],
        "validate": ["validate", params, str(log), "--json"],
        "mimic": ["mimic", params, str(log), "--fault", "oil=0.5"],
    }[command]
    result = run(*arguments)
    check_clean(result)
    assert result.exit_code in (0, 3, 4), result.stderr
    assert not out.exists()
    if result.exit_code:
        assert sum(s.startswith("erdctl: error:") for s in result.stderr.splitlines()) == 1
    elif command in ("simulate", "mimic"):
        # Columns that the command does not need pass through as they are; its own are finite.
        own = {"force_model", "force_expected", "force_ideal", "duty_fl"}
        header, *rows = (line.split(",") for line in result.stdout.splitlines())
        at = [i for i, name in enumerate(header) if name in own]
        assert at
        assert all(math.isfinite(float(row[i])) for row in rows for i in at)
    elif command == "identify":
        assert "NaN" not in result.stdout


JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=5,
)  # fmt: skip


@FUZZ
@given(data=st.data())
def test_any_parameter_file_gives_numbers_or_one_line(data: st.DataObject) -> None:
    document = json.loads(json.dumps(TABLE_2))
    for _ in range(data.draw(st.integers(1, 3))):
        place, key = document, data.draw(st.sampled_from(sorted(document)))
        while isinstance(place[key], dict) and place[key] and data.draw(st.booleans()):
            place, key = place[key], data.draw(st.sampled_from(sorted(place[key])))
        if data.draw(st.booleans()):
            place[key] = data.draw(JSON)
        else:
            del place[key]
        if not document:
            break
    drive = "sine:duration=1,fs=50,duty=0|0.3"
    result = run("simulate", "-", "--drive", drive, data=json.dumps(document).encode())
    check_clean(result)
    assert result.exit_code in (0, 3), result.stderr
    if result.exit_code == 0:
        assert "nan" not in result.stdout.lower()


@FUZZ
@given(noise=st.binary(max_size=400))
def test_any_bytes_on_stdin(noise: bytes) -> None:
    for arguments in (["identify", "-"], ["simulate", str(FIXTURES / "table_2.json"), "-"]):
        result = run(*arguments, data=noise)
        check_clean(result)
        assert result.exit_code in (0, 3), result.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are text here")
@pytest.mark.parametrize(
    "words",
    [
        "inspect {} --json", "identify {} -o out.json", "convert {} out.mat", "plot {} -o a.png",
        "simulate {p} {} -o out.parquet", "validate {p} {} --report r.html --plot time:a.svg",
        "mimic {p} {} --fault oil=0.5 -o out.csv --report r.html", "identify {} {good} -o out.json",
    ],
)  # fmt: skip
def test_names_of_files_that_are_no_text(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name = os.fsdecode(b"\x1b[2Jlog\xff.csv")
    Path(name).write_bytes((BAD / "good.csv").read_bytes())
    known = {"{}": name, "{p}": str(FIXTURES / "table_2.json"), "{good}": str(BAD / "good.csv")}
    result = run(*(known.get(w, w) for w in words.split()))
    assert result.exit_code == 0, result.stderr
    assert "\x1b" not in result.stderr
