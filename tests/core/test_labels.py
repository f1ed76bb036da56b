"""Date, damper and operator: what they may be."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.errors import UsageProblem
from erdctl.core.labels import LONGEST, labels_of


def test_what_is_given_is_there() -> None:
    assert labels_of(None, None, None) == {}
    found = labels_of("2024-05-01T14:30", " FL  3 ", "Dr. Ü. Tester")
    assert found == {"date": "2024-05-01T14:30", "damper": "FL 3", "operator": "Dr. Ü. Tester"}


@pytest.mark.parametrize("date", ["1.5.2024", "2024-13-01", "yesterday", "", "05/01/24"])
def test_no_date(date: str) -> None:
    with pytest.raises(UsageProblem, match="date: expected"):
        labels_of(date, None, None)


@pytest.mark.parametrize("text", ["", "  ", "a\x1b[31mb", "x" * (LONGEST + 1), "a\x00b"])
def test_no_words(text: str) -> None:
    with pytest.raises(UsageProblem, match="damper: expected 1 to 200 printable"):
        labels_of(None, text, None)


@given(st.text(max_size=300))
def test_what_passes_can_be_printed(text: str) -> None:
    try:
        found = labels_of(None, None, text)
    except UsageProblem as error:
        found = {"operator": str(error)}
    assert found["operator"].isprintable()
    assert found["operator"] == found["operator"].strip() != ""
