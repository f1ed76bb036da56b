"""CSV to Parquet to MAT to MDF4 to TDMS and back to CSV: values exactly, units always."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.convert import read_converted
from erdctl.io.logs import Log
from erdctl.io.sources import read_table
from erdctl.io.stored import units_of
from erdctl.io.tables import write_table

CHAIN = ["log.parquet", "log.mat", "log.mf4", "log.tdms", "log.arrow"]
HEADER = "t,x,xdot,duty,force,temperature,p [bar],Defl FL [mm],count,who,record"


def convert(source: Path, target: Path, *maps: str) -> list[str]:
    said: list[str] = []
    write_table(read_converted(str(source), maps=maps, say=said.append), str(target))
    return said


@pytest.fixture
def log(tmp_path: Path) -> Path:
    rng = np.random.default_rng(0)
    n = 60
    t = np.tile(np.arange(n // 2) * 1e-3, 2)
    number = [t, 0.01 * np.sin(40.0 * t), 0.4 * np.cos(40.0 * t), rng.random(n), rng.normal(size=n)]
    number += [20.0 + rng.random(n), rng.normal(size=n), rng.normal(size=n)]
    count = list(range(n))
    text = ['"a,b"', "ü", ""] * (n // 3), ["run 1/a"] * (n // 2) + ["7"] * (n // 2)
    rows = zip(*(c.tolist() for c in number), count, *text, strict=True)
    path = tmp_path / "log.csv"
    path.write_text("\n".join([HEADER, *(",".join(map(str, r)) for r in rows)]) + "\n")
    return path


def test_the_chain(log: Path, tmp_path: Path, read: Callable[..., Log]) -> None:
    first = read(str(log)).recording
    for name in CHAIN:
        said = convert(log, tmp_path / name)
        log = tmp_path / name
        assert said == []
        recording = read(str(log)).recording
        for channel in ("t", "x", "xdot", "duty", "force", "temperature"):
            assert np.array_equal(getattr(recording, channel), getattr(first, channel)), channel
        assert recording.names == ("run 1/a", "7")
    back = tmp_path / "back.csv"
    convert(log, back)
    assert back.read_text().splitlines()[0] == HEADER
    original = read_table(str(tmp_path / "log.csv")).to_pydict()
    for name, cells in read_table(str(back)).to_pydict().items():
        if name in ("who", "record"):
            assert cells == original[name], name
        else:
            assert [float(c) for c in cells] == [float(c) for c in original[name]], name


@pytest.mark.parametrize("name", CHAIN)
def test_units_are_where_the_format_keeps_them(log: Path, tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    convert(log, path)
    units = {
        "t": "s", "x": "m", "xdot": "m/s", "duty": "1", "force": "N", "temperature": "degC",
        "p": "bar", "Defl FL": "mm",
    }  # fmt: skip
    assert units_of(read_converted(str(path), say=lambda line: None).schema) == units
    if name == "log.parquet":
        assert pq.read_schema(path).field("p").metadata == {b"unit": b"bar"}
    elif name == "log.mat":
        from scipy.io import loadmat

        found = loadmat(path, simplify_cells=True)
        assert found["units"] == {
            **{k: v for k, v in units.items() if k != "Defl FL"},
            "Defl_FL": "mm",
        }
        assert found["names"] == {"Defl_FL": "Defl FL"}
        assert [r["record"] for r in found["records"]] == ["run 1/a", "7"]
    elif name == "log.mf4":
        from asammdf import MDF

        with MDF(path) as file:
            assert file.get("Defl FL", group=1).unit == "mm"
            assert file.version == "4.10"
    elif name == "log.tdms":
        from nptdms import TdmsFile

        assert TdmsFile.read(path)["7"]["Defl FL"].properties["unit_string"] == "mm"


def test_single_records_keep_their_name_and_plain_logs_have_none(tmp_path: Path) -> None:
    plain = pa.table({"t": [0.0, 1.0], "x": [1.0, 2.0]})
    for name in CHAIN:
        write_table(plain, str(tmp_path / name))
        got = read_converted(str(tmp_path / name), say=lambda line: None)
        assert got.to_pydict() == plain.to_pydict()
        write_table(plain.append_column("record", pa.array(["a", "a"])), str(tmp_path / name))
        got = read_converted(str(tmp_path / name), say=lambda line: None)
        assert got["record"].to_pylist() == ["a", "a"]


NUMBERS = {
    "float64": st.floats(width=64, allow_nan=False),
    "float32": st.floats(width=32, allow_nan=False),
    "int64": st.integers(-(2**63), 2**63 - 1),
    "int16": st.integers(-(2**15), 2**15 - 1),
    "uint8": st.integers(0, 255),
}


@pytest.mark.parametrize("suffix", [".mat", ".h5", ".mf4", ".tdms"])
@given(st.data())
@settings(max_examples=25, deadline=None)
def test_numbers_of_all_kinds_keep_value_and_kind(suffix: str, data: Any) -> None:
    rows = data.draw(st.integers(2, 6))
    columns = {"t": pa.array(np.arange(float(rows)))}
    for kind, strategy in NUMBERS.items():
        cells = data.draw(st.lists(strategy, min_size=rows, max_size=rows))
        columns[f"c {kind}"] = pa.array(np.array(cells, kind))
    texts = st.text(st.characters(exclude_categories=("Cs", "Cc")), max_size=5).map(str.strip)
    columns["text"] = pa.array(data.draw(st.lists(texts, min_size=rows, max_size=rows)))
    table = pa.table(columns)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f"log{suffix}")
        write_table(table, path)
        got = read_converted(path, say=lambda line: None)
    for name in table.column_names:
        assert got[name].to_pylist() == table[name].to_pylist(), name
        assert got.schema.field(name).type == table.schema.field(name).type


def test_empty_cells(tmp_path: Path) -> None:
    table = pa.table({"t": [0.0, 1.0], "f": [1.0, None], "i": [1, None], "s": ["a", None]})
    write_table(table, str(tmp_path / "log.tdms"))
    got = read_converted(str(tmp_path / "log.tdms"), say=lambda line: None).to_pydict()
    assert np.isnan([got["f"][1], got["i"][1]]).all()
    assert got["s"] == ["a", ""]


@pytest.mark.parametrize(
    ("column", "words"),
    [
        (pa.array([[1.0], [2.0]]), "column 'c' holds list.*, which MAT cannot hold"),
        (pa.array([True, None]), "column 'c' holds bool with empty cells, which MAT cannot"),
        (
            pa.array([2**62 + 1, None]),
            "column 'c' holds int64 with empty cells, .* without rounding",
        ),
    ],
)
def test_what_containers_cannot_hold(tmp_path: Path, column: pa.Array, words: str) -> None:
    with pytest.raises(UsageProblem, match=words):
        write_table(pa.table({"t": [0.0, 1.0], "c": column}), str(tmp_path / "log.mat"))
    assert list(tmp_path.iterdir()) == []


def test_a_csv_with_units_in_its_header_is_a_log(
    tmp_path: Path, said: list[str], read: Any
) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "t [ms],x [mm],force [kN],duty [%]\n"
        + "".join(f"{i},{i * i * 1e-3},{i * 1e-3},30\n" for i in range(200))
    )
    recording = read(str(path)).recording
    assert np.allclose(recording.t, np.arange(200) * 1e-3, rtol=1e-15)
    assert np.allclose(recording.force, np.arange(200.0), rtol=1e-15)
    assert recording.duty[0] == pytest.approx(0.3, rel=1e-15)
    assert said[-2] == (
        f"{path}: converted t [ms] from ms to s, x [mm] from mm to m, duty [%] from % to 1,"
        " force [kN] from kN to N"
    )


def test_empty_cells_of_a_converted_column(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    field = pa.field("x", pa.float64(), metadata={"unit": "mm"})
    pq.write_table(pa.table([pa.array([1.0, None])], pa.schema([field])), path)
    got = read_converted(str(path), say=lambda line: None)
    assert got["x"].to_pylist() == [1e-3, None]
    assert units_of(got.schema) == {"x": "m"}


def test_text_where_numbers_are_converted(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    field = pa.field("x", pa.string(), metadata={"unit": "mm"})
    pq.write_table(pa.table([pa.array(["a"])], pa.schema([field])), path)
    with pytest.raises(InputProblem, match="column 'x': holds string, expected numbers"):
        read_converted(str(path), say=lambda line: None)


@pytest.mark.parametrize("suffix", [".mat", ".h5", ".mf4", ".tdms"])
def test_cut_files_end_in_a_message(tmp_path: Path, log: Path, suffix: str) -> None:
    path = tmp_path / f"cut{suffix}"
    convert(log, path)
    sound = path.read_bytes()
    for cut in (20, 130, len(sound) // 2, len(sound) - 8):
        path.write_bytes(sound[:cut])
        said: list[str] = []
        try:
            read_converted(str(path), say=said.append)
        except InputProblem as problem:
            assert "\n" not in str(problem)  # noqa: PT017  # TDMS may pass
        else:
            assert suffix == ".tdms"
            assert "the recording was cut off" in said[0]
