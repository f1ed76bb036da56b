"""Tables out and in again: nothing is lost on the way."""

from __future__ import annotations

import csv
import io
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from erdctl.core.errors import ComputationProblem, InputProblem, UsageProblem
from erdctl.core.recording import Recording
from erdctl.io import csv_out
from erdctl.io.formats import Format
from erdctl.io.sources import open_source, read_source, read_table
from erdctl.io.tables import append_column, output_format, table_of, write_table

SUFFIXES = [".csv", ".parquet", ".pq", ".arrow", ".arrows", ".ipc", ".feather"]

floats = st.floats(allow_nan=False, width=64)
names = st.text(
    st.characters(blacklist_categories=("Cs", "Cc"), blacklist_characters="\ufeff"), min_size=1
)
# No lone \r: a text file cannot tell it from \r\n once it went through other tools.
texts = st.text(st.characters(blacklist_categories=("Cs",), blacklist_characters="\x00"))


@st.composite
def tables(draw: st.DrawFn) -> pa.Table:
    rows = draw(st.integers(1, 8))

    def column(values: st.SearchStrategy[object], kind: pa.DataType) -> pa.Array:
        return pa.array(draw(st.lists(values, min_size=rows, max_size=rows)), kind)

    columns = {
        "t": column(floats, pa.float64()),
        "f": column(floats, pa.float64()),
        "i": column(st.integers(-(2**63), 2**63 - 1), pa.int64()),
        "s": column(texts, pa.string()),
        "record": column(names, pa.string()),
    }
    unused = draw(st.lists(names.filter(lambda n: n not in columns), max_size=2, unique=True))
    columns |= {n: column(floats, pa.float64()) for n in unused}
    return pa.table(columns)


@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".feather"])
@given(tables())
@settings(max_examples=40, deadline=None)
def test_binary_round_trip_is_exact(suffix: str, table: pa.Table) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f"a{suffix}")
        write_table(table, path)
        assert read_table(path).equals(table)


def over_lines(texts: list[str], name: str) -> pa.Table:
    """Texts that go over lines, and a column whose name is a number."""
    zeros = pa.array([0.0] * len(texts))
    names = pa.array(["0"] * len(texts))
    return pa.table(
        {"t": zeros, "f": zeros, "i": pa.array([0] * len(texts)), "s": texts, "record": names}
        | {name: zeros}
    )


@given(tables())
@example(over_lines(["a\nb", "", ""], "0"))
@example(over_lines(["\n", "x"], "1.5"))
@example(over_lines(["1\n2"], "5"))
@settings(max_examples=150, deadline=None)
def test_csv_round_trip_is_exact(table: pa.Table) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.csv")
        write_table(table, path)
        back = read_table(path, numbers=["t"])
        assert back.column_names == table.column_names
        assert bits(back["t"]) == bits(table["t"])
        # Cells that nobody computes with are the text they were ...
        assert back["s"].to_pylist() == table["s"].to_pylist()
        assert back["record"].to_pylist() == table["record"].to_pylist()
        assert back["i"].to_pylist() == [str(i) for i in table["i"].to_pylist()]
        assert [float(f) for f in back["f"].to_pylist()] == table["f"].to_pylist()
        # ... and CSV gives them back to the letter,
        again = os.path.join(folder, "b.csv")
        write_table(back, again)
        assert Path(again).read_bytes() == Path(path).read_bytes()
        # while typed formats hold numbers.
        typed = os.path.join(folder, "c.parquet")
        write_table(back, typed)
        numbers = read_table(typed)
        assert numbers["i"].type == pa.int64()
        assert numbers["i"].to_pylist() == table["i"].to_pylist()
        assert bits(numbers["f"].cast(pa.float64())) == bits(table["f"])
        assert numbers["record"].to_pylist() == table["record"].to_pylist()


@given(tables())
@settings(max_examples=50, deadline=None)
def test_csv_is_what_other_programs_read(table: pa.Table) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.csv")
        write_table(table, path)
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    assert rows[0] == table.column_names
    got = [r[3] for r in rows[1:] if r]
    assert got == table["s"].to_pylist()


def bits(column: pa.ChunkedArray) -> list[bytes]:
    """Floats to the bit, so that -0.0 is not 0.0."""
    return [np.float64(v).tobytes() for v in column.to_pylist()]


EXTREMES = [5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1, 1e22, 1e23, -0.0]


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".arrow"])
def test_extreme_floats(tmp_path: Path, suffix: str) -> None:
    path = str(tmp_path / f"a{suffix}")
    table = pa.table({"t": EXTREMES, "f": EXTREMES})
    write_table(table, path)
    assert bits(read_table(path, numbers=["t"])["t"]) == bits(table["t"])
    write_table(read_table(path, numbers=["t"]), str(tmp_path / "b.parquet"))
    assert bits(read_table(str(tmp_path / "b.parquet"))["f"]) == bits(table["f"])


def test_csv_text_of_awkward_cells(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    table = pa.table(
        {
            'na,"me': ['say "hi"', "a,b", "two\nlines", "", None, "plain"],
            "f": [0.1, math.nan, math.inf, None, 1e300, 2.0],
            "b": [True, False, None, True, True, True],
            "i32": pa.array([1, 2, 3, None, 5, 6], pa.int32()),
            "f32": pa.array([0.1, 2, 3, 4, 5, 6], pa.float32()),
            "d": pa.array(["u", "u", "v,", "u", None, "v,"]).dictionary_encode(),
        }
    )
    write_table(table, str(path))
    assert path.read_text() == (
        '"na,""me",f,b,i32,f32,d\n'
        '"say ""hi""",0.1,true,1,0.1,u\n'
        '"a,b",nan,false,2,2,u\n'
        '"two\nlines",inf,,3,3,"v,"\n'
        ",,true,,4,u\n"
        ",1e+300,true,5,5,\n"
        'plain,2,true,6,6,"v,"\n'
    )


def test_many_rows_of_csv(tmp_path: Path) -> None:
    n = 200_001  # several blocks of formatting
    path = str(tmp_path / "a.csv")
    rng = np.random.default_rng(0)
    table = pa.table({"t": np.arange(n) / 3.0, "f": rng.normal(size=n)})
    write_table(table, path)
    assert read_table(path, numbers=["t", "f"]).equals(table)


@pytest.mark.parametrize("block", [40, 64, 100])
def test_line_ends_in_quotes_across_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: int
) -> None:
    monkeypatch.setattr("erdctl.io.csv_in.BLOCK", block)
    path = str(tmp_path / "a.csv")
    notes = [f"{i},\n0,\n" for i in range(300)]
    write_table(pa.table({"t": np.arange(300.0), "s": notes}), path)
    got = read_table(path, numbers=["t"])
    assert got["s"].to_pylist() == notes
    assert got["t"].to_pylist() == list(range(300))


def test_slices_are_written_from_their_beginning(tmp_path: Path) -> None:
    path = str(tmp_path / "a.csv")
    write_table(pa.table({"t": np.arange(10.0), "s": list("abcdefghij")}).slice(4, 2), path)
    assert Path(path).read_text() == "t,s\n4,e\n5,f\n"


@given(
    st.lists(st.lists(st.sampled_from(["", "a", '"', "é", "x" * 70]), max_size=4), max_size=6),
    st.integers(0, 3),
)
def test_batches_of_any_size_leave_no_bytes_of_their_buffers(
    parts: list[list[str]], offset: int
) -> None:
    """A batch without rows has a buffer that nobody has written to."""
    batches = [pa.record_batch({"a": pa.array(p, pa.string()), "b": p}) for p in parts if p] or [
        pa.record_batch({"a": pa.array(["q"]), "b": pa.array(["q"])})
    ]
    empty = batches[0].slice(0, 0)
    table = pa.Table.from_batches([empty, *(x for b in batches for x in (b, empty))])
    table = table.slice(min(offset, table.num_rows))
    text = b"".join(bytes(chunk) for chunk in csv_out.chunks(table)).decode()
    rows = [*csv.reader(io.StringIO(text))]
    assert rows == [["a", "b"], *([v, v] for v in table.column("a").to_pylist())]


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (["1", "2", ""], pa.array([1, 2, None], pa.int64())),
        (["-3", "0", "9223372036854775807"], pa.array([-3, 0, 2**63 - 1], pa.int64())),
        (["1.50", "2", ""], pa.array([1.5, 2.0, None])),
        (["1e3", "inf", "-0.0"], pa.array([1000.0, math.inf, -0.0])),
        (["007", "008", "009"], pa.array(["007", "008", "009"])),
        (["1", "x", ""], pa.array(["1", "x", ""])),
        (["", "", ""], pa.array(["", "", ""])),
        (["+1", "2", "3"], pa.array([1.0, 2.0, 3.0])),
        (["12345678901234567890", "1", "2"], pa.array([12345678901234567890.0, 1.0, 2.0])),
    ],
)
def test_text_becomes_numbers_only_without_loss(
    tmp_path: Path, cells: list[str], expected: pa.Array
) -> None:
    source = tmp_path / "a.csv"
    source.write_text("t,c\n" + "".join(f"{i},{c}\n" for i, c in enumerate(cells)))
    table = read_table(str(source), numbers=["t"])
    write_table(table, str(tmp_path / "b.parquet"))
    assert pq.read_table(tmp_path / "b.parquet")["c"].combine_chunks() == expected
    write_table(table, str(tmp_path / "c.csv"))
    assert (tmp_path / "c.csv").read_bytes() == source.read_bytes()


def test_marks_of_csv_cells_do_not_get_out(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,c\n1,x\n")
    write_table(read_table(str(tmp_path / "a.csv"), numbers=["t"]), str(tmp_path / "b.parquet"))
    assert b"erdctl" not in (pq.read_schema(tmp_path / "b.parquet").field("c").metadata or {})


def test_csv_refuses_what_it_cannot_hold(tmp_path: Path) -> None:
    with pytest.raises(UsageProblem, match=r"column 'v' holds list<.*write \.parquet or \.arrow"):
        write_table(pa.table({"v": [[1, 2]]}), str(tmp_path / "a.csv"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".feather"])
def test_columns_of_any_type_pass_through_binary_formats(tmp_path: Path, suffix: str) -> None:
    table = pa.table(
        {
            "v": [[1, 2], []],
            "when": pa.array([1, 2], pa.timestamp("ns", "UTC")),
            "d": pa.array(["a", "b"]).dictionary_encode(),
            "n": pa.nulls(2),
            "a.b": [{"x": 1}, {"x": 2}],
        }
    ).replace_schema_metadata({"lab": "bench 3"})
    path = str(tmp_path / f"a{suffix}")
    write_table(table, path)
    back = read_table(path)
    assert back.equals(table)
    assert back.schema.metadata[b"lab"] == b"bench 3"


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_chosen_columns_come_in_the_order_asked(tmp_path: Path, suffix: str) -> None:
    path = str(tmp_path / f"log{suffix}")
    write_table(pa.table({"t": [1.0], "a.b": [2.0], "x [mm]": [3.0], "s": ["u"]}), path)
    got = read_table(path, ["x [mm]", "a.b", "t"], numbers=["x [mm]", "a.b", "t"])
    assert got.to_pydict() == {"x [mm]": [3.0], "a.b": [2.0], "t": [1.0]}


@pytest.mark.parametrize(
    ("path", "format", "expected"),
    [
        ("a.csv", None, Format.CSV),
        ("A.CSV", None, Format.CSV),
        ("a.pq", None, Format.PARQUET),
        ("a.feather", None, Format.ARROW),
        ("-", None, Format.CSV),
        ("-", "parquet", Format.PARQUET),
        ("a.csv", "arrow", Format.ARROW),
        ("a.dat", "csv", Format.CSV),
        ("/dev/null", None, Format.CSV),
    ],
)
def test_output_format(path: str, format: str | None, expected: Format) -> None:
    assert output_format(path, format) is expected


@pytest.mark.parametrize(
    ("path", "format", "words"),
    [
        ("a.dat", None, "'a.dat': unknown suffix; known are .csv, .parquet"),
        ("a", None, "unknown suffix"),
        ("a.csv", "excel", "unknown format 'excel'; formats are csv, parquet, arrow"),
    ],
)
def test_unknown_output_format(path: str, format: str | None, words: str) -> None:
    with pytest.raises(UsageProblem, match=re.escape(words)):
        output_format(path, format)


@pytest.mark.parametrize("format", [None, "csv", "parquet", "arrow"])
def test_through_stdout_and_stdin(
    capsysbinary: pytest.CaptureFixture[bytes],
    stdin: Callable[[bytes], None],
    format: str | None,
) -> None:
    table = pa.table({"t": [0.1, 0.2], "s": ["a", "b"]})
    write_table(table, "-", format)
    stdin(capsysbinary.readouterr().out)
    source = open_source("-")
    assert source.format is Format(format or "csv")
    assert source.name == "stdin"
    assert read_source(source, numbers=["t"])[0].equals(table)


@pytest.mark.parametrize("format", ["csv", "parquet", "arrow"])
def test_a_reader_that_goes_ends_in_broken_pipe(format: str) -> None:
    program = (
        "import sys, numpy as np, pyarrow as pa\n"
        "from erdctl.io.tables import write_table\n"
        "table = pa.table({'t': np.random.default_rng(0).normal(size=400_000)})\n"
        "try:\n"
        f"    write_table(table, '-', '{format}')\n"
        "except BrokenPipeError:\n"
        "    sys.stderr.write('gone')\n"
    )
    done = subprocess.run(
        ["bash", "-c", '"$0" -c "$1" | head -c 10 > /dev/null', sys.executable, program],
        capture_output=True,
        text=True,
    )
    assert done.stderr == "gone"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize("format", ["csv", "parquet", "arrow"])
def test_full_disk(format: str) -> None:
    with pytest.raises(ComputationProblem, match="disk full while writing /dev/full"):
        write_table(pa.table({"t": np.arange(1e5)}), "/dev/full", format)


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".arrow", ".feather"])
def test_a_disk_that_fills_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    import resource
    import signal

    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"old")
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, old[1]))
    try:
        with pytest.raises(ComputationProblem, match=r"disk full .* nothing was written"):
            write_table(pa.table({"t": np.random.default_rng(0).normal(size=100_000)}), str(path))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)
        signal.signal(signal.SIGXFSZ, before)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"old"


def test_append_column_replaces_one_of_the_same_name() -> None:
    table = pa.table({"t": [1.0], "force_model": [2.0], "s": ["a"]})
    got = append_column(table, "force_model", np.array([3.0]))
    assert got.to_pydict() == {"t": [1.0], "s": ["a"], "force_model": [3.0]}


def test_table_of_a_recording() -> None:
    recording = Recording(
        t=np.array([0.0, 1.0, 0.0]),
        x=np.array([1.0, 2.0, 3.0]),
        xdot=np.zeros(3),
        duty=np.full(3, 0.5),
        starts=np.array([0, 2, 3]),
        names=("a", "b"),
    )
    table = table_of(recording)
    assert table.column_names == ["t", "x", "xdot", "duty", "record"]
    assert table["record"].to_pylist() == ["a", "a", "b"]
    assert table["x"].to_pylist() == [1.0, 2.0, 3.0]


def test_big_integers_in_parquet_survive_csv(tmp_path: Path) -> None:
    table = pa.table({"t": [1.0], "id": pa.array([2**64 - 1], pa.uint64())})
    write_table(table, str(tmp_path / "a.csv"))
    assert "18446744073709551615" in (tmp_path / "a.csv").read_text()


def test_only_columns_of_few_values_are_dictionaries(tmp_path: Path) -> None:
    path = str(tmp_path / "a.parquet")
    columns = {"x": np.arange(10.0), "duty": np.zeros(10), "record": ["a"] * 10}
    write_table(pa.table(columns), path)
    group = pq.read_metadata(path).row_group(0)
    encoded = [("RLE_DICTIONARY" in group.column(i).encodings) for i in range(3)]
    assert encoded == [False, True, True]


def test_writing_many_rows_prints_its_speed(tmp_path: Path) -> None:
    import time

    n = 1_000_000
    rng = np.random.default_rng(0)
    table = pa.table({c: rng.normal(size=n) for c in ("t", "x", "xdot", "force")})
    start = time.perf_counter()
    pq.write_table(table, tmp_path / "a.parquet")
    floor = time.perf_counter() - start
    start = time.perf_counter()
    write_table(table, str(tmp_path / "b.parquet"))
    print(f"write_table / pyarrow default: {(time.perf_counter() - start) / floor:.2f}")
    assert pq.read_table(tmp_path / "b.parquet").equals(table)


def test_an_empty_device_is_no_table() -> None:
    with pytest.raises(InputProblem):
        open_source(os.devnull)


def test_stream_holds_batches_of_bounded_size(
    capsysbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("erdctl.io.tables.BATCH", 10)
    write_table(pa.table({"t": np.arange(25.0)}), "-", "arrow")
    with pa.ipc.open_stream(io.BytesIO(capsysbinary.readouterr().out)) as reader:
        assert [b.num_rows for b in reader] == [10, 10, 5]
