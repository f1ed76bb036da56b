"""What `compare` reads: campaign tables, documents, bands; and what is wrong with them."""

from __future__ import annotations

import json
import time
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from fleets import draw
from places import FIXTURES

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.campaign_in import as_declared, histories
from erdctl.io.campaign_out import instant
from erdctl.io.campaign_table import SCHEMA
from erdctl.io.limits_file import read_limits
from erdctl.io.states import read_inputs

TABLE_2 = json.loads((FIXTURES / "table_2.json").read_text())


def table(rows: list[dict[str, Any]]) -> pa.Table:
    full = [{"version": "0", "exit_code": 0, **row} for row in rows]
    return pa.table({f.name: [r.get(f.name) for r in full] for f in SCHEMA}, schema=SCHEMA)


def test_a_diagnosis_wins_over_the_identification_of_the_same_log() -> None:
    row = {"log": "a", "damper": "D", "parameter": "compression.c_vis", "unit": "N s/m"}
    found = histories(table([{**row, "command": "diagnose", "value": 2.0, "verdict": "explained"},
                             {**row, "command": "identify", "value": 1.0}]))  # fmt: skip
    assert found[0].series["compression.c_vis"].value.tolist() == [2.0]


def test_an_effect_is_absent_where_it_is_not_named() -> None:
    rows = [
        {
            "log": "a",
            "damper": "D",
            "parameter": "compression.c_vis",
            "value": 1.0,
            "unit": "N s/m",
        },
        {"log": "a", "damper": "D", "parameter": "backlash.g", "high": 3e-4, "unit": "m"},
        {"log": "b", "damper": "D", "parameter": "backlash.g", "value": 1e-3, "unit": "m"},
    ]
    g = histories(table(rows))[0].series["backlash.g"]
    assert np.isnan(g.value).tolist() == [True, False]
    assert g.limit[0] == 3e-4
    assert g.off == 0.0


def test_logs_are_in_the_order_of_their_dates_and_dampers_have_corners() -> None:
    rows = [
        {"log": log, "damper": "car 1", "corner": corner, "parameter": "release.beta", "unit": "1",
         "value": 0.5, "date": datetime(2024, month, 1)}
        for log, corner, month in (("b", "fl", 2), ("a", "fl", 1), ("c", "rr", 1))
    ]  # fmt: skip
    found = histories(table(rows))
    assert [h.damper for h in found] == ["car 1 fl", "car 1 rr"]
    assert found[0].logs == ("a", "b")
    assert found[0].dated


def test_logs_with_errors_are_told() -> None:
    rows = [
        {"log": "a", "damper": "D", "error": "no column x", "exit_code": 3},
        {"log": "b", "damper": "D", "parameter": "release.beta", "unit": "1", "value": 0.5},
    ]
    found = histories(table(rows))[0]
    assert found.failed == (("a", "no column x"),)
    assert found.logs == ("b",)


def test_an_older_table_lacks_columns() -> None:
    drawn, _ = draw(1, dampers=1, months=3)
    some = drawn.select(["log", "parameter", "unit", "value", "stderr", "exit_code", "version"])
    assert as_declared(some, "t").schema.names == SCHEMA.names
    with pytest.raises(InputProblem, match="no column 'value'"):
        as_declared(some.drop_columns(["value"]), "t")
    other = some.replace_schema_metadata({"schema": "something/2"})
    with pytest.raises(InputProblem, match="something/2"):
        as_declared(other, "t")


def test_values_that_are_none() -> None:
    row = {"log": "a", "parameter": "release.beta", "unit": "1", "value": 0.5, "stderr": -1.0}
    with pytest.raises(InputProblem, match="row 1, column 'stderr'"):
        as_declared(table([row]), "t")


def test_documents_become_rows(tmp_path: Path) -> None:
    document = json.loads(json.dumps(TABLE_2))
    document["provenance"] = {"date": "2024-05-01T10:00", "damper": "D7", "noise_rms": 0.3}
    document["fits"] = {"correlation": {"parameters": ["compression.k_nom", "release.k_nom"],
                                        "lower": [[], [0.25]]}}  # fmt: skip
    document["effects"] = [
        {"effect": "backlash", "parameters": {"g": {"value": 2e-3, "stderr": 1e-5}}}
    ]
    path = tmp_path / "a.json"
    path.write_text(json.dumps(document))
    given = read_inputs([str(path)])
    found = histories(given.table, given.covariances)[0]
    assert found.damper == "D7"
    assert found.effects == (frozenset({"backlash"}),)
    assert found.series["backlash.g"].value.tolist() == [2e-3]
    assert found.covariances[0].correlation[1, 0] == 0.25
    assert given.documents


@pytest.mark.parametrize("wrong", ["", [0.1], None, {}, 1.5, "0.25"])
def test_a_correlation_that_is_none_is_left_out(wrong: object, tmp_path: Path) -> None:
    """It ended with an internal error."""
    told = {"parameters": ["compression.k_nom", "release.k_nom"], "lower": [[], [wrong]]}
    path = tmp_path / "a.json"
    path.write_text(json.dumps({**TABLE_2, "fits": {"correlation": told}}))
    assert not read_inputs([str(path)]).covariances


@pytest.mark.parametrize("here", ["UTC", "America/New_York"])
def test_a_date_with_a_time_zone_is_that_of_a_campaign_wherever_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, here: str
) -> None:
    at = "2024-05-01T01:00+02:00"
    path = tmp_path / "a.json"
    path.write_text(json.dumps({**TABLE_2, "provenance": {"date": at}}))
    monkeypatch.setenv("TZ", here)
    time.tzset()
    try:
        found = read_inputs([str(path)]).table["date"][0].as_py()
    finally:
        monkeypatch.undo()
        time.tzset()
    assert found == instant(at) == datetime(2024, 4, 30, 23)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"{}", 'no field "schema"'),
        (b'{"schema": "erdctl.validation/1"}', "erdctl.validation/1"),
        (b"PAR1 and no more", "no campaign table"),
        (b"", "empty"),
    ],
)
def test_files_that_are_neither(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "x"
    path.write_bytes(content)
    with pytest.raises(InputProblem, match=said):
        read_inputs([str(path)])


def test_a_file_twice(tmp_path: Path) -> None:
    with pytest.raises(UsageProblem, match="twice"):
        read_inputs(["a.json", "a.json"])


def test_bands_in_units_and_in_both_directions(tmp_path: Path) -> None:
    path = tmp_path / "limits.toml"
    path.write_text('c_vis = { low = 40, high = 60 }\n"backlash.g" = { high = "0.5 mm" }\n'
                    "[release.sigma]\nlow = 10\n")  # fmt: skip
    found = {r.name: r for r in read_limits(str(path))}
    assert set(found) == {"compression.c_vis", "release.c_vis", "backlash.g", "release.sigma"}
    assert found["backlash.g"].band.high == pytest.approx(5e-4)
    assert found["backlash.g"].off == 0.0
    assert found["release.sigma"].band.high == np.inf
    same = tmp_path / "limits.json"
    same.write_text('{"nrmse": {"high": 0.02}}')
    assert [r.name for r in read_limits(str(same))] == ["nrmse"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("c_visc = { low = 1 }", "did you mean c_vis"),
        ("c_vis = { low = 2, high = 1 }", "low below high"),
        ("c_vis = {}", "low, high or both"),
        ("c_vis = { lowest = 2 }", "unknown field `lowest`"),
        ('c_vis = { low = "5 mm" }', "mm"),
        ('c_vis = { low = "many" }', "number with its unit"),
        ("c_vis = { low = nan }", "finite"),
        ("c_vis = 3", "expected"),
        ("= 3", "not a TOML file"),
        ("", "no band"),
    ],
)
def test_bands_that_are_none(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "limits.toml"
    path.write_text(text)
    with pytest.raises(InputProblem) as problem:
        read_limits(str(path))
    assert said.casefold() in str(problem.value).casefold()
    assert str(path) in str(problem.value)


def test_a_parquet_file_of_something_else(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({"t": [0.0], "x": [0.0]}), path)
    with pytest.raises(InputProblem, match="no column 'log'"):
        read_inputs([str(path)])
