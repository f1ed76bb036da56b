"""Every kind of bad log: refused with file, row, column, and what to do."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from erdctl.core.errors import ExitCode, InputProblem
from erdctl.io.logs import Log

Columns = dict[str, Any]
Write = Callable[..., str]
Read = Callable[..., Log]
Refused = Callable[..., str]

CSV, PARQUET, ARROW = "log.csv", "log.parquet", "log.arrow"
ALL = [CSV, PARQUET, ARROW]
FIRST = {CSV: 2, PARQUET: 1, ARROW: 1}  # row of the first sample


@pytest.fixture
def refused(read: Read) -> Refused:
    """Message of the refusal of a log, checked to begin with the file, row and column."""

    def refused(
        path: str, row: int | None = None, column: str | None = None, **options: Any
    ) -> str:
        with pytest.raises(InputProblem) as caught:
            read(path, **options)
        assert caught.value.exit_code == ExitCode.BAD_INPUT
        place = [f"row {row}"] if row is not None else []
        place += [f"column '{column}'"] if column is not None else []
        start = f"{path}: " + (", ".join(place) + ": " if place else "")
        assert str(caught.value).startswith(start), str(caught.value)
        return str(caught.value)[len(start) :]

    return refused


def set_at(columns: Columns, name: str, at: int, value: Any) -> None:
    columns[name] = np.array(columns[name])
    columns[name][at] = value


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("column", ["t", "x", "xdot", "duty", "force"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("at", [0, 123, 199])
def test_not_finite(
    columns: Columns, write: Write, refused: Refused, name: str, column: str, value: float, at: int
) -> None:
    set_at(columns, column, at, value)
    said = refused(write(columns, name), at + FIRST[name], column)
    assert f"found {value:g}, expected a number" in said


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("column", ["t", "x", "xdot", "duty", "force"])
def test_empty_cell(
    columns: Columns, write: Write, refused: Refused, name: str, column: str
) -> None:
    values: list[Any] = list(columns[column])
    values[57] = "" if name == CSV else None
    columns[column] = values
    said = refused(write(columns, name), 57 + FIRST[name], column)
    assert said.startswith("empty, expected a number")


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("value", [1e13, -1e300])
def test_absurd_numbers(
    columns: Columns, write: Write, refused: Refused, name: str, value: float
) -> None:
    set_at(columns, "force", 44, value)
    said = refused(write(columns, name), 44 + FIRST[name], "force")
    assert said == f"found {value:g}, expected a number below 1e12"


def test_absurd_integers(columns: Columns, write: Write, refused: Refused) -> None:
    columns["force"] = [0] * 199 + [2**60 + 1]
    assert "found 1.15292e+18" in refused(write(columns, PARQUET), 200, "force")


@pytest.mark.parametrize(
    ("cell", "words"),
    [
        ("abc", "found 'abc', expected a number"),
        ('"1,5"', "found '1,5', expected a number with a decimal point: 1.5"),
        ("NA", "found 'NA', expected a number"),
        ("null", "found 'null', expected a number"),
        ("1.2.3", "found '1.2.3'"),
        ("0x10", "found '0x10'"),
        ("1_0", "found '1_0'"),
        ("--5", "found '--5'"),
        ("true", "found 'true'"),
        ("5 N", "found '5 N'"),
        ("x" * 100, f"found '{'x' * 40}', expected"),
    ],
)
def test_text_in_csv(
    columns: Columns, write: Write, refused: Refused, cell: str, words: str
) -> None:
    columns["force"] = [cell if i == 150 else str(v) for i, v in enumerate(columns["force"])]
    assert words in refused(write(columns), 152, "force")


def test_a_row_of_units(columns: Columns, write: Write, refused: Refused) -> None:
    units = ["s", "mm", "m/s", "-", "furlong", ""]
    rows = {n: [u, *c] for (n, c), u in zip(columns.items(), units, strict=True)}
    assert "stored with unit 'furlong', which is a length" in refused(write(rows), None, "force")


@pytest.mark.parametrize("name", [PARQUET, ARROW])
@pytest.mark.parametrize(
    ("values", "row", "words"),
    [
        (["1.5"] * 120 + ["abc"] + ["1"] * 79, 121, "found 'abc', expected a number"),
        (["n/a"] + ["1"] * 199, 1, "found 'n/a', expected a number"),
        (["1.5"] * 200, None, "holds numbers as string; store them as float64"),
        ([True] * 200, 1, "found 'true', expected a number"),
        ([[1.0]] * 200, None, "holds list<"),
        ([datetime.datetime(2026, 1, 1)] * 200, None, "holds dates or durations"),
    ],
)
def test_other_types_in_binary_logs(
    columns: Columns, write: Write, refused: Refused, name: str, values: Any, row: int, words: str
) -> None:
    columns["force"] = values
    assert words in refused(write(columns, name), row, "force")


def test_a_column_of_nulls(columns: Columns, write: Write, refused: Refused) -> None:
    columns["force"] = pa.nulls(200)
    assert "empty" in refused(write(columns, PARQUET), 1, "force")


# --- lines of CSV that are not row + 2


def test_lines_are_counted_past_blank_lines_and_line_ends_in_quotes(
    columns: Columns, refused: Refused, tmp_path: Path
) -> None:
    lines = ["\n", "note,t,x,duty\n"]
    lines += ['"two\nlines",0,0,0\n', "\n", "\n", "a,1,0,0\n", '"""q"" ",2,0,0\n', "b,3,0,7\n"]
    path = tmp_path / "log.csv"
    for end in ("\n", "\r\n"):
        path.write_bytes("".join(lines).replace("\n", end).encode())
        refused(str(path), 9, "duty", need_force=False)
        path.write_bytes("".join(lines).replace("\n", end).replace("0,7", "0,seven").encode())
        refused(str(path), 9, "duty", need_force=False)
        path.write_bytes("".join(lines).replace("\n", end).replace("0,7", "0,").encode())
        refused(str(path), 9, "duty", need_force=False)


@pytest.mark.parametrize("quoted", [False, True])
@pytest.mark.parametrize("spoil", ["value", "text", "cells"])
def test_lines_far_into_a_long_file(
    refused: Refused,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    quoted: bool,
    spoil: str,
) -> None:
    monkeypatch.setattr("erdctl.io.csv_in.SUSPECT", 5000)
    note = '"a ""b"" c\nd"' if quoted else "abc"
    rows = [f"{i * 0.001},{i * 1e-6},{note}" for i in range(30_000)]
    at = 23_456
    rows[at] = {
        "value": f"{at * 0.001},5.5,{note}",
        "text": f"{at * 0.001},zzz,{note}",
        "cells": f"{at * 0.001},0",
    }[spoil]
    path = tmp_path / "log.csv"
    path.write_text("t,x,note\n" + "\n".join(rows) + "\n")
    line = 2 + at * (2 if quoted else 1)
    column = None if spoil == "cells" else "x"
    refused(str(path), line, column, need_force=False, keep_table=True)


def test_a_stray_quote_in_a_long_file(
    refused: Refused, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("erdctl.io.csv_in.SUSPECT", 5000)
    monkeypatch.setattr("erdctl.io.csv_in.MOST_SUSPECT", 20_000)
    rows = [f'{i * 0.001},{i * 1e-6},5" pipe' for i in range(9_999)]
    path = tmp_path / "log.csv"
    path.write_text("t,x,note\n" + "\n".join([*rows, "bad,0,u"]) + "\n")
    refused(str(path), 10_001, "t", need_force=False)


def test_stdin_rows(
    columns: Columns, write: Write, read: Read, stdin: Callable[[bytes], None]
) -> None:
    columns["force"] = [*map(str, columns["force"][:-1]), "oops"]
    stdin(Path(write(columns)).read_bytes())
    with pytest.raises(InputProblem, match="stdin: row 201, column 'force': found 'oops'"):
        read("-")


@pytest.mark.parametrize(
    ("text", "row", "words"),
    [
        ("t,x\n0,1\n1,2,3\n", 3, "3 cells where the header has 2 columns"),
        ("t,x\n0,1\n1\n", 3, "1 cell where the header has 2 columns"),
        ("t,x\n0,1\n1,0,5\n2,0,5\n", 3, "a cell that holds a comma must be quoted"),
        ("# bench 3\nt,x\n0,1\n1,2,3\n", 4, "3 cells where the header has 2 columns"),
        ("bench 3\nt;x\n0;1\n1;b\n", 4, "column 'x': found 'b', expected a number"),
        ("t;x\n0;1\na;2\n1;2\nc;3\n", 3, "column 't': found 'a', expected a number"),
        ("t,x\n", None, "a header but no samples"),
        ("t,x", None, "a header but no samples"),
        ("t,x\n\n\n", None, "a header but no samples"),
        ("0,1\n1,2\n", None, "no column 't' and 'x'; the log has column_1, column_2"),
        ('t,x\n0,"1\n2,3\n', 2, "found '1\n2,3"),
    ],
)
def test_malformed_csv(tmp_path: Path, read: Read, text: str, row: int | None, words: str) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(text.encode("latin1"))
    with pytest.raises(InputProblem) as caught:
        read(str(path), need_force=False)
    assert words in str(caught.value)
    assert (f": row {row}" if row else ": ") in str(caught.value)


def test_a_quote_left_open_over_much_text(tmp_path: Path, read: Read) -> None:
    path = tmp_path / "log.csv"
    path.write_text('t,x,note\n0,0,"' + "u,v\n" * 2_000_000)
    with pytest.raises(InputProblem, match=r"row 2: .*a quote may be left open"):
        read(str(path), need_force=False)


def test_bytes_that_are_not_utf8_matter_only_where_they_are_read(
    tmp_path: Path, read: Read
) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"t,x,note\n0,0,\xe9\n1,1,\xe9\n")
    assert len(read(str(path), need_force=False).recording) == 2


# --- columns


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("column", ["t", "x", "force"])
def test_missing_column(
    columns: Columns, write: Write, refused: Refused, name: str, column: str
) -> None:
    columns = {(n.upper() + "_1" if n == column else n): c for n, c in columns.items()}
    said = refused(write(columns, name), None, column)
    assert f"no column '{column}'; the log has " in said
    assert f'e.g. --map "{column}={column.upper()}_1' in said


def test_missing_column_with_nothing_like_it(refused: Refused, write: Write) -> None:
    path = write({"t": [0, 1], "qqq": [0, 1]})
    assert refused(path, None, "x", need_force=False).endswith('--map "x=NAME[UNIT]"')


def test_missing_source_of_a_map(columns: Columns, write: Write, refused: Refused) -> None:
    said = refused(write(columns), maps=["force=Forc[N]"])
    assert "the log has no column 'Forc'; close to it: force" in said


@pytest.mark.parametrize("name", ALL)
def test_single_sample(columns: Columns, write: Write, refused: Refused, name: str) -> None:
    columns["record"] = ["a"] * 100 + ["lone"] + ["b"] * 99
    said = refused(write(columns, name), 100 + FIRST[name])
    assert said == "record 'lone' has a single sample; a record needs at least two"


def test_a_log_of_one_sample(write: Write, refused: Refused) -> None:
    said = refused(write({"t": [0.0], "x": [0.0]}), 2, need_force=False)
    assert said == "record has a single sample; a record needs at least two"


@pytest.mark.parametrize("name", ALL)
def test_record_that_comes_back(
    columns: Columns, write: Write, refused: Refused, name: str
) -> None:
    columns["record"] = ["a"] * 50 + ["b"] * 50 + ["a"] * 100
    columns["t"] = np.arange(200) * 1e-3
    said = refused(write(columns, name), 100 + FIRST[name], "record")
    assert said == "record 'a' comes back after another record; sort the rows by record"


@pytest.mark.parametrize("name", ALL)
def test_record_without_a_name(columns: Columns, write: Write, refused: Refused, name: str) -> None:
    columns["record"] = ["a"] * 100 + ["" if name == CSV else None] * 100
    assert "empty, expected the name of a record" in refused(
        write(columns, name), 100 + FIRST[name], "record"
    )


def test_records_of_no_text(columns: Columns, write: Write, refused: Refused) -> None:
    columns["record"] = [[1]] * 200
    assert "expected text" in refused(write(columns, PARQUET), None, "record")


# --- time


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("at", [1, 99, 150, 199])
def test_repeated_time(
    columns: Columns, write: Write, refused: Refused, name: str, at: int
) -> None:
    set_at(columns, "t", at, columns["t"][at - 1])
    said = refused(write(columns, name), at + FIRST[name], "t")
    value = columns["t"][at]
    assert f"within a record, but {value:.9g} s is there twice; remove the duplicated row" in said


@pytest.mark.parametrize("name", ALL)
def test_falling_time(columns: Columns, write: Write, refused: Refused, name: str) -> None:
    set_at(columns, "t", 130, 0.0295)
    columns["t"][129] = 0.0299
    said = refused(write(columns, name), 130 + FIRST[name], "t")
    assert "but falls from 0.0299 s to 0.0295 s; sort the rows by time" in said


def test_time_that_restarts_without_records(
    columns: Columns, write: Write, refused: Refused
) -> None:
    del columns["record"]
    columns["t"][100:] += 0.05
    said = refused(write(columns), 102, "t")
    assert "falls from 0.099 s to 0.05 s; if a new test begins here, add a column 'record'" in said


def test_only_the_first_fault_of_many_counts(
    write: Write, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("erdctl.io.checks._BLOCK", 7)
    t = np.arange(100.0) * 1e-3
    for at in (14, 21, 50, 99):
        bad = t.copy()
        bad[at:] -= 0.002
        refused(write({"t": bad, "x": t * 0}), at + 2, "t", need_force=False)


def test_records_may_begin_at_block_ends(
    write: Write, read: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("erdctl.io.checks._BLOCK", 7)
    t = np.tile(np.arange(7) * 1e-3, 4)
    path = write({"t": t, "x": t * 0, "record": np.repeat(list("abcd"), 7)})
    assert read(path, need_force=False).recording.names == tuple("abcd")


def test_time_too_coarse_for_32_bits(write: Write, refused: Refused) -> None:
    t = (np.arange(1000) * 1e-4 + 5000.0).astype(np.float32)
    path = write({"t": t, "x": np.zeros(1000)}, PARQUET)
    assert "t is stored as 32-bit floats, too coarse" in refused(path, 2, "t", need_force=False)


def test_time_in_milliseconds_is_remarked(write: Write, read: Read, said: list[str]) -> None:
    path = write({"t": np.arange(100.0), "x": np.zeros(100), "xdot": np.zeros(100)})
    read(path, need_force=False)
    assert f'{path}: t has a step of 1 s; if it is in milliseconds, give --map "t=t[ms]"' in said


# --- ranges


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("duty", 35.0, 'expected a fraction 0..1; for percent give --map "duty=duty[percent]"'),
        ("duty", 1.01, "if this is measurement noise, clip it first"),
        ("duty", -0.01, "if this is measurement noise, clip it first"),
        ("duty", 255.0, "it is no PWM duty cycle"),
        ("x", 12.5, 'expected a deflection within ±1 m; for millimetres give --map "x=x[mm]"'),
        ("x", -1.5, "for millimetres"),
        ("temperature", 295.0, 'for kelvin give --map "temperature=temperature[K]", for °F [degF]'),
        ("temperature", -120.0, "expected °C between -100 and 200"),
    ],
)
def test_ranges(
    columns: Columns,
    write: Write,
    refused: Refused,
    name: str,
    column: str,
    value: float,
    words: str,
) -> None:
    columns.setdefault("temperature", np.full(200, 21.0))
    set_at(columns, column, 77, value)
    said = refused(write(columns, name), 77 + FIRST[name], column)
    assert said.startswith(f"found {value:g}, expected")
    assert words in said


def test_the_ends_of_the_ranges_are_inside(columns: Columns, write: Write, read: Read) -> None:
    columns["duty"] = np.repeat([0.0, 1.0], 100)
    assert read(write(columns)).recording.duty[-1] == 1.0


def test_ranges_apply_after_the_map(columns: Columns, write: Write, refused: Refused) -> None:
    columns["PWM"] = np.repeat([10.0, 5000.0], 100)
    said = refused(write(columns), 102, "PWM", maps=["duty=PWM[%]"])
    assert said.startswith("found 50, expected a fraction")


def test_force_model_is_checked_too(columns: Columns, write: Write, refused: Refused) -> None:
    columns["force_model"] = columns["force"].copy()
    columns["force_model"][3] = np.nan
    refused(write(columns), 5, "force_model")


def test_a_pause_where_xdot_is_derived(columns: Columns, write: Write, refused: Refused) -> None:
    del columns["xdot"]
    columns["t"][140:] += 1.0
    said = refused(write(columns), 142, "t")
    assert "give a column xdot, or begin a new record here" in said
