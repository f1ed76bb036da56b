"""HDF5 without a vector of times, samples that are missing, and the order of records."""

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
from erdctl.io.tables import write_table

Read = Callable[..., pa.Table]
DUTY = np.repeat([0.1, 0.3], 500)


@pytest.fixture
def file(tmp_path: Path) -> Callable[..., Path]:
    """Write datasets: {path: (values, attributes)}, and attributes of groups: {path: {...}}."""

    def file(
        datasets: dict[str, tuple[Any, dict[str, Any]]],
        groups: dict[str, dict[str, Any]] | None = None,
    ) -> Path:
        path = tmp_path / "log.h5"
        with h5py.File(path, "w") as made:
            for name, (values, about) in datasets.items():
                made.create_dataset(name, data=values).attrs.update(about)
            for name, about in (groups or {}).items():
                made[name].attrs.update(about)
        return path

    return file


@pytest.mark.parametrize("own", [{"dt": [0.001, 0.002, 0.1]}, {"fs": [1000.0, 500.0, 10.0]}])
def test_each_dataset_has_its_own_interval(
    file: Callable[..., Path], converted: Read, own: dict[str, list[float]], said: list[str]
) -> None:
    ((kind, steps),) = own.items()
    force, x, duty = ({kind: step} for step in steps)
    path = file(
        {
            "force": (F, {"unit": "N", **force}),
            "x": (X[::2], {"unit": "m", **x}),
            "duty": (DUTY[::100], {"unit": "1", **duty}),
        }
    )
    table = converted(path)
    assert np.allclose(table["t"], T[:901], rtol=1e-12)
    assert np.array_equal(table["force"], F[:901])
    assert np.allclose(table["x"], X[:901], rtol=0.0, atol=1e-5)  # a step^2 / 8
    assert np.array_equal(table["duty"], DUTY[:901])
    assert f"{path}: the time of 'x' is made of its attribute, dt = 0.002 s" in said


def test_an_interval_said_once_is_that_of_equally_many_samples(
    file: Callable[..., Path], converted: Read
) -> None:
    step = {"dt": 1e-3}
    table = converted(file({"force": (F, step), "x": (X, {})}))
    assert np.allclose(table["t"], T)
    assert np.array_equal(table["x"], X)
    with pytest.raises(InputProblem, match="column 'x': it has no time"):
        converted(file({"force": (F, step), "x": (X[::2], {})}))


@pytest.mark.parametrize("where", ["dataset", "group"])
def test_a_group_that_is_one_channel_has_an_interval(
    file: Callable[..., Path], converted: Read, where: str
) -> None:
    of_group, of_data = ({"dt": 1e-3}, {}) if where == "group" else ({}, {"dt": 1e-3})
    table = converted(
        file(
            {"force/data": (F, of_data), "x/data": (X, of_data)},
            {"force": {"unit": "N", **of_group}, "x": {"unit": "m", **of_group}},
        )
    )
    assert np.allclose(table["t"], T)
    assert np.array_equal(table["force"], F)
    assert np.array_equal(table["x"], X)


@pytest.mark.parametrize("where", ["/", "runs", "runs/cold"])
def test_an_interval_of_a_group_around(
    file: Callable[..., Path], converted: Read, where: str
) -> None:
    log = {"runs/cold/force": (F, {"unit": "N"}), "runs/cold/x": (X, {"unit": "m"})}
    assert np.allclose(converted(file(log, {where: {"fs": 1000.0}}))["t"], T)


def test_a_temperature_around_channels_with_an_interval(
    file: Callable[..., Path], converted: Read, said: list[str]
) -> None:
    log = {"T": (20.0 + T, {}), "run/force": (F, {}), "run/x": (X, {})}
    assert np.allclose(converted(file(log, {"run": {"dt": 1e-3}}))["t"], T)
    assert any("'T' is left out: it has no time" in line for line in said)
    said.clear()
    log = {"Time": (T, {}), "run/force": (F, {}), "run/x": (X, {})}
    assert np.array_equal(converted(file(log))["t"], T)
    assert not any("left out" in line for line in said)


def test_units_of_intervals(file: Callable[..., Path], converted: Read) -> None:
    about = {"fs": 1.0, "fs_unit": "kHz"}
    assert np.allclose(converted(file({"force": (F, about), "x": (X, about)}))["t"], T)
    about = {"dt": 1.0, "dt_unit": "ms"}
    assert np.allclose(converted(file({"force": (F, about), "x": (X, about)}))["t"], T)
    with pytest.raises(InputProblem, match="the attribute fs of '/force' is given in unit 'mm'"):
        converted(file({"force": (F, {"fs": 1.0, "fs_unit": "mm"})}))


def test_two_intervals_are_refused(file: Callable[..., Path], converted: Read) -> None:
    with pytest.raises(
        InputProblem, match=r"attributes of '/force' state intervals of 0.002 s and"
    ):
        converted(file({"force": (F, {"dt": 2e-3, "fs": 1000.0}), "x": (X, {"dt": 1e-3})}))


@pytest.mark.parametrize("fill", ["_FillValue", "missing_value"])
def test_samples_that_are_none(file: Callable[..., Path], read: Any, fill: str) -> None:
    force, about = F.copy(), {"unit": "N", fill: -9999.0}
    force[50] = -9999.0
    log = {"t": (T, {}), "x": (X, {}), "duty": (DUTY, {})}
    with pytest.raises(InputProblem, match="row 51, column 'force': found nan"):
        read(str(file({**log, "force": (force, about)})))
    counts = np.round(F).astype("i2")
    counts[50] = -9999
    about = {"unit": "N", "scale_factor": 0.5, fill: np.int16(-9999)}
    with pytest.raises(InputProblem, match="row 51, column 'force': found nan"):
        read(str(file({**log, "force": (counts, about)})))


def test_a_gain_beside_values_is_not_applied(
    file: Callable[..., Path], converted: Read, said: list[str]
) -> None:
    path = file({"t": (T, {}), "x": (X, {"offset": 2.0}), "force": (F, {"gain": 100.0})})
    table = converted(path)
    assert np.array_equal(table["force"], F)
    assert np.array_equal(table["x"], X)
    lines = [line.removeprefix(f"{path}: ") for line in said]
    assert (
        "'force' holds values and no counts, so its gain = 100 is not applied; if they are to be"
        ' multiplied, say so: --map "TARGET=force[100 UNIT]"' in lines
    )
    assert "'x' holds values and no counts, so its offset = 2 is not applied" in lines
    assert np.allclose(converted(path, "force=force[100 N]")["force"], F * 100.0)


def test_netcdf_scales_whatever_is_stored(
    file: Callable[..., Path], converted: Read, said: list[str]
) -> None:
    about = {"scale_factor": 2.0, "add_offset": 1.0}
    path = file({"t": (T, {}), "x": (X, {}), "force": (F.astype("f4"), about)})
    assert np.allclose(converted(path)["force"], F * 2.0 + 1.0, rtol=1e-5)
    assert any("packed values; applied scale_factor = 2 and add_offset = 1" in s for s in said)


def test_records_stand_as_they_were_counted(file: Callable[..., Path], converted: Read) -> None:
    runs = ("run_10", "run_2", "run_1")
    path = file({f"{run}/{n}": (v, {}) for run in runs for n, v in (("t", T), ("x", X))})
    assert converted(path)["record"].unique().to_pylist() == ["run_1", "run_2", "run_10"]


def test_own_records_keep_their_order_and_names(tmp_path: Path, converted: Read) -> None:
    names = ["warm", "a/b", "a∕b", "cold"]
    columns = {"t": np.tile(T, 4), "x": np.tile(X, 4), "p/q": np.tile(F, 4), "p∕q": np.tile(X, 4)}
    path = tmp_path / "log.h5"
    write_table(pa.table(columns | {"record": np.repeat(names, len(T))}), str(path))
    table = converted(path)
    assert table["record"].unique().to_pylist() == names
    assert table.column_names == [*columns, "record"]
    assert np.array_equal(table["p/q"], np.tile(F, 4))
