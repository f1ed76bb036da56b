"""JSON that nobody should hand over: refused in one line, with the place."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from places import FIXTURES

from erdctl.core.errors import InputProblem
from erdctl.io.documents import encode
from erdctl.io.parameters import parse_parameters

TABLE_2 = json.loads((FIXTURES / "table_2.json").read_text())


def refused(data: bytes | dict[str, Any]) -> str:
    if isinstance(data, dict):
        data = json.dumps(data).encode()
    with pytest.raises(InputProblem) as caught:
        parse_parameters(data, "p.json")
    assert str(caught.value).startswith("p.json: ")
    return str(caught.value)


@pytest.mark.parametrize("data", [b"[" * 100_000, b'{"a":' * 100_000, b"[" * 2_000 + b"]" * 2_000])
def test_brackets_without_end(data: bytes) -> None:
    assert "brackets" in refused(data) or "schema" in refused(data)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('"schema":', '"schema": "erdctl.parameters/1", "schema":', "schema"),
        ('"k_nom":', '"k_nom": 1.0, "k_nom":', "k_nom"),
        ('"unit":', '"unit": "N/mm", "unit":', "unit"),
    ],
)
def test_a_field_that_is_there_twice(old: str, new: str, field: str) -> None:
    """A parser that takes the last would use one of two values, and say nothing."""
    said = refused(json.dumps(TABLE_2).replace(old, new, 1).encode())
    assert f'"{field}" is there twice' in said


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "9" * 5000])
def test_numbers_that_are_none(number: str) -> None:
    said = refused(json.dumps(TABLE_2).replace("263.1168", number, 1).encode())
    assert "not a JSON document" in said or "finite" in said


RANGES: list[Any] = ["abc", [1, 2], {"x": "abc"}, {"x": [1]}, {"x": [1, 2, 3]}, {"x": [1, "2"]},
                     {"x": None}, {"x": [None, 1]}, 5]  # fmt: skip


@pytest.mark.parametrize("ranges", RANGES, ids=str)
def test_ranges_that_are_none(ranges: Any) -> None:
    said = refused({**TABLE_2, "provenance": {"ranges": ranges}})
    assert "$.provenance.ranges" in said


def test_a_noise_that_is_none() -> None:
    assert "$.provenance.noise_rms" in refused({**TABLE_2, "provenance": {"noise_rms": "loud"}})


@pytest.mark.parametrize(
    "name", ["__init__", "__pycache__", "a.b", "../x", "", "x" * 10_000, "\x1b[2J", "back\x00lash"]
)
def test_effects_that_are_none(name: str) -> None:
    said = refused({**TABLE_2, "effects": [{"effect": name, "parameters": {}}]})
    assert "effects[0]: unknown effect" in said
    assert "\x1b" not in said
    assert len(said) < 2_000


@given(st.binary(max_size=200))
def test_any_bytes(data: bytes) -> None:
    refused(data)


json_values = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=8,
)


@given(st.sampled_from(sorted(TABLE_2)), json_values)
def test_any_value_in_any_field(field: str, value: Any) -> None:
    """Either it is a parameter file, or one line says what is wrong with it."""
    data = json.dumps({**TABLE_2, field: value}).encode()
    try:
        parse_parameters(data, "p.json")
    except InputProblem:
        refused(data)


def test_a_name_that_is_no_text_can_be_written(tmp_path: Path) -> None:
    """Names of files are bytes; JSON is text."""
    data = encode({"name": "a\udcff.csv", "list": ["\udcfe"]})
    assert msgspec.json.decode(data) == {"name": "a\\udcff.csv", "list": ["\\udcfe"]}
