"""MATLAB files in the shapes in which labs save them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import ExitCode, InputProblem
from erdctl.io.containers.opening import open_container
from erdctl.io.extras import MissingLibrary
from erdctl.io.formats import Format
from erdctl.io.stored import units_of

Write = Callable[..., Path]
Read = Callable[..., pa.Table]


def struct_array(elements: list[dict[str, Any]]) -> Any:
    out = np.empty((1, len(elements)), [(k, object) for k in elements[0]])
    for i, element in enumerate(elements):
        out[0, i] = tuple(element.values())
    return out


def cells(items: list[Any]) -> Any:
    out = np.empty((len(items), 1), object)
    out[:, 0] = items
    return out


def check(table: pa.Table) -> None:
    assert np.allclose(table["t"], T, rtol=1e-15, atol=0.0)
    assert np.allclose(table["x"], X, rtol=1e-15, atol=0.0)
    assert np.array_equal(table["force"], F)


def test_plain_variables(mat: Write, converted: Read, said: list[str]) -> None:
    path = mat({"t": T, "x": X, "force": F, "comment": "run 7", "gain": 3.0})
    check(converted(path))
    assert said == [
        f"{path}: no unit is stored with some channels; taken t as s, x as m, force as N; --map"
        " says otherwise"
    ]


@pytest.mark.parametrize("version", ["5", "v7", "v7.3"])
def test_a_struct_with_units(mat: Write, converted: Read, said: list[str], version: str) -> None:
    log = {"Time": T * 1e3, "x": X * 1e3, "force": F, "p": F / 2}
    units = {"Time": "ms", "x": "mm", "force": "[N]", "p": "bar"}
    table = converted(mat({"log": {**log, "units": units}}, version))
    assert np.allclose(table["t"], T, rtol=1e-15)
    assert np.allclose(table["x"], X, rtol=1e-15)
    assert units_of(table.schema) == {"t": "s", "x": "m", "force": "N", "p": "bar"}
    assert said[-1].endswith("converted x from mm to m")


def test_units_as_a_cell_array(mat: Write, converted: Read) -> None:
    log = {"t": T, "x": X * 1e3, "force": F * 1e-3, "units": cells(["s", "mm", "kN"])}
    table = converted(mat({"log": log}))
    assert np.allclose(table["x"], X, rtol=1e-15)
    assert np.allclose(table["force"], F, rtol=1e-15)


@pytest.mark.parametrize("version", ["5", "v7.3"])
def test_a_struct_array_is_records(mat: Write, converted: Read, version: str) -> None:
    tests = [{"t": T, "x": X, "force": F * i, "name": f"test {i}"} for i in (1, 2, 3)]
    table = converted(mat({"tests": struct_array(tests), "date": "2026"}, version))
    assert table["record"].to_pylist() == [f"test {i}" for i in (1, 2, 3) for _ in T]
    assert np.array_equal(table["force"], np.concatenate([F, 2 * F, 3 * F]))
    assert np.array_equal(table["t"], np.tile(T, 3))


def test_records_without_names(mat: Write, converted: Read) -> None:
    table = converted(mat({"run": struct_array([{"t": T, "x": X}, {"t": T[:9], "x": X[:9]}])}))
    assert table["record"].to_pylist() == ["run(1)"] * len(T) + ["run(2)"] * 9


def test_structure_with_time(mat: Write, converted: Read) -> None:
    def signal(values: Any, label: str, block: str) -> dict[str, Any]:
        return {
            "values": values.reshape(-1, 1),
            "dimensions": 1.0,
            "label": label,
            "blockName": block,
        }

    signals = struct_array(
        [signal(X, "x", "bench/Scope"), signal(F, "", "bench/force"), signal(F, "", "")]
    )
    table = converted(mat({"ScopeData": {"time": T, "signals": signals, "blockName": "bench/S"}}))
    check(table)
    assert table.column_names == ["t", "x", "force", "ScopeData(3)"]


@pytest.mark.parametrize("shape", [(-1, 1), (1, 1, -1)])
def test_structs_like_timeseries(mat: Write, converted: Read, shape: tuple[int, ...]) -> None:
    def series(values: Any, unit: str) -> dict[str, Any]:
        return {
            "Time": T, "Data": values.reshape(shape), "DataInfo": {"Units": unit},
            "TimeInfo": {"Units": "seconds"},
        }  # fmt: skip

    table = converted(mat({"x": series(X * 1e3, "mm"), "force": series(F, "N")}))
    check(table)


def test_an_exported_dataset(mat: Write, converted: Read) -> None:
    def element(name: str, values: Any) -> dict[str, Any]:
        return {"Name": name, "Values": {"Time": T, "Data": values}}

    check(converted(mat({"logsout": struct_array([element("x", X), element("force", F)])})))
    check(converted(mat({"logsout": cells([element("x", X), element("force", F)])})))


def uniform(values: Any, unit: str) -> Any:
    """A timeseries object as MATLAB stores it: its uniform time is start and increment."""
    from matio.utils.matclass import MatlabOpaque

    column = values.reshape(-1, 1)
    time = {"Units": "seconds", "Start_": 0.0, "Increment_": 1e-3, "Length": float(len(T))}
    info = MatlabOpaque({**time, "Time_": np.empty((0, 0))}, "tsdata.timemetadata")
    units = MatlabOpaque({"Name": unit}, "Simulink.SimulationData.Unit")
    properties = {
        "Name": "unnamed", "Data_": column, "Time_": np.empty((0, 0)), "TimeInfo": info,
        "DataInfo": MatlabOpaque({"Units": units}, "tsdata.datametadata"),
    }  # fmt: skip
    return MatlabOpaque(properties, "timeseries")


def dataset() -> Any:
    from matio.utils.matclass import MatlabOpaque

    elements = [
        MatlabOpaque({"Name": n, "Values": uniform(v, u)}, "Simulink.SimulationData.Signal")
        for n, v, u in [("x", X * 1e3, "mm"), ("force", F, "N")]
    ]
    storage = MatlabOpaque(
        {"Elements": cells(elements)}, "Simulink.SimulationData.Storage.RamDatasetStorage"
    )
    return MatlabOpaque({"Name": "logsout", "Storage_": storage}, "Simulink.SimulationData.Dataset")


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_objects_of_simulink(mat: Write, converted: Read, version: str) -> None:
    table = converted(mat({"logsout": dataset(), "note": "x"}, version))
    assert np.allclose(table["t"], T, rtol=1e-15)
    assert np.allclose(table["x"], X, rtol=1e-15)
    assert np.array_equal(table["force"], F)


def test_a_matlab_table(mat: Write, converted: Read) -> None:
    import pandas as pd

    check(converted(mat({"bench": pd.DataFrame({"t": T, "x": X, "force": F})}, "v7.3")))


def test_integers_with_a_scaling(mat: Write, converted: Read) -> None:
    counts = np.arange(1000, dtype=np.int16) - 500
    force = {"data": counts, "scale": 0.5, "offset": 1.0, "unit": "N"}
    table = converted(mat({"log": {"t": T, "x": X, "force": force}}))
    assert np.array_equal(table["force"], counts * 0.5 + 1.0)


def test_integers_without_a_scaling_are_refused(mat: Write, converted: Read) -> None:
    counts = np.arange(1000, dtype=np.int16)
    path = mat({"t": T, "x": X, "force": counts})
    with pytest.raises(
        InputProblem, match=r"column 'force': whole numbers \(int16\) without a unit"
    ):
        converted(path)
    assert np.array_equal(converted(path, "force=force[N]")["force"], counts)


def test_a_scaling_that_is_not_clear(mat: Write, converted: Read) -> None:
    counts = np.arange(1000, dtype=np.int16)
    with pytest.raises(InputProblem, match="'force' has scale and gain; which of them"):
        converted(mat({"t": T, "x": X, "force": {"data": counts, "scale": 0.5, "gain": 2.0}}))


def test_several_rates(mat: Write, converted: Read, said: list[str]) -> None:
    def series(step: int, values: Any) -> dict[str, Any]:
        return {"time": T[::step], "data": values[::step]}

    duty = np.repeat([0.1, 0.3], 500)
    log = {"x": series(2, X), "force": series(1, F), "duty": series(100, duty)}
    table = converted(mat({"log": log}))
    assert len(table) == 901  # from 0 to 0.9 s
    assert np.allclose(table["x"], X[:901], rtol=0.0, atol=1e-5)  # a step^2 / 8
    assert np.array_equal(table["force"], F[:901])
    assert np.array_equal(table["duty"], duty[:901])
    assert (
        "several time bases; the rows are those of force (1000 Hz); interpolated linearly: x"
        " (500 Hz); held from the sample before: duty (10 Hz); 99 rows outside 0 to 0.9 s, where"
        " not all of them are recorded, left out" in said[-1]
    )


def test_a_matrix_with_column_headers(mat: Write, converted: Read) -> None:
    bench = {"data": np.stack([T, X, F], 1), "colheaders": cells(["t", "x", "force"])}
    check(converted(mat({"bench": bench})))
    check(converted(mat(bench)))
    check(
        converted(
            mat(
                {
                    "M": bench["data"] * [1e3, 1.0, 1.0],
                    "names": bench["colheaders"],
                    "units": cells(["ms", "m", "N"]),
                }
            )
        )
    )


def test_own_names(mat: Write, converted: Read) -> None:
    path = mat({"Zeit": T * 1e3, "Weg": X, "Kraft": F})
    check(converted(path, "t=Zeit[ms]", "x=Weg", "force=Kraft"))
    with pytest.raises(InputProblem, match="none of its channels has a time"):
        converted(path)


def test_the_clock_answers_to_its_own_name(mat: Write, converted: Read) -> None:
    path = mat({"Time": T * 1e3, "x": X, "force": F})
    check(converted(path, "t=Time[ms]"))


def test_points_of_time_are_refused(mat: Write, converted: Read) -> None:
    stamps = np.datetime64("2026-11-21T10:00:00", "ms") + np.arange(1000)
    path = mat({"Time": stamps.reshape(-1, 1), "x": X}, "v7.3")
    with pytest.raises(InputProblem, match="'Time': expected numbers to be the time; points"):
        converted(path)


def test_strings_name_records(mat: Write, converted: Read) -> None:
    texts = [np.array([[f"test {i}"]], np.dtypes.StringDType()) for i in (1, 2)]
    tests = struct_array([{"t": T, "x": X, "name": t} for t in texts])
    table = converted(mat({"tests": tests}, "v7.3"))
    assert table["record"].to_pylist() == ["test 1"] * 1000 + ["test 2"] * 1000


def test_a_matrix_without_names_is_refused(mat: Write, converted: Read) -> None:
    with pytest.raises(InputProblem, match=r"no channels .*'pwm' \(3 x 1000\) has no names"):
        converted(mat({"pwm": np.stack([T, X, F])}))


@pytest.mark.parametrize(
    ("version", "what"), [("v7.3", "MATLAB 7.3 files need"), ("v7", "MATLAB objects")]
)
def test_without_the_library(
    mat: Write, monkeypatch: pytest.MonkeyPatch, version: str, what: str
) -> None:
    path = mat({"logsout": dataset()}, version)
    monkeypatch.setitem(sys.modules, "matio", None)
    kind = MissingLibrary if version == "v7.3" else InputProblem
    with pytest.raises(kind, match=what) as caught:
        open_container(str(path), Format.MAT, "log.mat")
    assert "pip install 'erdctl[mat73]'" in str(caught.value)
    assert caught.value.exit_code in (ExitCode.NOT_COMPLETED, ExitCode.BAD_INPUT)


def test_plain_variables_beside_unread_objects(mat: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    path = mat({"t": T, "x": X, "force": F, "extra": uniform(X, "m")}, "v7")
    monkeypatch.setitem(sys.modules, "matio", None)
    layout = open_container(str(path), Format.MAT, "log.mat")
    assert layout.columns == ("t", "x", "force")
    assert "its MATLAB objects (timeseries, string, ...) are not read" in layout.notes[-1]


def test_from_a_pipe(mat: Write, read: Any, stdin: Callable[[bytes], None]) -> None:
    for version in ("5", "v7.3"):
        stdin(mat({"t": T, "x": X, "force": F}, version).read_bytes())
        assert np.array_equal(read("-").recording.force, F)


@pytest.mark.parametrize("name", ["data", "raw", "values"])
def test_a_channel_called_data_is_one_of_several(mat: Write, converted: Read, name: str) -> None:
    log = {"t": T, "x": X, "force": F, name: F / 2}
    table = converted(mat({"log": log}))
    check(table)
    assert np.array_equal(table[name], F / 2)


def test_vectors_beside_a_series_are_left_out_and_said(
    mat: Write, converted: Read, said: list[str]
) -> None:
    force = {"time": T, "data": F, "quality": np.zeros(1000)}
    path = mat({"x": {"time": T, "data": X}, "force": force})
    check(converted(path))
    assert f"{path}: 'force.quality' (1000) stands beside 'force.data', left out" in said


def test_a_gain_beside_values_is_said(mat: Write, converted: Read, said: list[str]) -> None:
    force = {"data": F, "gain": 100.0, "unit": "N"}
    path = mat({"t": T, "x": X, "force": force})
    check(converted(path))
    assert any("its gain = 100 is not applied" in line for line in said)
    force = {"raw": F, "gain": 100.0, "unit": "N"}  # which says that they are counts
    table = converted(mat({"t": T, "x": X, "force": force}))
    assert np.array_equal(table["force"], F * 100.0)


@pytest.mark.parametrize(
    "names", [("FL", "FR"), ("run_FrontLeft", "run_RearLeft"), ("dut_1", "dut_2")]
)
def test_groups_of_several_dampers(mat: Write, read: Any, names: tuple[str, str]) -> None:
    log = {"t": T, "x": X, "force": F, "duty": T * 0.0}
    path = str(mat(dict.fromkeys(names, log)))
    with pytest.raises(InputProblem, match="column 'damper': holds 2 dampers"):
        read(path)
    assert len(read(path, where=["damper=*"]).recording) == 2000


def test_groups_of_one_damper(mat: Write, converted: Read) -> None:
    log = {"t": T, "x": X, "force": F}
    for names in (("cold_FL", "warm_FL"), ("run_1", "run_2")):
        assert "damper" not in converted(mat(dict.fromkeys(names, log))).column_names


def test_version_4_is_named(tmp_path: Path, converted: Read) -> None:
    from scipy.io import savemat

    savemat(path := tmp_path / "log.mat", {"t": T, "x": X}, format="4")
    with pytest.raises(InputProblem, match="this is MATLAB 4, which is not read"):
        converted(path)
