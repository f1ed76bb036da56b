"""Tables of any width: whatever is in a cell stays whole, and lines are as wide as they may be."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from erdctl.report.layout import BOX, boxed, cells, lines, wrapped

CELL = st.text(alphabet="abc019.+-±µ阻 e\u0301", max_size=14).map(str.strip)


@st.composite
def tables(draw: st.DrawFn) -> tuple[list[str], list[list[str]]]:
    columns = draw(st.integers(1, 8))
    row = st.lists(CELL, min_size=columns, max_size=columns)
    return draw(row), draw(st.lists(row, min_size=1, max_size=6))


@given(tables(), st.one_of(st.none(), st.integers(1, 130)))
def test_no_cell_is_cut(table: tuple[list[str], list[list[str]]], width: int | None) -> None:
    header, rows = table
    out = lines(header, rows, width)
    for cell in [c for row in [header, *rows] for c in row]:
        assert any(cell in line for line in out), (cell, out)
    assert not any("\u2026" in line for line in out)


@given(tables(), st.integers(1, 130))
def test_a_line_is_no_wider_than_the_screen_or_one_entry(
    table: tuple[list[str], list[list[str]]], width: int
) -> None:
    header, rows = table
    widest = max(cells(c) for row in [header, *rows] for c in row)
    for line in lines(header, rows, width):
        assert cells(line) <= max(width, 2 * widest + 8), line
    if width >= 2 * widest + 8:
        assert all(cells(line) <= width for line in lines(header, rows, width))


@given(tables())
def test_without_a_limit_a_table_is_a_line_a_row(
    table: tuple[list[str], list[list[str]]],
) -> None:
    header, rows = table
    assert len(lines(header, rows)) == 1 + len(rows)
    assert lines(header, rows, boxed(header, rows) + BOX) == lines(header, rows)


@given(st.text(alphabet="ab 01.é阻", max_size=120), st.integers(1, 80))
def test_words_stay_whole(text: str, width: int) -> None:
    out = wrapped(text, width)
    assert out.split() == text.split()
    for line in out.splitlines():
        assert cells(line) <= width or len(line.split()) <= 1
    assert wrapped(text, None) == text


def test_columns_that_do_not_fit_come_below() -> None:
    out = lines(["record", "stroke", "force"], [["a", "36.01", "-18 to 18.1"]], 18)
    assert out == ["  record  stroke", "  a        36.01", "  record", "  a"] or out[:2] == [
        "  record: a", "    stroke: 36.01",
    ]  # fmt: skip
    listed = lines(["record", "force"], [["sine_0.5Hz_20mm_pwm10", "-18 to 18.1"]], 30)
    assert listed == ["  record: sine_0.5Hz_20mm_pwm10", "    force: -18 to 18.1"]
