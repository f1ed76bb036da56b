"""Thinned samples keep every extreme, and lines are drawn where they are true."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.report.page.thin import keep, lines, reversals


def test_check_value() -> None:
    column = np.array([0.0, 9, 1, 1, -5, 1, 8, 1])
    assert keep([column], 7).tolist() == [0, 1, 3, 4, 6, 7]


@pytest.mark.parametrize("n", [11, 5_000, 99_991])
def test_extremes_stay_and_the_number_is_kept_to(n: int) -> None:
    random = np.random.default_rng(n)
    columns = [random.standard_normal(n).cumsum(), random.standard_normal(n)]
    columns[1][n // 3] = 40.0  # one sample of all
    rows = keep(columns, 3_000)
    assert len(rows) <= 3_000
    assert np.all(np.diff(rows) > 0)
    assert rows[0] == 0
    assert rows[-1] == n - 1
    for column in columns:
        assert column[rows].min() == column.min()
        assert column[rows].max() == column.max()
    # Nowhere is a long stretch left out.
    assert np.diff(rows).max() <= max(1, n // 500)


def test_few_samples_are_all_kept() -> None:
    assert keep([np.zeros(10)], 10).tolist() == list(range(10))


def test_both_sides_of_a_reversal_are_kept() -> None:
    xdot = np.sin(np.linspace(0.1, 40.0, 20_000))
    rows = keep([xdot], 900, reversals(xdot))
    turns = np.flatnonzero(np.diff(np.sign(xdot)))
    assert len(turns) == 12
    assert set(turns) | set(turns + 1) <= set(rows.tolist())


def test_lines_end_at_records_levels_and_gaps() -> None:
    t = np.concatenate([np.arange(100) * 0.01] * 2)
    xdot = np.cos(2 * np.pi * t)  # a period of 1 s: at most 6 samples apart
    level = np.where(np.arange(200) < 50, 0, 1)
    kept = np.array([0, 1, 5, 30, 31, 49, 50, 51, 99, 100, 101])
    joined = lines(kept, t=t, xdot=xdot, level=level, starts=np.array([0, 100, 200]))
    #                       0  1  5 30 31 49 50 51 99 100 101
    assert joined.tolist() == [0, 1, 1, 0, 1, 0, 0, 1, 0, 0, 1]
