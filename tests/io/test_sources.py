"""What comes in: recognised by content or suffix, hashed, and refused if damaged."""

from __future__ import annotations

import gzip
import hashlib
import os
import random
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from erdctl.core.errors import ComputationProblem, ErdctlError, ExitCode, InputProblem, UsageProblem
from erdctl.io import sources
from erdctl.io.formats import Format
from erdctl.io.sources import open_source, read_source, read_table
from erdctl.io.tables import write_table

TABLE = pa.table({"t": [0.0, 1.0], "record": ["a", "b"]})


def encoded(suffix: str, folder: Path) -> bytes:
    path = folder / f"encoded{suffix}"
    write_table(TABLE, str(path))
    data = path.read_bytes()
    path.unlink()
    return data


@pytest.mark.parametrize(
    ("suffix", "expected"),
    [
        (".csv", Format.CSV),
        (".parquet", Format.PARQUET),
        (".arrow", Format.ARROW),
        (".feather", Format.ARROW),
    ],
)
@pytest.mark.parametrize("name", ["-", "log.dat", "log", "same"])
def test_recognised(
    tmp_path: Path,
    stdin: Callable[[bytes], None],
    suffix: str,
    expected: Format,
    name: str,
) -> None:
    data = encoded(suffix, tmp_path)
    if name == "-":
        stdin(data)
        path = "-"
    else:
        file = tmp_path / (f"log{suffix}" if name == "same" else name)
        file.write_bytes(data)
        path = str(file)
    source = open_source(path)
    assert source.format is expected
    assert source.columns == ("t", "record")
    table, digest = read_source(source, numbers=["t"], want_hash=True)
    assert table.to_pydict() == TABLE.to_pydict()
    assert digest == hashlib.sha256(data).hexdigest()


def test_no_hash_unless_wanted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_table(TABLE, str(tmp_path / "a.csv"))
    monkeypatch.setattr(sources, "sha256_of", lambda data: pytest.fail("hashed"))
    assert read_source(open_source(str(tmp_path / "a.csv")))[1] == ""


def test_through_a_pipe_given_by_name(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    data = encoded(".parquet", tmp_path)
    writer = threading.Thread(target=lambda: pipe.write_bytes(data))
    writer.start()
    table, digest = read_source(open_source(str(pipe)), want_hash=True)
    writer.join(timeout=10)
    assert table.equals(TABLE)
    assert digest == hashlib.sha256(data).hexdigest()


def test_stdin_from_a_real_pipe(tmp_path: Path) -> None:
    program = (
        "from erdctl.io.sources import read_table; print(read_table('-', numbers=['t']).num_rows)"
    )
    data = b"t\n" + b"0.5\n" * 3_000_000
    done = subprocess.run([sys.executable, "-c", program], input=data, capture_output=True)
    assert done.stdout == b"3000000\n"


def test_bom_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"\xef\xbb\xbft,x\n0,1\n")
    assert open_source(str(path)).columns == ("t", "x")
    assert read_table(str(path), numbers=["t", "x"]).to_pydict() == {"t": [0.0], "x": [1.0]}


@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_line_ends(tmp_path: Path, ends: str) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(ends.join(["t,x", "0,1", "2,3"]).encode())
    got = read_table(str(path), numbers=["t", "x"])
    assert got.to_pydict() == {"t": [0.0, 2.0], "x": [1.0, 3.0]}


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.csv", b"", "empty; expected a bench log"),
        ("a.csv", b"\n\n  \n", "empty; expected a bench log"),
        ("a.parquet", b"", "empty"),
        (
            "a.csv.gz",
            gzip.compress(b"t,x\n0,1\n", mtime=0),
            "compressed with gzip; use gzip -dc FILE |",
        ),
        ("a.csv", b"PK\x03\x04rest", "an Excel or zip file; export it as CSV"),
        ("a.mat", b"MATLAB 5.0 MAT-file", "damaged, cut off or unusual mat"),
        ("a.mf4", b"MDF     4.10    ", "damaged, cut off or unusual mdf"),
        ("a.tdms", b"TDSm\x0e\0\0\0h\x12\0\0", "no channels with samples in it"),
        ("a.tdms_index", b"TDSh\x0e\0\0\0", "the index of a TDMS file; give the .tdms file"),
        ("a.h5", b"\x89HDF\r\n\x1a\nrest", "damaged, cut off or unusual hdf5"),
        ("a.mat", b"TDSmrest", "begins like tdms; if it is sound, give it the suffix .tdms"),
        ("a.parquet", b"t,x\n0,1\n", "not parquet, though its name says so: it begins like csv"),
        ("a.csv", b"PAR1rest", "begins like parquet; if it is sound, give it the suffix .parquet"),
        ("a.parquet", b"PAR1rest", "damaged or cut off parquet"),
        ("a.arrow", b"\xff\xff\xff\xffrest", "damaged or cut off arrow"),
        ("a.arrow", b"ARROW1rest", "damaged or cut off arrow"),
        ("a.csv", b"t;x;force\n", "separated by semicolons, expected commas"),
        ("a.csv", b"bench 3;\nt;x;force\n", "no table of numbers in it; it begins 'bench 3;'"),
        ("a.csv", b"t;x;force\n1.500;2.250;3.125\n", "may be 1.500 or 1500, and no number"),
        ("a.csv", b"t;x\n0,5;1.5\n", "numbers in two notations, '0,5' and '1.5' (row 2)"),
        ("a.csv", bytes(range(256)), "neither text nor a format that is known"),
        ("a.csv", b"t,x,t\n0,1,2\n", "columns 1 and 3 are both called 't'; rename one"),
    ],
)
def test_no_log(tmp_path: Path, name: str, data: bytes, words: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InputProblem) as caught:
        open_source(str(path))
    assert words in str(caught.value)
    assert str(caught.value).startswith(f"{path}: ")
    assert caught.value.exit_code == ExitCode.BAD_INPUT


def test_duplicated_names_in_parquet(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    pq.write_table(pa.Table.from_arrays([pa.array([1.0])] * 2, names=["t", "t"]), path)
    with pytest.raises(InputProblem, match="columns 1 and 2 are both called 't'"):
        open_source(str(path))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda p: p / "none.csv", "none.csv' does not exist"),
        (lambda p: p, "is a directory; name the files in it"),
        (lambda p: p / "file" / "a.csv", "cannot read"),
    ],
)
def test_cannot_be_opened(tmp_path: Path, make: Callable[[Path], Path], words: str) -> None:
    (tmp_path / "file").write_bytes(b"x")
    with pytest.raises(UsageProblem) as caught:
        open_source(str(make(tmp_path)))
    assert words in str(caught.value)
    assert caught.value.exit_code == ExitCode.USAGE


def test_a_terminal_is_no_log(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    with pytest.raises(UsageProblem, match="pipe a log into it"):
        open_source("-")


@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".feather"])
def test_cut_or_spoilt_files_end_in_a_message(tmp_path: Path, suffix: str) -> None:
    table = pa.table(
        {"t": np.arange(2000.0), "record": np.repeat(["a", "b"], 1000), "i": np.arange(2000)}
    )
    path = tmp_path / f"a{suffix}"
    write_table(table, str(path))
    sound = path.read_bytes()
    rng = random.Random(0)
    for cut in [len(sound) - 1, len(sound) - 9, len(sound) // 2, 20]:
        path.write_bytes(sound[:cut])
        with pytest.raises(InputProblem, match=r"cut off"):
            read_table(str(path))
    for _ in range(300):
        spoilt = bytearray(sound)
        for _ in range(rng.choice([1, 3, 20])):
            spoilt[rng.randrange(8, len(spoilt))] = rng.randrange(256)
        path.write_bytes(spoilt)
        message = ""
        try:
            read_table(str(path))  # many spoilt files still read
        except ErdctlError as error:
            message = str(error)
        assert "\n" not in message


def test_arrow_stream_without_its_end_is_refused(stdin: Callable[[bytes], None]) -> None:
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, TABLE.schema) as writer:
        writer.write_table(TABLE)
    data = sink.getvalue().to_pybytes()
    assert data.endswith(b"\xff\xff\xff\xff\0\0\0\0")
    stdin(data[:-8])
    with pytest.raises(InputProblem, match="stops without its end mark"):
        read_table("-")


@pytest.mark.parametrize("compression", ["lz4", "zstd"])
def test_compressed_arrow(tmp_path: Path, compression: str) -> None:
    path = tmp_path / "a.arrow"
    options = pa.ipc.IpcWriteOptions(compression=compression)
    with (
        pa.OSFile(str(path), "wb") as file,
        pa.ipc.new_stream(file, TABLE.schema, options=options) as writer,
    ):
        writer.write_table(TABLE)
    assert read_table(str(path), ["record"]).to_pydict() == {"record": ["a", "b"]}


def test_pages_of_parquet_are_checked(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    table = pa.table({"t": np.random.default_rng(0).normal(size=1000)})
    pq.write_table(table, path, compression="none", use_dictionary=False, write_page_checksum=True)
    data = bytearray(path.read_bytes())
    data[4000] ^= 1  # within the numbers: nothing but the checksum can tell
    path.write_bytes(data)
    with pytest.raises(InputProblem, match="damaged or cut off parquet"):
        read_table(str(path))


def test_labels_come_as_dictionaries(tmp_path: Path) -> None:
    path = str(tmp_path / "a.parquet")
    write_table(TABLE, path)
    table, _ = read_source(open_source(path), labels=["record"])
    assert pa.types.is_dictionary(table["record"].type)
    assert table["record"].to_pylist() == ["a", "b"]


def test_out_of_memory_while_reading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def exhausted(*_: object, **__: object) -> None:
        raise pa.lib.ArrowMemoryError("malloc of size 12345 failed")

    write_table(TABLE, str(tmp_path / "a.csv"))
    source = open_source(str(tmp_path / "a.csv"))
    monkeypatch.setattr("pyarrow.csv.read_csv", exhausted)
    with pytest.raises(ComputationProblem, match=r"out of memory while reading .*; split it"):
        read_source(source)
