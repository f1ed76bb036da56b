"""Texts once read otherwise than they say: units, comments, thousands, what is cut off."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from erdctl.core.errors import InputProblem
from erdctl.core.messages import counted
from erdctl.io.convert import read_converted
from erdctl.io.logs import read_logs

N = 40
LINES = [f"{i * 0.005:.3f};{i * 1e-4:.4f};{10 + i * 0.125:.3f};0.2" for i in range(N)]
NAMES = "t;x;force;duty"
SAMPLES = [";".join(line.split(";")[1:3]) for line in LINES]
FORCE = 10 + np.arange(N) * 0.125

Converted = Callable[..., tuple[pa.Table, str]]


@pytest.fixture
def read(tmp_path: Path) -> Converted:
    """All columns of a text, and what was said."""

    def read(
        *lines: str, between: str = ";", end: str = "\n", text: str | None = None,
        maps: tuple[str, ...] = (),
    ) -> tuple[pa.Table, str]:  # fmt: skip
        path = tmp_path / "lab.csv"
        path.write_text(("\n".join(lines) + end).replace(";", between), newline="")
        said: list[str] = []
        table = read_converted(str(path), text=text, maps=maps, say=said.append)
        return table, "\n".join(said).replace(f"{path}: ", "")

    return read


def force_of(found: tuple[pa.Table, str]) -> np.ndarray:
    return found[0].column("force").to_numpy()


# --- units


@pytest.mark.parametrize("between", [";", ",", "\t", "|", "  "])
def test_units_above_the_names(read: Converted, between: str) -> None:
    found = read("s;mm;kN;-", NAMES, *LINES, between=between)
    assert "header in line 2, units in line 1" in found[1]
    assert np.allclose(force_of(found), FORCE * 1e3)
    assert np.allclose(found[0].column("x").to_numpy(), np.arange(N) * 1e-7)


@pytest.mark.parametrize(
    ("above", "text"),
    [
        (["s;m;kN;-", "", "Rig 7", NAMES], None),
        (["# s;m;kN;-", NAMES], None),
        (["s;m;kN;-", NAMES], "header=2"),
        (["s;m;kN;-", "A;B;C;D", NAMES], None),
        (["s;m;kN;-", NAMES, "s;m;kN;-"], None),
    ],
)
def test_units_above_the_names_wherever_they_are(
    read: Converted, above: list[str], text: str | None
) -> None:
    assert np.allclose(force_of(read(*above, *LINES, text=text)), FORCE * 1e3)


def test_a_row_that_states_a_plain_number_alone(read: Converted) -> None:
    assert "units in line 2" in read(NAMES, ";;;[-]", *LINES)[1]


def test_a_dash_for_the_force(read: Converted) -> None:
    with pytest.raises(InputProblem, match=r"'force': stored with no unit \(- or 1\), which is a"):
        read(NAMES, "s;m;-;-", *LINES)


def test_units_above_and_below_that_differ(read: Converted) -> None:
    lines = ["s;m;kN;-", NAMES, "s;m;N;-", *LINES]
    with pytest.raises(InputProblem, match=r"row 1: other units than in row 3; .*units=1"):
        read(*lines)
    assert np.allclose(force_of(read(*lines, text="header=2,units=3")), FORCE)
    assert np.allclose(force_of(read(*NAMES.splitlines(), *LINES)), FORCE)


def test_units_without_names(read: Converted) -> None:
    lines = ["s;m;kN;-", NAMES, *LINES]
    found = read(*lines, text="header=none,units=1", maps=("force=column_3",))
    assert "no header row, units in line 1" in found[1]
    assert np.allclose(force_of(found), FORCE * 1e3)


# --- thousands


US = [f'{i * 0.005:.3f};0.001;"{950 + 10 * i:,d}";0.2' for i in range(N)]
NEWTONS = 950.0 + 10 * np.arange(N)


@pytest.mark.parametrize("late", [0, 60, 500])
def test_quoted_commas_may_separate_thousands(read: Converted, late: int) -> None:
    lines = [f"{0.005 * (i - late):.3f};0.001;900;0.2" for i in range(late)] + US
    said = "--text thousands=comma" if late else "'1,000' beside numbers with a decimal point"
    with pytest.raises(InputProblem, match=f"row {late + 7}[:,].*{said}") as caught:
        read(NAMES, *lines, between=",")
    assert "1.000" not in str(caught.value)
    found = read(NAMES, *lines, between=",", text="thousands=comma")
    assert np.array_equal(force_of(found)[late:], NEWTONS)


def test_quoted_commas_and_no_decimal_sign(read: Converted) -> None:
    lines = [f'{i};0;"{950 + 10 * i:,d}";1' for i in range(N)]
    with pytest.raises(InputProblem, match=r"row 7: '1,000' may be 1.000 or 1000, and no number"):
        read(NAMES, *lines, between=",")
    decimal = force_of(read(NAMES, *lines, between=",", text="decimal=comma"))
    assert np.array_equal(decimal[5:], NEWTONS[5:] / 1e3)
    late = [*lines * 11, "999;0.5;1;1"]
    with pytest.raises(InputProblem, match=r"row 7: '1,000' beside numbers with a decimal point"):
        read(NAMES, *late, between=",")


@pytest.mark.parametrize(("sign", "called"), [("'", "apostrophe"), (" ", "space")])
def test_other_thousands_that_begin_late(read: Converted, sign: str, called: str) -> None:
    lines = [*LINES * 12, f"9.000;0.001;1{sign}076.5;0.2"]
    words = f"row {len(lines) + 1}, column 'force': .*--text thousands={called}"
    with pytest.raises(InputProblem, match=words):
        read(NAMES, *lines)


# --- comments, and what looks like one

ERRORS = ["#N/A", "#NV", "#DIV/0!", "#VALUE!", "#WERT!", "#NAME?", "#¡VALOR!", "########"]


@pytest.mark.parametrize("between", [";", ",", "\t", "|", " "])
@pytest.mark.parametrize("cell", ERRORS)
def test_errors_of_a_spreadsheet_are_no_comments(read: Converted, between: str, cell: str) -> None:
    for at in (0, 5, N - 1):
        lines = LINES.copy()
        lines[at] = cell + lines[at][5:]
        with pytest.raises(InputProblem, match=f"row {at + 3}.*") as caught:
            read("# rig 7", NAMES, *lines, between=between)
        assert at == 0 or f"column 't': found '{cell}'" in str(caught.value)


@pytest.mark.parametrize("lines", [[NAMES, "# a"], [NAMES, "# a", "s;m;N;-", "# b"]])
def test_comments_below_the_names_are_not_the_end_of_a_header(
    read: Converted, lines: list[str]
) -> None:
    table, said = read("# rig 7", *lines, *LINES)
    assert table.column_names == NAMES.split(";")
    assert "header in line 2" in said


COMMENTS = ["#", "# N/A;1;2;3", "#0.1;2;3;4", "## a", "% b", "// c", "###;;;"]


@pytest.mark.parametrize("comment", COMMENTS)
def test_comments_are_left_out(read: Converted, comment: str) -> None:
    found = read("# rig 7", NAMES, *LINES[:7], comment, *LINES[7:])
    assert np.array_equal(force_of(found), FORCE)
    assert "lines with # left out" in found[1]


@pytest.mark.parametrize("between", ["\t", ";"])
@pytest.mark.parametrize("before", ["n;", ""])
def test_units_of_percent_are_no_comment(read: Converted, between: str, before: str) -> None:
    empty = before.replace("n", "")
    lines = [f"{before}0.2;{10 + i};{5 * i}" for i in range(N)]
    table, said = read(f"{before}duty;force;t", f"{empty}%;N;ms", *lines, between=between)
    assert "header in line 1, units in line 2" in said
    assert "left out" not in said
    assert np.allclose(table.column("duty").to_numpy(), 0.002)
    assert np.allclose(table.column("t").to_numpy(), np.arange(N) * 0.005)


# --- a stated interval


@pytest.mark.parametrize(
    ("rate", "interval"),
    [
        ("1,000 Hz", None), ("1 000 Hz", None), ("200,200", None), ("1'000 Hz", "0.001"),
        ("1,000,000 Hz", "1e-06"), ("1,000.0 Hz", "0.001"), ("0,5 kHz", "0.002"),
        ("200 Hz", "0.005"), ("1.000 Hz", "1"),
        ("200 Hz\nSampling time: 12:30:05", "0.005"),
    ],
)  # fmt: skip
def test_a_rate_is_said_only_if_it_is_clear(
    rate: str, interval: str | None, tmp_path: Path
) -> None:
    (tmp_path / "rate.csv").write_text("\n".join([f"Sample rate: {rate}", "x;force", *SAMPLES]))
    with pytest.raises(InputProblem) as caught:
        read_logs([str(tmp_path / "rate.csv")], need_force=True, report=str)
    found = re.search("interval=(.*) makes a time of it", str(caught.value))
    assert (found and found[1]) == interval


# --- which row


@pytest.mark.parametrize("between", [";", ",", "\t"])
@pytest.mark.parametrize("first", ["10:00:00", "20240709T000059", "2 d 00:00:59"])
def test_a_word_among_clock_times(read: Converted, between: str, first: str) -> None:
    lines = [f"{first}.{5 * i:03d};0.001;5.5" for i in range(N)]
    found = read("t;x;force", *lines, between=between)[0]
    assert np.allclose(found.column("t").to_numpy(), 0.005 * np.arange(N))
    lines[20] = "abc;0.001;5.5"
    with pytest.raises(InputProblem, match="row 22, column 't': found 'abc', expected a "):
        read("t;x;force", *lines, between=between)


NOTED = [line + (';"a\nb"' if i % 5 == 4 else ";c") for i, line in enumerate(LINES)]


@pytest.mark.parametrize("between", [";", ",", "\t", "|"])
def test_rows_below_cells_of_several_lines(read: Converted, between: str) -> None:
    found = read(NAMES + ";note", *NOTED, between=between)
    assert np.array_equal(force_of(found), FORCE)
    assert found[0].column("note")[4].as_py() == "a\nb"
    bad = [*NOTED[:30], "0.150;0.003;ERR;0.2;c", *NOTED[31:]]
    with pytest.raises(InputProblem, match="row 38, column 'force': found 'ERR'") as caught:
        read(NAMES + ";note", *bad, between=between)
    assert " cells where" not in str(caught.value)
    back = [*NOTED[:30], NOTED[28], *NOTED[31:]]
    with pytest.raises(InputProblem, match="row 38, column 't': "):
        read(NAMES + ";note", *back, between=between)


@pytest.mark.parametrize("between", [";", ",", "\t"])
@pytest.mark.parametrize("blank", [";;;", "   ", ""])
def test_rows_below_an_empty_one(read: Converted, between: str, blank: str) -> None:
    lines = [*LINES[:10], blank, *LINES[10:]]
    row = 13 if blank == ";;;" else 23
    lines[20] = "0.045" + lines[20][5:]
    with pytest.raises(InputProblem, match=f"row {row}, column 't': "):
        read("Rig 7", NAMES.replace("x", "x "), *lines, between=between)


@pytest.mark.parametrize("between", [";", ","])
@pytest.mark.parametrize(
    "bad", ["---;---;---;---", "ERR;OVL;---;xx", ";ERR;ERR;ERR", "-;-;-;-", "0.0;---;---;---"]
)
def test_first_samples_without_values(read: Converted, between: str, bad: str) -> None:
    for times in (1, 2):
        with pytest.raises(InputProblem, match=r"row [23](: neither names nor values|, column)"):
            read(NAMES, *[bad] * times, *LINES, between=between)


@pytest.mark.parametrize("between", [";", ","])
def test_a_name_that_comes_twice_has_its_row(read: Converted, between: str) -> None:
    with pytest.raises(InputProblem, match="row 2: columns 1 and 2 are both called 't'; rename"):
        read("" if between == "," else "Rig 7", "t;t;force;duty", *LINES, between=between)


@pytest.mark.parametrize("names", ["t, x, force, stamp", "t,x,force,", "t,x,,stamp"])
def test_names_that_are_not_their_cells(read: Converted, names: str) -> None:
    lines = [f"{i * 0.005:.3f},{i * 1e-4:.4f},{i + 0.5},2022-04-{1 + i % 28:02d}" for i in range(N)]
    table, _ = read(names, *lines)
    assert np.allclose(table.column("x").to_numpy(), np.arange(N) * 1e-4)
    assert np.allclose(table.column(2).to_numpy().astype(float), np.arange(N) + 0.5)
    assert table.column(3)[0].as_py() == "2022-04-01"
    lines[30] = "0.150,abc" + lines[30][12:]
    with pytest.raises(InputProblem, match="row 32, column 'x': found 'abc'"):
        read(names, *lines)


# --- cut off


@pytest.mark.few(5)
@pytest.mark.parametrize("between", [";", ",", "\t", " "])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le"])
def test_a_last_cell_that_is_cut_off(tmp_path: Path, between: str, encoding: str) -> None:
    text = "\n".join([NAMES, *LINES * 200])
    force = "\n".join(["t;x;force", *[line[:-4] for line in LINES]])
    path = tmp_path / "cut.csv"
    for whole, cuts in ((text, (0, 1)), (force, (0, 1, 2, 3, 4)), (force + "\n", (0, 2, 4))):
        for cut in cuts:
            path.write_bytes(whole[: len(whole) - cut].replace(";", between).encode(encoding))
            said: list[str] = []
            read_converted(str(path), say=said.append)
            remarks = [line for line in said if "cut off there" in line]
            assert len(remarks) == (cut > whole.endswith("\n"))
            assert "read as" not in "".join(remarks)


@pytest.mark.parametrize("last", ["0.2", "0.25", "", "-10.2e3"])
def test_a_missing_line_end_alone_is_not_remarked_on(read: Converted, last: str) -> None:
    lines = [re.sub("0.2$", f"{i * i / 64:g}", line) for i, line in enumerate(LINES)]
    lines[-1] = f"{lines[-1].rpartition(';')[0]};{last}"
    assert "cut off" not in read(NAMES.replace("duty", "p"), *lines, end="")[1]


# --- ends and letters


@pytest.mark.parametrize("between", [";", "\t", "|"])
@pytest.mark.parametrize("rows", [1, 3, 40_000])
def test_empty_rows_at_the_end(read: Converted, between: str, rows: int) -> None:
    found = read("Rig 7", NAMES, *LINES, *[";;;"] * rows, between=between)
    assert np.array_equal(force_of(found), FORCE)
    assert f", {counted(rows, 'empty row')} at the end left out" in found[1]


def test_a_stray_byte_makes_no_other_letters_of_the_rest(tmp_path: Path) -> None:
    path = tmp_path / "stray.csv"
    head = "# Prüfstand für Öl\nZeit;Weg;Kraft;Tastverhältnis\n".encode()
    body = ("\n".join(LINES) + "\n").encode()
    path.write_bytes(head + b"# 25 \xb0C\n" + body)
    with pytest.raises(InputProblem, match="row 3: not UTF-8: byte 0xb0 near '# 25 '; say what it"):
        read_converted(str(path), say=str)
    path.write_bytes(head.decode().encode("latin-1") + b"# 25 \xb0C\n" + body)
    assert "Tastverhältnis" in read_converted(str(path), say=str).column_names
    path.write_bytes(head + b"# 25 \xb0C\n" + body)
    table = read_converted(str(path), text="encoding=latin-1", say=str)
    assert table.column_names[3] == "TastverhÃ¤ltnis"
