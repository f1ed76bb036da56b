"""Arrow arrays and NumPy arrays without copies, and runs of text."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.io import arrays
from erdctl.io.arrays import arrow, runs_of_text, view


@pytest.mark.parametrize("kind", [pa.float64(), pa.int8(), pa.int32(), pa.uint16(), pa.int64()])
def test_views_of_slices(kind: pa.DataType) -> None:
    array = pa.array([1, 2, 3, 4, 5], kind)
    assert view(array).tolist() == [1, 2, 3, 4, 5]
    assert view(array.slice(2, 2)).tolist() == [3, 4]
    assert view(array.slice(5)).tolist() == []
    assert view(pa.array([], kind)).tolist() == []


def test_there_and_back_shares_memory() -> None:
    values = np.arange(5.0)
    assert np.shares_memory(view(arrow(values)), values)
    assert arrow(values).equals(pa.array([0.0, 1.0, 2.0, 3.0, 4.0]))


def test_strided_values() -> None:
    assert arrow(np.arange(10.0)[::3]).to_pylist() == [0.0, 3.0, 6.0, 9.0]


@pytest.mark.parametrize("kind", [pa.string(), pa.large_string()])
@pytest.mark.parametrize("most", [2**31 - 1, 40, 13])
@given(
    st.lists(
        st.tuples(
            st.text(st.characters(blacklist_categories=("Cs",)), max_size=3), st.integers(0, 9)
        )
    )
)
def test_runs_of_text(kind: pa.DataType, most: int, runs: list[tuple[str, int]]) -> None:
    before = arrays.MOST_BYTES
    arrays.MOST_BYTES = most
    try:
        lengths = np.array([n for _, n in runs], np.intp)
        got = runs_of_text([text for text, _ in runs], lengths, kind)
    finally:
        arrays.MOST_BYTES = before
    got.validate(full=True)
    assert got.type == kind
    assert got.to_pylist() == [text for text, n in runs for _ in range(n)]
    if most < 2**31 - 1 and kind == pa.string():
        assert all(c.nbytes - 4 * (len(c) + 1) <= most for c in got.chunks)
