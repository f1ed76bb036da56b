"""Which channel is the time, in every container: `T` is a temperature as well."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import InputProblem
from erdctl.io.containers.channels import Channel, Samples
from erdctl.io.containers.clocks import clock_of
from erdctl.io.tables import write_table

Read = Callable[..., pa.Table]
Write = Callable[..., Path]
WARM = 20.0 + T  # grows as a time does
SWINGS = 20.0 + np.sin(9.0 * T)


def hdf5(folder: Path, channels: dict[str, Any]) -> Path:
    path = folder / "log.h5"
    with h5py.File(path, "w") as file:
        for name, (values, unit) in channels.items():
            file.create_dataset(name, data=values).attrs.update({"unit": unit} if unit else {})
    return path


def compound(folder: Path, channels: dict[str, Any]) -> Path:
    path = folder / "log.h5"
    values = np.empty(len(T), [(n, "f8") for n in channels])
    for name, (column, _) in channels.items():
        values[name] = column
    with h5py.File(path, "w") as file:
        made = file.create_dataset("log", data=values)
        made.attrs.update({f"{n}_unit": u for n, (_, u) in channels.items() if u})
    return path


@pytest.fixture
def written(tmp_path: Path, mat: Write, tdms: Write) -> Callable[[str, dict[str, Any]], Path]:
    """Channels as (values, unit) in a format."""

    def written(kind: str, channels: dict[str, Any]) -> Path:
        if kind == "mat":
            units = {n: u for n, (_, u) in channels.items() if u}
            return mat({"log": {n: v for n, (v, _) in channels.items()} | {"units": units}})
        if kind == "tdms":
            inside = {n: (v, {"unit_string": u} if u else {}) for n, (v, u) in channels.items()}
            return tdms({"bench": inside})
        return (hdf5 if kind == "hdf5" else compound)(tmp_path, channels)

    return written


KINDS = ["mat", "tdms", "hdf5", "compound"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("times", "left"),
    [
        ({"T": (WARM, None), "time": (T, None)}, "T"),
        ({"T": (WARM, None), "t": (T, None)}, "T"),
        ({"T": (WARM, "degC"), "Time": (T, None)}, "T"),
        ({"T": (SWINGS, None), "Time": (T, None)}, "T"),
        ({"T": (WARM, None), "Time": (T * 1e3, "ms")}, "T"),
        ({"Time": (WARM, None), "t": (T, None)}, "Time"),
    ],
    ids=["time", "t", "unit", "growth", "Time with its unit", "Time beside t"],
)
def test_a_temperature_is_no_time(
    written: Callable[..., Path], converted: Read, kind: str, times: dict[str, Any], left: str
) -> None:
    table = converted(written(kind, {**times, "x": (X, "m"), "force": (F, "N")}))
    assert np.allclose(table["t"], T, rtol=1e-12, atol=1e-15)
    assert np.array_equal(table[left], times[left][0])
    assert np.array_equal(table["force"], F)


@pytest.mark.parametrize("kind", KINDS)
def test_what_may_each_be_the_time_is_not_guessed(
    written: Callable[..., Path], converted: Read, kind: str
) -> None:
    log = {"T": (WARM, None), "Time": (T, None), "x": (X, "m"), "force": (F, "N")}
    path = written(kind, log)
    with pytest.raises(
        InputProblem, match=r"'T' and 'Time' may each be its time; say which: --map"
    ):
        converted(path)
    table = converted(path, "t=Time[s]")
    assert np.array_equal(table["t"], T)
    assert np.array_equal(table["T"], WARM)


@pytest.mark.parametrize("kind", KINDS)
def test_a_swinging_temperature_alone_is_no_time(
    written: Callable[..., Path], converted: Read, kind: str
) -> None:
    with pytest.raises(InputProblem, match="it has no time"):
        converted(written(kind, {"T": (SWINGS, None), "x": (X, "m"), "force": (F, "N")}))


def test_two_spellings_of_time_are_said(
    written: Callable[..., Path], converted: Read, said: list[str]
) -> None:
    log = {"time": (T + 5.0, None), "t": (T, None), "x": (X, "m"), "force": (F, "N")}
    path = written("mat", log)
    assert np.array_equal(converted(path)["t"], T)
    assert f"{path}: the time is taken from 't', and not from time" in said


def test_a_unit_in_the_name(tdms: Write, converted: Read) -> None:
    for name in ("Time [ms]", "Time (ms)"):
        table = converted(tdms({"bench": {name: T * 1e3, "x": X, "force": F}}))
        assert np.allclose(table["t"], T, rtol=1e-12)


def test_a_series_with_a_temperature(mat: Write, converted: Read) -> None:
    """Fields that differ by their letters only are two fields."""
    force = {"data": F, "time": T, "Time": WARM, "unit": "N"}
    table = converted(mat({"x": {"data": X, "time": T}, "force": force}))
    assert np.array_equal(table["t"], T)
    assert np.array_equal(table["force"], F)


def channel(name: str, values: Any, unit: str | None = None) -> Channel:
    return Channel(name, unit, lambda: Samples(np.asarray(values)))


def test_times_that_begin_anew_grow() -> None:
    swings = channel("T", SWINGS)
    assert clock_of([swings, again := channel("Time", np.tile(T, 5))]).clock is again
    stamps = np.datetime64("2026-01-01") + (T * 1e6).astype("timedelta64[us]")
    assert clock_of([swings, stamped := channel("Time", stamps)]).clock is stamped
    assert clock_of([channel("T", [20, 19, 18])]).clock is None
    unsigned = np.array([5, 4, 3], np.uint8)  # whose differences turn over
    assert clock_of([channel("T", unsigned)]).clock is None


def test_times_that_do_not_grow_are_still_named_so() -> None:
    """What is wrong with them is then said of them, and nothing else takes their place."""
    still = [channel("time", [1, 1, 1]), t := channel("t", [2, 2, 2]), channel("T", [1, 2, 3])]
    assert clock_of(still).clock is t


def test_a_wrong_unit_on_the_only_time_is_said(converted: Read, tdms: Write) -> None:
    with pytest.raises(InputProblem, match="column 'time': stored with unit 'N'"):
        converted(tdms({"bench": {"time": (T, {"unit_string": "N"}), "x": X, "force": F}}))


@pytest.mark.parametrize("suffix", ["h5", "mat", "tdms", "mf4"])
@pytest.mark.parametrize("records", [None, ["cold", "warm"]])
def test_own_files_come_back(
    tmp_path: Path, converted: Read, suffix: str, records: list[str] | None
) -> None:
    """Also with names that are the time's elsewhere, and that say of a vector that it is data."""
    columns: dict[str, Any] = {
        "t": np.tile(T, 2) if records else T, "x": np.tile(X, 2) if records else X,
    }  # fmt: skip
    n = len(columns["t"])
    columns |= {"force": np.arange(n) * 1.0, "T": 20.0 + np.arange(n), "Time": np.arange(n) * 7.0}
    columns |= {"data": np.arange(n) * 3.0, "Units": np.arange(n) * 2.0}
    if records:
        columns["record"] = np.repeat(records, len(T))
    path = tmp_path / f"log.{suffix}"
    write_table(pa.table(columns), str(path))
    table = converted(path)
    assert set(table.column_names) == set(columns)
    for name, values in columns.items():
        assert table[name].to_pylist() == pytest.approx(values.tolist()), name


def test_a_clock_and_a_channel_of_its_name_in_each_record(tmp_path: Path, converted: Read) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for run in ("a", "b"):
            for name, values, unit in (("Time", T, "s"), ("t", WARM, "degC"), ("x", X, "m")):
                file.create_dataset(f"{run}/{name}", data=values).attrs["unit"] = unit
    table = converted(path)
    assert np.array_equal(table["t"], np.tile(T, 2))
    assert np.array_equal(table["t (2)"], np.tile(WARM, 2))
