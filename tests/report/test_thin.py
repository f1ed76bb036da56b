"""Thinning: nothing that would be seen is lost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.report import thin

ONE = np.array([0, 6], dtype=np.intp)


def test_check_value() -> None:
    values = np.array([0.0, 5, 1, 9, 2, 3])
    assert thin.series(values, ONE, 6).tolist() == [0, 1, 2, 3, 4, 5]
    many = np.repeat(values, 10)
    kept = thin.series(many, np.array([0, 60]), 2)
    assert {0.0, 5.0, 1.0} <= set(many[kept][kept < 30].tolist())
    assert {9.0, 2.0, 3.0} <= set(many[kept][kept >= 30].tolist())


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 3000), st.integers(1, 50), st.integers(0, 2**32 - 1))
def test_every_pixel_column_keeps_its_extremes(n: int, columns: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.standard_normal(n)
    cut = np.unique(rng.integers(0, n, 3))
    starts = np.unique(np.concatenate([[0], cut, [n]])).astype(np.intp)
    kept = thin.series(values, starts, columns)
    assert np.all(np.diff(kept) > 0)
    per = -(-n // columns)
    for a in range(0, n, per):
        here = kept[(kept >= a) & (kept < a + per)]
        assert values[here].max() == values[a : a + per].max()
        assert values[here].min() == values[a : a + per].min()
        assert {a, min(a + per, n) - 1} <= set(here.tolist())
    if len(starts) <= columns:
        assert {0, n - 1} <= set(kept.tolist())
    assert len(kept) <= 4 * (columns + 1) + 2 * len(starts) or per <= 4


def test_a_line_breaks_between_records() -> None:
    rows = np.array([0, 2, 3, 5], dtype=np.intp)
    (x,) = thin.gapped(rows, np.array([0, 3, 6]), np.arange(6.0))
    assert np.array_equal(x, [0, 2, np.nan, 3, 5], equal_nan=True)


def test_pieces_are_joined_with_gaps() -> None:
    (x,) = thin.joined([np.array([0, 1]), np.array([4])], np.arange(6.0))
    assert np.array_equal(x, [0, 1, np.nan, 4], equal_nan=True)
    (none,) = thin.joined([], np.arange(6.0))
    assert none.size == 0


@pytest.mark.parametrize("n", [1, 7, 200_003])
def test_a_cloud_fills_the_cells_that_all_samples_fill(n: int) -> None:
    rng = np.random.default_rng(n)
    x, y = rng.standard_normal((2, n))
    codes = rng.integers(0, 3, n).astype(np.int16)
    kept = thin.cloud(x, y, codes, 3, cells=(40, 30))

    def cells(rows: np.ndarray) -> set[tuple[int, int]]:
        spans = [max(float(np.ptp(v)), 1e-300) for v in (x, y)]
        u = np.floor((x[rows] - x.min()) / spans[0] * 40 * (1 - 1e-9)).astype(int)
        v = np.floor((y[rows] - y.min()) / spans[1] * 30 * (1 - 1e-9)).astype(int)
        return set(zip(u.tolist(), v.tolist(), strict=True))

    for group, rows in enumerate(kept):
        assert np.all(codes[rows] == group)
        assert cells(rows) == cells(np.flatnonzero(codes == group))
        assert len(rows) == len(cells(rows))  # one of each cell, no more


def test_an_outline_has_the_extremes_of_each_group() -> None:
    rng = np.random.default_rng(1)
    x, y = rng.standard_normal((2, 150_000))
    codes = (np.arange(150_000) // 70_000).astype(np.int16)
    codes[-500:] = rng.integers(0, 3, 500)
    for group, rows in enumerate(thin.outline(x, y, codes, 3)):
        at = codes == group
        for v in (x, y):
            assert v[rows].min() == v[at].min()
            assert v[rows].max() == v[at].max()
        assert len(rows) < 30_000


def test_a_constant_channel_is_no_trouble() -> None:
    x = np.zeros(100)
    y = np.arange(100.0)
    (rows,) = thin.cloud(x, y, np.zeros(100, dtype=np.int16), 1, cells=(10, 10))
    assert len(rows) == 10
