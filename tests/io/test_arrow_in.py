"""Arrow and Parquet that lie about themselves: refused before they are used or take memory."""

from __future__ import annotations

import io
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from erdctl.core.errors import ErdctlError, InputProblem, UsageProblem
from erdctl.io.convert import read_converted
from erdctl.io.sources import open_source, read_table
from erdctl.io.tables import write_table

N = 64
Opened = Callable[..., object]


def coded(kind: str) -> bytes:
    """Three rows of codes and texts, uncompressed, so that buffers stand as they are."""
    codes = pa.DictionaryArray.from_arrays(pa.array([0, 1, 1], pa.int32()), pa.array(["aa", "bb"]))
    table = pa.table({"t": [0.0, 1.0, 2.0], "record": codes, "note": ["one", "two", "three"]})
    stream = io.BytesIO()
    with (pa.ipc.new_file if kind == "file" else pa.ipc.new_stream)(stream, table.schema) as w:
        w.write_table(table)
    return stream.getvalue()


@pytest.mark.parametrize(("kind", "suffix"), [("file", ".feather"), ("stream", ".arrow")])
@pytest.mark.parametrize(
    ("sound", "spoilt"),
    [
        (struct.pack("<3i", 0, 1, 1), struct.pack("<3i", 0, 1, 1 << 30)),
        (struct.pack("<3i", 0, 1, 1), struct.pack("<3i", 0, -5, 1)),
        (struct.pack("<4i", 0, 3, 6, 11), struct.pack("<4i", 0, 3, 1 << 30, 11)),
        (struct.pack("<4i", 0, 3, 6, 11), struct.pack("<4i", 0, 3, -9, 11)),
        (struct.pack("<3i", 0, 2, 4), struct.pack("<3i", 0, 1 << 28, 4)),
        (b"onetwothree", b"one\xff\xfe\xfdthree"),
    ],
    ids=["code", "negative code", "offset", "negative offset", "text of a code", "no text"],
)
def test_buffers_are_checked_before_anything_uses_them(
    tmp_path: Path, kind: str, suffix: str, sound: bytes, spoilt: bytes
) -> None:
    data = coded(kind)
    assert sound in data
    path = tmp_path / f"log{suffix}"
    path.write_bytes(data.replace(sound, spoilt))
    with pytest.raises(InputProblem, match="damaged or cut off arrow"):
        read_table(str(path))


def constants(kind: str, rows: int, batches: int) -> bytes:
    batch = pa.record_batch({n: np.zeros(rows) for n in ("t", "x", "force")})
    stream = io.BytesIO()
    if kind == "parquet":
        with pq.ParquetWriter(stream, batch.schema, compression="zstd") as writer:
            for _ in range(batches):
                writer.write_batch(batch)
        return stream.getvalue()
    options = pa.ipc.IpcWriteOptions(compression="zstd")
    new = pa.ipc.new_file if kind == "file" else pa.ipc.new_stream
    with new(stream, batch.schema, options=options) as writer:
        for _ in range(batches):
            writer.write_batch(batch)
    return stream.getvalue()


@pytest.mark.parametrize(
    ("kind", "suffix"), [("file", ".feather"), ("stream", ".arrow"), ("parquet", ".parquet")]
)
def test_constants_that_open_to_gigabytes(tmp_path: Path, kind: str, suffix: str) -> None:
    path = tmp_path / f"log{suffix}"
    path.write_bytes(constants(kind, 1 << 21, 50))
    before = pa.total_allocated_bytes()
    with pytest.raises(InputProblem, match=r"open to 2\.52 GB .*no measured log"):
        read_converted(str(path), say=lambda _: None)
    assert pa.total_allocated_bytes() - before < 1 << 20
    assert open_source  # the same constants, fewer of them, are a log


def test_few_constants_are_read(tmp_path: Path) -> None:
    for kind, suffix in (("file", ".feather"), ("stream", ".arrow"), ("parquet", ".parquet")):
        path = tmp_path / f"log{suffix}"
        path.write_bytes(constants(kind, 1 << 16, 4))
        source = open_source(str(path))
        assert source.rows == 1 << 18
        assert read_table(str(path)).num_rows == 1 << 18


@pytest.mark.parametrize("suffix", [".feather", ".arrow", ".parquet"])
def test_one_long_text_said_often(tmp_path: Path, suffix: str) -> None:
    rows = 50_000
    codes = pa.array(np.zeros(rows, np.int32))
    label = pa.DictionaryArray.from_arrays(codes, pa.array(["r" * (1 << 20)]))
    table = pa.table({"t": np.arange(rows) * 1e-3, "note": label})
    path = tmp_path / f"log{suffix}"
    write_table(table, str(path))
    with pytest.raises(
        InputProblem, match=r"52\.4 GB \(column 'note'\)|column 'note' need 52\.4 GB"
    ):
        read_converted(str(path), say=lambda _: None)


def test_labels_of_a_real_log_are_no_bomb(tmp_path: Path) -> None:
    rows = 200_000
    label = pa.array([f"record {i // 1000}" for i in range(rows)])
    path = tmp_path / "log.parquet"
    write_table(pa.table({"t": np.arange(rows) * 1e-3, "record": label}), str(path))
    assert read_table(str(path))["record"].to_pylist() == label.to_pylist()


def test_any_offset_in_the_description(tmp_path: Path) -> None:
    """Every word of a file made huge, one after the other: one line, and no crash."""
    data = coded("file")
    path = tmp_path / "log.feather"
    for at in range(8, len(data) - 8, 4):
        for value in (0xFFFFFFFF, 0x7FFFFFFF, 0x80000000):
            spoilt = bytearray(data)
            struct.pack_into("<I", spoilt, at, value)
            path.write_bytes(spoilt)
            said = ""
            try:
                read_table(str(path))
            except ErdctlError as error:
                said = str(error)
            assert "\n" not in said


@pytest.mark.parametrize("suffix", [".feather", ".arrow", ".parquet"])
def test_a_table_without_columns(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"log{suffix}"
    write_table(pa.table({}), str(path))
    with pytest.raises(InputProblem, match="without columns"):
        open_source(str(path))


def test_dictionaries_that_differ_between_batches(tmp_path: Path) -> None:
    parts = [pa.array([c] * N).dictionary_encode() for c in "ab"]
    table = pa.table({"t": np.arange(2.0 * N), "record": pa.chunked_array(parts)})
    for name in ("out.feather", "out.arrow"):
        write_table(table, str(tmp_path / name))
        assert read_table(str(tmp_path / name))["record"].to_pylist() == ["a"] * N + ["b"] * N


def test_nested_dictionaries_into_feather(tmp_path: Path) -> None:
    kind = pa.list_(pa.dictionary(pa.int32(), pa.string()))
    chunks = [pa.array([[c]] * N, kind) for c in "ab"]
    table = pa.table({"t": np.arange(2.0 * N), "tags": pa.chunked_array(chunks)})
    with pytest.raises(UsageProblem, match=r"columns tags hold lists or structs; write \.parquet"):
        write_table(table, str(tmp_path / "out.feather"))
