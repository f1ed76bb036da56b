"""Numbers, units and phrases as people read them, for every parameter of the catalogue."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.quantity import Quantity
from erdctl.effects import catalogue
from erdctl.io.units import factor_between
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.report.page.mathml import prose, symbol
from erdctl.report.readable import (
    AT_BOUND,
    SHOWN,
    estimate,
    headline,
    number,
    scaled,
    typeset,
    with_unit,
)

CATALOGUE = catalogue()
ALL = [*QUANTITIES.values(), *(q for e in CATALOGUE for q in e.quantities)]


@pytest.mark.parametrize("unit", [u for u in SHOWN if u != "degC"] + ["N"])
def test_the_shown_unit_is_the_same_size(unit: str) -> None:
    for size in (1e-6, 0.5, 20.0, 12_345.0, 1e9):
        factor, shown = scaled(unit, size)
        # So many shown units make one SI unit.
        assert factor_between(unit, shown, "test") == pytest.approx(factor)


@given(st.floats(-1e12, 1e12), st.sampled_from(sorted({q.unit for q in ALL})))
def test_a_value_can_be_read_back(value: float, unit: str) -> None:
    text = with_unit(value, unit, 6)
    factor, _ = scaled(unit, value)
    assert float(text.split()[0]) == pytest.approx(value * factor, rel=1e-5, abs=1e-300)


@given(st.floats(-9.99e5, 9.99e5))
def test_no_exponent_where_a_person_counts(value: float) -> None:
    text = number(value)
    assert "e+" not in text
    assert float(text) == pytest.approx(value, rel=1e-3)


def test_a_bound_in_place_of_an_error() -> None:
    q = Quantity(symbol="k", unit="N/m", title="", low=0.0, high=1e9, start=1.0)
    assert q.bound_at(4e-13, 77.0) == 0.0
    assert q.bound_at(0.0) == 0.0
    assert q.bound_at(1e9, 5.0) == 1e9
    assert q.bound_at(1.0, 77.0) is None
    text = estimate(0.0, "N/m", 77.0, at_bound=True)
    assert text == f"0 N/m ({AT_BOUND})"
    assert "77" not in text


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_every_effect_says_its_number(effect: Effect) -> None:
    named = re.findall(r"{(\w+)", effect.said)
    assert named, "said: a phrase with the main number"
    assert set(named) <= {q.symbol for q in effect.quantities}
    values = {q.symbol: 0.123 for q in effect.quantities}
    text = headline(effect, values)
    assert "123" in text or "12.3" in text
    assert "{" not in text
    unknown = headline(effect, dict.fromkeys(values))
    assert "unknown" in unknown


@pytest.mark.parametrize("q", ALL, ids=lambda q: f"{q.symbol}-{q.unit}")
def test_symbols_units_and_titles_are_typeset(q: Quantity) -> None:
    shown = re.sub(r"<[^>]*>", "", str(symbol(q.symbol)))
    assert "_" not in shown
    assert not re.search(r"[\^_*]", typeset(q.unit))
    title = re.sub(r"<[^>]*>", "", str(prose(q.title)))
    assert not re.search(r"[\^_]|xdot|\b(?:sigma|kappa|beta|gamma|tau)\b", title), title


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_titles_are_typeset(effect: Effect) -> None:
    title = re.sub(r"<[^>]*>", "", str(prose(effect.title)))
    assert not re.search(r"[\^_]|xdot", title), title


def test_words_stay_words() -> None:
    assert str(prose("the yield force of coulomb_friction in record a_b.csv")).count("<sub>") <= 1
    assert "coulomb_friction" in str(prose("as coulomb_friction does"))
    assert "<" not in str(prose("a <b> & c")).replace("&lt;", "").replace("&amp;", "")
