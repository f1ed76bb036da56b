"""Points of time and durations as column t, and units in `attrs` of pandas."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from erdctl.io.instants import in_seconds
from erdctl.io.logs import Log
from erdctl.io.stored import units_of

N = 200
TICKS = np.arange(N, dtype=np.int64)
PER_SECOND = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
@pytest.mark.parametrize("unit", PER_SECOND)
def test_timestamps_count_from_the_first(unit: str, zone: str | None) -> None:
    start = 1_700_000_000 * PER_SECOND[unit] + 7
    column = pa.chunked_array([pa.array(TICKS + start, pa.timestamp(unit, zone))])
    found = in_seconds(column, "stamp")
    assert found is not None
    assert np.array_equal(found[0], TICKS / PER_SECOND[unit])
    assert (
        "'stamp' holds points of time; taken in seconds from the first one, 2023-11-1" in found[1]
    )


@pytest.mark.parametrize("unit", PER_SECOND)
def test_durations_keep_their_zero(unit: str) -> None:
    found = in_seconds(pa.chunked_array([pa.array(TICKS + 5, pa.duration(unit))]), "t")
    assert found is not None
    assert np.array_equal(found[0], (TICKS + 5) / PER_SECOND[unit])


@pytest.mark.parametrize("kind", [pa.time32("ms"), pa.time64("us")])
def test_times_of_day(kind: pa.DataType) -> None:
    width = pa.int32() if kind.bit_width == 32 else pa.int64()
    found = in_seconds(pa.chunked_array([pa.array(TICKS + 9, width).cast(kind)]), "t")
    assert found is not None
    assert np.allclose(found[0], TICKS / (1e3 if kind.bit_width == 32 else 1e6), rtol=1e-15)


def test_numbers_and_empty_columns() -> None:
    assert in_seconds(pa.chunked_array([pa.array([1.0])]), "t") is None
    assert in_seconds(pa.chunked_array([pa.array(["1"])]), "t") is None
    found = in_seconds(pa.chunked_array([pa.array([None, None], pa.timestamp("s"))]), "t")
    assert found is not None
    assert found[0].null_count == 2


def frame() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "t": pd.date_range("2024-03-01 12:00", periods=N, freq="ms", tz="UTC"),
            "x": np.sin(TICKS * 0.04),
            "force": np.cos(TICKS * 0.04),
        }
    )


@pytest.mark.parametrize("suffix", ["parquet", "feather"])
@pytest.mark.parametrize(
    "attrs",
    [
        {"units": {"x": "mm", "force": "kN"}, "operator": "me"},
        {"Units": ["", "mm", "kN"]},
        {"x": {"unit": "mm"}, "force": {"Unit": "kN"}},
        {"x": "mm", "force": "kN"},
        {"x_unit": "mm", "force_unit": "[kN]"},
    ],
    ids=["units", "list", "columns", "plain", "suffix"],
)
def test_units_of_pandas(
    tmp_path: Path, read: Callable[..., Log], said: list[str], attrs: dict[str, Any], suffix: str
) -> None:
    path = str(tmp_path / f"log.{suffix}")
    table = frame()
    table.attrs = attrs
    table.to_parquet(path) if suffix == "parquet" else table.to_feather(path)
    recording = read(path).recording
    assert np.allclose(recording.x, 1e-3 * np.sin(TICKS * 0.04), rtol=1e-12)
    assert np.allclose(recording.force, 1e3 * np.cos(TICKS * 0.04), rtol=1e-12)
    assert np.array_equal(recording.t, TICKS / 1e3)
    assert f"{path}: converted x from mm to m, force from kN to N" in said
    assert any("from the first one, 2024-03-01 12:00" in line for line in said)


def test_the_unit_of_a_field_holds_before_that_of_the_frame(tmp_path: Path) -> None:
    field = pa.field("x", pa.float64(), metadata={"unit": "m"})
    table = pa.table({"x": [1.0]}, schema=pa.schema([field]))
    table = table.replace_schema_metadata({"PANDAS_ATTRS": '{"units": {"x": "mm", "y": "s"}}'})
    assert units_of(table.schema) == {"x": "m"}


@pytest.mark.parametrize(
    "text", ["", "{", "[1]", '{"units": 3}', '{"units": {"x": 3}}', "[" * 100_000, '{"x": null}']
)
def test_metadata_of_somebody_else(text: str) -> None:
    for key in ("PANDAS_ATTRS", "pandas"):
        schema = pa.schema([("x", pa.float64())], {key: text})
        assert units_of(schema) == {}


def test_halves_decimals_codes_and_integers(tmp_path: Path, read: Callable[..., Log]) -> None:
    x = 0.01 * np.sin(TICKS * 0.04)
    duty = pa.array([f"{v:.2f}" for v in np.repeat([0.1, 0.3], N // 2)]).cast(pa.decimal128(5, 2))
    counts = (100 * np.cos(TICKS * 0.04)).astype(np.int16)
    columns = {
        "t": pa.array(TICKS * 10**6, pa.duration("ns")),
        "x": pa.array(x.astype(np.float32)),
        "duty": duty,
        "force": pa.array(counts).dictionary_encode(),
        "temperature": pa.array(np.full(N, 20.5, np.float16)),
    }
    path = str(tmp_path / "log.parquet")
    pq.write_table(pa.table(columns), path)
    recording = read(path).recording
    assert np.array_equal(recording.force, counts)
    assert np.array_equal(recording.duty, np.repeat([0.1, 0.3], N // 2))
    assert np.array_equal(recording.temperature, np.full(N, 20.5))
    assert np.array_equal(recording.t, TICKS / 1e3)
