"""`erdctl convert`, and every format through the other commands."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build

APP = build()
GOOD = FIXTURES / "bad" / json.loads((FIXTURES / "bad" / "index.json").read_text())["good"]
FOREIGN = FIXTURES / "foreign.csv"
TABLE_2 = str(FIXTURES / "table_2.json")
SUFFIXES = [".csv", ".parquet", ".arrow", ".feather", ".mat", ".mf4", ".tdms"]


def erdctl(*arguments: Any, data: bytes | None = None, code: int = 0) -> Any:
    result = CliRunner().invoke(APP, [str(a) for a in arguments], input=data)
    assert result.exit_code == code, result.stderr
    assert "Traceback" not in result.stderr
    return result


@pytest.fixture(scope="module")
def identified() -> bytes:
    return erdctl("identify", GOOD).stdout_bytes


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_commands_read_every_format(tmp_path: Path, identified: bytes, suffix: str) -> None:
    log = tmp_path / f"log{suffix}"
    erdctl("convert", GOOD, log)
    found, expected = (json.loads(d) for d in (erdctl("identify", log).stdout_bytes, identified))
    for direction in ("compression", "release"):
        assert found[direction] == expected[direction]
    params = tmp_path / "params.json"
    params.write_bytes(identified)
    as_file = erdctl("validate", params, log, "--json").stdout_bytes
    as_pipe = erdctl("validate", params, "-", "--json", data=log.read_bytes()).stdout_bytes
    assert json.loads(as_file)["nrmse"] == json.loads(as_pipe)["nrmse"]
    out = tmp_path / f"out{suffix}"
    erdctl("simulate", params, log, "-o", out)
    assert json.loads(erdctl("validate", out, "--json").stdout)["nrmse"] == pytest.approx(
        json.loads(as_file)["nrmse"], rel=1e-12
    )


@pytest.mark.parametrize("format", ["csv", "parquet", "arrow", "mat", "mdf", "tdms"])
def test_through_pipes(format: str) -> None:
    data = erdctl("convert", "-", "-", "--format", format, data=GOOD.read_bytes()).stdout_bytes
    back = erdctl("convert", "-", "-", data=data).stdout_bytes
    assert back == erdctl("convert", GOOD, "-").stdout_bytes


def test_own_names_and_units_in_every_format(tmp_path: Path) -> None:
    maps = ["t=Time[ms]", "x=Defl FL[mm]", "force=F_fl[N]", "duty=PWM[%]", "temperature=Oil [degC]"]
    options = [o for m in maps for o in ("--map", m)]
    rows = erdctl("convert", FOREIGN, "-", *options).stdout.splitlines()
    assert rows[0] == "t,x,force,duty,temperature"
    for suffix in (".mat", ".tdms"):
        erdctl("convert", FOREIGN, tmp_path / f"log{suffix}")
        result = erdctl("convert", tmp_path / f"log{suffix}", "-", *options)
        assert result.stdout.splitlines() == rows
        assert result.stderr == ""


def test_a_unit_by_map_holds_against_the_stored_one(tmp_path: Path) -> None:
    n = 200
    t = np.arange(n) * 1e-3
    fields = [("t", "s"), ("A", "m"), ("force", "N")]
    schema = pa.schema([pa.field(name, pa.float64(), metadata={"unit": u}) for name, u in fields])
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table([t, 5.0 * np.sin(t), 100.0 * t], schema), path)
    result = erdctl("convert", path, "-", "--map", "x=A[mm]")
    assert "the unit of 'A' is m in the file and mm by --map; --map holds" in result.stderr
    assert float(result.stdout.splitlines()[2].split(",")[1]) == 5.0 * np.sin(1e-3) / 1e3
    silent = erdctl("convert", path, "-", "--map", "x=-A")
    assert silent.stderr == ""
    assert float(silent.stdout.splitlines()[2].split(",")[1]) == -5.0 * np.sin(1e-3)


@pytest.mark.parametrize(
    ("unit", "words"),
    [("V", "unit 'V', which is a voltage"), ("lbs force", "'lbs force', which is not a unit")],
)
def test_a_stored_unit_that_does_not_fit(tmp_path: Path, unit: str, words: str) -> None:
    path = tmp_path / "log.parquet"
    schema = pa.schema(
        [("t", pa.float64()), pa.field("force", pa.float64(), metadata={"unit": unit})]
    )
    pq.write_table(pa.table([[0.0, 1.0], [1.0, 2.0]], schema), path)
    result = erdctl("convert", path, tmp_path / "out.csv", code=3)
    assert f"column 'force': stored with {words}; 'force' needs something like N" in result.stderr
    assert result.stderr.count("\n") == 1
    assert not (tmp_path / "out.csv").exists()


def test_wrong_suffix_and_missing_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = erdctl("convert", GOOD, tmp_path / "log.xls", code=2)
    assert "unknown suffix; known are .csv" in result.stderr
    for module, suffix, extra in [("asammdf", ".mf4", "mdf"), ("nptdms", ".tdms", "tdms")]:
        monkeypatch.setitem(sys.modules, module, None)
        result = erdctl("convert", GOOD, tmp_path / f"log{suffix}", code=4)
        assert f"pip install 'erdctl[{extra}]'" in result.stderr
        assert result.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_mimic_lays_mat_out_for_simulink_on_stdout_too(tmp_path: Path) -> None:
    from scipy.io import loadmat

    path = tmp_path / "pwm.mat"
    arguments = ["mimic", TABLE_2, GOOD, "--fault", "oil=0.5", "--duty", "0.2"]
    single = erdctl("convert", GOOD, "-").stdout.splitlines()
    keep = [single[0], *(r for r in single[1:] if r.endswith(single[1].rpartition(",")[2]))]
    (tmp_path / "one.csv").write_text("\n".join(keep) + "\n")
    arguments[2] = str(tmp_path / "one.csv")
    path.write_bytes(erdctl(*arguments, "--format", "mat").stdout_bytes)
    assert loadmat(path)["pwm"].shape == (5, len(keep) - 1)


@pytest.mark.parametrize(
    ("lines", "row", "what"),
    [
        (["0,1", "0.1,1", "0.1,1"], 4, "0.1 s is there twice"),
        (["0,1", "0.2,1", "0.1,1"], 4, "falls from 0.2 s to 0.1 s"),
        (["0,1", "nan,1", "0.1,1"], 3, "expected a number"),
    ],
)
def test_a_time_that_does_not_grow_is_refused(
    lines: list[str], row: int, what: str, tmp_path: Path
) -> None:
    log, out = tmp_path / "log.csv", tmp_path / "out.parquet"
    log.write_text("\n".join(["t,p [bar]", *lines, ""]))
    result = erdctl("convert", log, out, code=3)
    assert f"{log}: row {row}, column 't'" in result.stderr
    assert what in result.stderr
    assert not out.exists()


@pytest.mark.parametrize("suffix", ["csv", "parquet", "in parts"])
def test_runs_whose_time_begins_anew_become_records(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As `inspect` and all others take them; one row out of order is none, and refused."""
    t = np.concatenate([np.arange(30) * 0.25, np.arange(20) * 0.25])
    names = ["log:1"] * 30 + ["log:2"] * 20
    log = tmp_path / f"log.{suffix.replace('in parts', 'parquet')}"
    if suffix == "in parts":
        monkeypatch.setattr("erdctl.io.batches.SMALL", 0)
        monkeypatch.setattr("erdctl.io.batches.STREAMED", 1)
        monkeypatch.setattr("erdctl.io.convert.LONG", 7)

    def write(t: np.ndarray) -> None:
        table = pa.table({"t": t, "p": t + 1.0})
        if suffix == "csv":
            log.write_text("t,p\n" + "".join(f"{a},{a + 1}\n" for a in t))
        else:
            pq.write_table(table, log, row_group_size=9)

    write(t)
    result = erdctl("convert", log, tmp_path / "out.parquet")
    row = 32 if suffix == "csv" else 31
    assert f"time begins anew in row {row}; taken as 2 records" in result.stderr
    found = pq.read_table(tmp_path / "out.parquet")
    assert found["record"].to_pylist() == names
    assert found["t"].to_pylist() == t.tolist()
    on = erdctl("convert", "--running-time", log, "-").stdout.splitlines()
    assert [float(line.split(",")[0]) for line in on[1:]] == (np.arange(50) * 0.25).tolist()
    t[10] = t[8]
    write(t)
    refused = erdctl("convert", log, tmp_path / "no.parquet", code=3)
    assert "column 't': time must grow" in refused.stderr


def test_records_that_come_back_are_refused(tmp_path: Path) -> None:
    log, out = tmp_path / "log.csv", tmp_path / "out.parquet"
    log.write_text("t,record\n0,a\n0,b\n1,a\n")
    result = erdctl("convert", log, out, code=3)
    assert "row 4, column 'record': record 'a' comes back" in result.stderr
    assert not out.exists()


def test_values_out_of_range_are_converted_and_said(tmp_path: Path) -> None:
    log, out = tmp_path / "log.csv", tmp_path / "out.csv"
    log.write_text("t,x,duty,p\n0,0.01,30,5\n1,12,40,6\n")
    result = erdctl("convert", log, out)
    warnings = [x for x in result.stderr.splitlines() if x.startswith("erdctl: warning")]
    assert len(warnings) == 2
    assert f"{log}: row 3, column 'x': found 12" in warnings[0]
    assert f"{log}: row 2, column 'duty': found 30" in warnings[1]
    assert out.read_text() == "t,x,duty,p\n0,0.01,30,5\n1,12,40,6\n"


def test_units_of_a_row_stay_with_columns_that_are_no_log(tmp_path: Path) -> None:
    log, out = tmp_path / "log.csv", tmp_path / "out.csv"
    log.write_text("t;p;n;x\ns;bar;-;mm\n0;5.5;1;2\n1;6.5;2;2.5\n")
    erdctl("convert", log, out)
    assert out.read_text() == "t,p [bar],n,x\n0,5.5,1,0.002\n1,6.5,2,0.0025\n"


def test_one_row_and_no_rows_are_converted(tmp_path: Path) -> None:
    for rows in ("", "0,1\n"):
        log, out = tmp_path / "log.csv", tmp_path / "out.csv"
        log.write_text(f"t,x\n{rows}")
        erdctl("convert", log, out)
        assert out.read_text() == f"t,x\n{rows}"


def test_a_time_that_goes_on(tmp_path: Path) -> None:
    """From record to record, by a median step; all else as it was, through a pipe as well."""
    table = pa.table({
        "t": [0.0, 0.5, 1.0, 10.0, 10.5, 0.0, 0.5],
        "x": np.arange(7.0) * 1e-3, "force": np.arange(7.0), "record": list("aaabbcc"),
    })  # fmt: skip
    pq.write_table(table, tmp_path / "log.parquet")
    erdctl("convert", "--running-time", tmp_path / "log.parquet", tmp_path / "on.parquet")
    found = pq.read_table(tmp_path / "on.parquet")
    assert found["t"].to_pylist() == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0])
    assert found.drop_columns("t").to_pydict() == table.drop_columns("t").to_pydict()
    data = erdctl("convert", "--running-time", tmp_path / "log.parquet", "-").stdout_bytes
    back = erdctl("convert", "-", "-", "--format", "arrow", data=data).stdout_bytes
    assert pa.ipc.open_stream(back).read_all()["t"].to_pylist() == found["t"].to_pylist()
    pq.write_table(table.drop_columns("record"), tmp_path / "one.parquet")
    refused = erdctl("convert", "--running-time", tmp_path / "one.parquet", "-", code=3)
    assert "one.parquet" in refused.stderr
