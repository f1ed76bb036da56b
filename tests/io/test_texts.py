"""How much text a dictionary-encoded column opens to."""

import pyarrow as pa
import pyarrow.compute as pc
import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.errors import InputProblem
from erdctl.io.texts import _lengths, check_texts

KINDS = [pa.string(), pa.large_string(), pa.binary(), pa.large_binary()]


@given(
    st.lists(st.none() | st.text(max_size=5)), st.sampled_from(KINDS), st.integers(0, 9),
    st.integers(0, 9),
)  # fmt: skip
def test_lengths_are_those_that_arrow_counts(
    texts: list[str | None], kind: pa.DataType, skip: int, take: int
) -> None:
    stored = pa.array([None if t is None else t.encode() for t in texts], pa.binary()).cast(kind)
    part = stored.slice(skip, take)
    assert _lengths(part).tolist() == pc.fill_null(pc.binary_length(part), 0).to_pylist()


def test_lengths_of_views() -> None:
    assert _lengths(pa.array(["ü", None, "abc"], pa.string_view())).tolist() == [2, 0, 3]


@pytest.mark.parametrize("kind", [pa.string(), pa.large_string()])
def test_what_a_dictionary_opens_to(kind: pa.DataType) -> None:
    long, short = "x" * (1 << 20), "y"
    dictionary = pa.array([long, short], kind)

    def column(indices: list[int | None]) -> pa.Table:
        coded = pa.DictionaryArray.from_arrays(pa.array(indices, pa.int32()), dictionary)
        return pa.table({"record": coded})

    # All as long as the longest would be too much; what they are is not.
    check_texts(column([0, None] + [1] * 100_000), 1 << 21, "log.parquet")
    with pytest.raises(InputProblem, match="record") as caught:
        check_texts(column([None] + [0] * 100_000), 1 << 21, "log.parquet")
    assert caught.value.file == "log.parquet"
