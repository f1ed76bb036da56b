"""Logs as a validated recording: what is taken, assumed, derived and kept."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.recording import CHANNELS
from erdctl.io.logs import Log, read_logs
from erdctl.io.tables import append_column, write_table

Columns = dict[str, Any]
Write = Callable[..., str]
Read = Callable[..., Log]

NAMES = ["log.csv", "log.parquet", "log.arrow"]


@pytest.mark.parametrize("name", NAMES)
def test_a_sound_log(
    columns: Columns, write: Write, read: Read, said: list[str], name: str
) -> None:
    path = write(columns, name)
    log = read(path, want_hash=True)
    recording = log.recording
    for channel in ("t", "x", "xdot", "duty", "force"):
        assert np.array_equal(getattr(recording, channel), columns[channel]), channel
    assert recording.names == ("a", "b")
    assert recording.starts.tolist() == [0, 100, 200]
    assert recording.temperature is None
    assert recording.xdot_note == "measured"
    assert log.table is None
    assert log.force_model is None
    (source,) = recording.sources
    assert (source.name, source.rows) == (path, 200)
    assert source.sha256 == hashlib.sha256(Path(path).read_bytes()).hexdigest()
    assert said == []


@pytest.mark.parametrize("name", NAMES)
def test_stdin(
    columns: Columns, write: Write, read: Read, stdin: Callable[[bytes], None], name: str
) -> None:
    del columns["record"]
    columns["t"] = np.arange(200) * 1e-3
    data = Path(write(columns, name)).read_bytes()
    stdin(data)
    recording = read("-", want_hash=True).recording
    assert np.array_equal(recording.x, columns["x"])
    assert recording.names == ("stdin",)
    assert recording.sources[0].name == "-"
    assert recording.sources[0].sha256 == hashlib.sha256(data).hexdigest()


def test_without_duty_and_xdot(columns: Columns, write: Write, read: Read, said: list[str]) -> None:
    del columns["duty"], columns["xdot"]
    path = write(columns)
    recording = read(path).recording
    assert not recording.duty.any()
    assert np.abs(recording.xdot - 0.4 * np.cos(40.0 * recording.t)).max() < 0.003
    derived, duty = said
    assert derived.startswith(f"{path}: no column xdot; derived from x by a Savitzky-Golay filter")
    assert "quartic, 21 samples = 20 ms; -3 dB at 59.9 Hz" in derived
    assert duty == f"{path}: no column duty; taken as 0 (no control)"
    assert recording.xdot_note in derived


def test_without_record_the_file_gives_the_name(columns: Columns, write: Write, read: Read) -> None:
    del columns["record"]
    columns["t"] = np.arange(200) * 1e-3
    assert read(write(columns, "run 7.b.csv")).recording.names == ("run 7.b",)


@pytest.mark.parametrize(
    ("values", "names"),
    [
        ([7] * 100 + [-2] * 100, ("7", "-2")),
        ([1.5] * 100 + [2.0] * 100, ("1.5", "2")),
        ([True] * 100 + [False] * 100, ("true", "false")),
        (pd.Categorical(["u"] * 100 + ["v"] * 100), ("u", "v")),
        (["ü, \n"] * 100 + ['"'] * 100, ("ü, \n", '"')),
        (pa.array(["u"] * 100 + ["v"] * 100, pa.large_string()), ("u", "v")),
    ],
)
def test_records_of_any_type(
    columns: Columns, write: Write, read: Read, values: Any, names: tuple[str, ...]
) -> None:
    columns["record"] = values
    for name in ("log.parquet", "log.arrow"):
        assert read(write(columns, name)).recording.names == names


def test_integer_records_in_csv_are_text(columns: Columns, write: Write, read: Read) -> None:
    columns["record"] = ["01"] * 100 + ["1"] * 100
    path = write(columns)
    log = read(path, need_force=False, keep_table=True)
    assert log.recording.names == ("01", "1")
    out = str(Path(path).with_name("out.parquet"))
    write_table(log.table, out)
    assert pq.read_schema(out).field("record").type == pa.string()


def test_a_dictionary_that_changes_from_chunk_to_chunk(
    columns: Columns, read: Read, tmp_path: Path
) -> None:
    table = pa.table(columns)
    path = tmp_path / "log.parquet"
    pq.write_table(table, path, row_group_size=30)
    recording = read(str(path)).recording
    assert recording.names == ("a", "b")
    assert recording.starts.tolist() == [0, 100, 200]


@pytest.mark.parametrize(
    "kind", [pa.float32(), pa.float16(), pa.int8(), pa.int64(), pa.uint16(), pa.decimal128(9, 3)]
)
def test_numbers_of_any_type(columns: Columns, write: Write, read: Read, kind: pa.DataType) -> None:
    whole = np.arange(200) % 100
    exact = np.int64 if pa.types.is_integer(kind) else np.float32
    columns["force"] = pa.array(whole.astype(exact)).cast(kind)
    force = read(write(columns, "log.parquet")).recording.force
    assert force is not None
    assert force.dtype == np.float64
    assert np.array_equal(force, whole)


def test_categories_of_numbers(columns: Columns, write: Write, read: Read) -> None:
    columns["duty"] = pa.array(columns["duty"]).dictionary_encode()
    assert np.array_equal(
        read(write(columns, "log.parquet")).recording.duty, np.repeat([0.1, 0.2], 100)
    )


def test_header_with_spaces_is_reported(
    columns: Columns, write: Write, read: Read, said: list[str]
) -> None:
    path = write({f" {n}": c for n, c in columns.items()})
    assert read(path).recording.names == ("a", "b")
    assert f"{path}: column ' force' is taken as 'force'" in said


# --- maps


MAPS = ["t=Time[ms]", "x=Defl FL[mm]", "xdot=-v[mm/s]", "force=F_fl[kN]", "duty=PWM[%]"]


def foreign(columns: Columns) -> Columns:
    return {
        "Time": columns["t"] * 1e3,
        "note": ["u, v"] * 200,
        "Defl FL [mm]": columns["x"] * 1e3,
        "v": columns["xdot"] * -1e3,
        "F_fl": columns["force"] * 1e-3,
        "PWM": (columns["duty"] * 100).astype(int),
        "Test": columns["record"],
    }


@pytest.mark.parametrize("name", ["log.parquet", "log.arrow"])
def test_maps(columns: Columns, write: Write, read: Read, name: str) -> None:
    path = write(foreign(columns), name)
    log = read(path, maps=[*MAPS, "record=Test"], need_force=False, keep_table=True)
    recording = log.recording
    for channel in ("t", "x", "xdot", "duty", "force"):
        got = getattr(recording, channel)
        assert np.allclose(got, columns[channel], rtol=1e-15, atol=0), channel
        assert np.array_equal(log.table[channel], got)
    assert recording.names == ("a", "b")
    assert log.table.column_names == ["t", "note", "x", "xdot", "force", "duty", "record"]


def test_a_column_of_the_contracts_name_steps_aside(
    columns: Columns, write: Write, read: Read, said: list[str]
) -> None:
    columns["F2"] = -columns["force"]
    path = write(columns)
    log = read(path, maps=["force=F2[N]"], keep_table=True)
    assert np.array_equal(log.recording.force, columns["F2"])
    assert log.table.column_names == [
        "t", "x", "xdot", "duty", "force (original)", "record", "force"
    ]  # fmt: skip
    assert f"{path}: the log's own column 'force' is kept as 'force (original)'" in said


def test_exchanged_names(columns: Columns, write: Write, read: Read, said: list[str]) -> None:
    columns["temperature"] = columns.pop("force")
    columns["force"] = np.full(200, 20.0)
    log = read(
        write(columns), maps=["force=temperature[N]", "temperature=force[degC]"], keep_table=True
    )
    assert np.array_equal(log.recording.temperature, columns["force"])
    assert np.array_equal(log.table["temperature"], columns["force"])
    assert np.array_equal(log.table["force"], columns["temperature"])
    assert said == []


def test_pandas_reads_a_mapped_log(columns: Columns, tmp_path: Path, read: Read) -> None:
    frame = pd.DataFrame(columns).rename(columns={"force": "F", "t": "Time"}).set_index("Time")
    frame.to_parquet(tmp_path / "log.parquet")
    log = read(str(tmp_path / "log.parquet"), maps=["force=F[kN]", "t=Time"], keep_table=True)
    write_table(log.table, str(tmp_path / "out.parquet"))
    back = pd.read_parquet(tmp_path / "out.parquet")
    assert np.allclose(back["force"], columns["force"] * 1e3)
    assert np.array_equal(back["t"], columns["t"])


# --- the table that passes through


@pytest.mark.parametrize("name", NAMES)
def test_the_table_is_the_log(columns: Columns, write: Write, read: Read, name: str) -> None:
    columns = {"id": [f"{i:03d}" for i in range(200)], **columns, "extra": np.arange(200) * 0.1}
    path = write(columns, name)
    log = read(path, need_force=False, keep_table=True)
    out = str(Path(path).with_name("out" + Path(path).suffix))
    write_table(append_column(log.table, "force_model", log.recording.x), out)
    if name == "log.csv":
        before, after = (Path(p).read_text().splitlines() for p in (path, out))
        assert after[0] == before[0] + ",force_model"
        cells = [line.split(",") for line in after[1:]]
        assert [c[0] for c in cells] == columns["id"]
        assert [c[-2] for c in cells] == [str(v) for v in columns["extra"]]
        assert [float(c[2]) for c in cells] == columns["x"].tolist()
    else:
        read_back = pq.read_table if name == "log.parquet" else read_stream
        assert read_back(out).drop_columns("force_model").equals(read_back(path))


def read_stream(path: str) -> pa.Table:
    with pa.OSFile(path) as file:
        return pa.ipc.open_stream(file).read_all()


@pytest.mark.parametrize("kind", [pa.float32(), pa.decimal128(12, 6)])
def test_types_that_need_no_change_stay(
    columns: Columns, write: Write, read: Read, kind: pa.DataType
) -> None:
    columns["duty"] = pa.array(columns["duty"]).cast(kind)
    log = read(write(columns, "log.parquet"), need_force=False, keep_table=True)
    assert log.table.schema.field("duty").type == kind
    assert log.recording.duty.dtype == np.float64


def test_types_stay_in_logs_of_many_batches(columns: Columns, tmp_path: Path, read: Read) -> None:
    table = pa.table(columns)
    table = table.set_column(3, "duty", table["duty"].cast(pa.float32()))
    path = str(tmp_path / "log.arrow")
    with pa.OSFile(path, "wb") as file, pa.ipc.new_stream(file, table.schema) as writer:
        writer.write_table(table, max_chunksize=30)
    log = read(path, need_force=False, keep_table=True)
    assert log.table.equals(table)


def test_categories_stay_categories(columns: Columns, write: Write, read: Read) -> None:
    columns["record"] = pd.Categorical(columns["record"])
    log = read(write(columns, "log.parquet"), need_force=False, keep_table=True)
    assert pa.types.is_dictionary(log.table.schema.field("record").type)


@pytest.mark.parametrize("name", NAMES)
def test_table_and_recording_share_memory(
    columns: Columns, write: Write, read: Read, name: str
) -> None:
    log = read(write(columns, name), need_force=False, keep_table=True)
    for channel in ("t", "x", "xdot", "duty"):
        (chunk,) = log.table[channel].chunks
        assert np.shares_memory(chunk.to_numpy(), getattr(log.recording, channel)), channel


def test_force_that_is_not_needed_may_be_anything(
    columns: Columns, write: Write, read: Read
) -> None:
    columns["force"] = ["", "n/a"] * 100
    log = read(write(columns), need_force=False, keep_table=True)
    assert log.recording.force is None
    assert log.table["force"].to_pylist() == columns["force"]


# --- several logs


def test_several_logs(columns: Columns, write: Write, read: Read, said: list[str]) -> None:
    one = write(columns | {"force_model": columns["x"]}, "one.csv")
    single = {n: c[:100] for n, c in columns.items() if n != "record"}
    two = write(single | {"force_model": columns["x"][:100]}, "two.parquet")
    log = read(one, two, want_hash=True)
    assert log.recording.names == ("one:a", "one:b", "two")
    assert log.recording.starts.tolist() == [0, 100, 200, 300]
    assert [os.path.basename(s.name) for s in log.recording.sources] == ["one.csv", "two.parquet"]
    assert len({s.sha256 for s in log.recording.sources}) == 2
    assert log.force_model is not None
    assert np.array_equal(log.force_model, np.concatenate([columns["x"], columns["x"][:100]]))
    for channel in CHANNELS[:5]:
        assert getattr(log.recording, channel).size == 300


def test_logs_of_one_name_are_told_apart(
    columns: Columns, write: Write, read: Read, tmp_path: Path
) -> None:
    (tmp_path / "u").mkdir()
    (tmp_path / "v").mkdir()
    u, v = write(columns, "u/log.csv"), write(columns, "v/log.csv")
    assert read(u, v).recording.names == (f"{u}:a", f"{u}:b", f"{v}:a", f"{v}:b")


def test_force_model_is_dropped_unless_all_have_it(
    columns: Columns, write: Write, read: Read
) -> None:
    one = write(columns | {"force_model": columns["x"]}, "one.csv")
    two = write(columns, "two.csv")
    assert read(one).force_model is not None
    assert read(one, two).force_model is None


def test_temperature_must_be_in_all(
    columns: Columns, write: Write, read: Read, said: list[str]
) -> None:
    one = write(columns | {"temperature": np.full(200, 20.0)}, "one.csv")
    two = write(columns, "two.csv")
    assert read(one).recording.temperature is not None
    assert said == []
    assert read(one, two).recording.temperature is None
    assert said == [
        f"2 logs are taken together as one damper: {one}, {two}",
        "not all logs have a column temperature; it is left out",
    ]


def test_a_log_given_twice(columns: Columns, write: Write, read: Read, tmp_path: Path) -> None:
    path = write(columns)
    (tmp_path / "link.csv").symlink_to(path)
    for paths in [(path, path), (path, str(tmp_path / "link.csv")), ("-", "-")]:
        with pytest.raises(UsageProblem, match="given twice"):
            read(*paths)


def test_no_log_at_all(read: Read) -> None:
    with pytest.raises(UsageProblem, match="no log given"):
        read()


def test_the_error_is_in_the_log_that_has_it(columns: Columns, write: Write, read: Read) -> None:
    good = write(columns, "good.csv")
    columns["x"][150] = np.nan
    bad = write(columns, "bad.csv")
    with pytest.raises(InputProblem, match=r"bad\.csv: row 152, column 'x'"):
        read(good, bad)


# --- cost


def test_imports_are_light() -> None:
    program = (
        "import sys, erdctl.io.logs, erdctl.io.tables\n"
        "heavy = {'pandas', 'scipy', 'pint', 'rich', 'pydantic', 'pyarrow.csv',"
        " 'pyarrow.parquet', 'pyarrow.dataset', 'pyarrow.compute'}\n"
        "print(', '.join(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stderr == ""
    assert done.stdout == "\n"


@pytest.mark.parametrize("name", ["log.parquet", "log.arrow"])
def test_reading_and_writing_import_little(columns: Columns, write: Write, name: str) -> None:
    program = (
        "import sys\n"
        "from erdctl.io.logs import read_logs\n"
        "from erdctl.io.tables import append_column, write_table\n"
        "log = read_logs([sys.argv[1]], need_force=False, keep_table=True, report=print)\n"
        "table = append_column(log.table, 'force_model', log.recording.x)\n"
        "write_table(table, sys.argv[1])\n"
        "heavy = {'pandas', 'scipy', 'pint', 'pyarrow.dataset'}\n"
        "print(', '.join(heavy & set(sys.modules)))"
    )
    path = write(columns, name)
    done = subprocess.run([sys.executable, "-c", program, path], capture_output=True, text=True)
    assert done.stderr == ""
    assert done.stdout == "\n"


def test_reading_many_rows_prints_its_speed(tmp_path: Path, read: Read) -> None:
    import time

    n = 1_000_000
    t = np.arange(n) * 1e-3
    x = 0.01 * np.sin(t)
    table = pa.table({"t": t, "x": x, "xdot": 0.01 * np.cos(t), "force": x, "duty": 0.0 * t})
    path = str(tmp_path / "log.parquet")
    write_table(table, path)
    start = time.perf_counter()
    pq.read_table(path)
    floor = time.perf_counter() - start
    start = time.perf_counter()
    read_logs([path], need_force=True, report=print)
    print(f"read_logs / pq.read_table: {(time.perf_counter() - start) / floor:.2f}")
