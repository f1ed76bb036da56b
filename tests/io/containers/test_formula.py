"""Formulas of conversions: arithmetic is evaluated, everything else is refused at once."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.io.containers.formula import FUNCTIONS, WrongFormula, evaluated

X = np.array([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("X1", X),
        ("x", X),
        ("2*X1+1", 2.0 * X + 1.0),
        ("-(X1 - 3) / 2", -(X - 3.0) / 2.0),
        ("1E-3*X1", 1e-3 * X),
        ("Exp(X1)", np.exp(X)),
        ("pow(X1, 2) + sqrt(X1)", X**2 + np.sqrt(X)),
        ("X1**2", X**2),
        ("7", [7.0, 7.0, 7.0]),
        ("LOG10(X1)*pi\0", np.log10(X) * math.pi),
    ],
)
def test_arithmetic(formula: str, expected: object) -> None:
    assert np.allclose(evaluated(formula, X), expected, rtol=1e-15)


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        ("", "empty"),
        ("X1^2", "power to some tools"),
        ("X1 % 2", "sign differs"),
        ("log(X1)", "natural to some"),
        ("X2", "not the stored value"),
        ("__import__('os').system('true')", "more than arithmetic"),
        ("abs(X1, 2)", "unknown"),
        ("open(X1)", "unknown"),
        ("X1 if X1 else 2", "more than arithmetic"),
        ("[X1 for X1 in X1]", "more than arithmetic"),
        ("X1; X1", "no formula"),
        ("'a'*X1", "no number"),
        ("1j*X1", "no number"),
        ("True", "not the stored value"),
        ("(" * 3000 + "X1" + ")" * 3000, "characters"),
        ("(" * 60 + "X1" + ")" * 60, "brackets"),
        ("-" * 990 + "X1", "nests"),
        ("X1" + "+X1" * 30_000, "characters"),
        ("X1*9**9**9**9**9", "no number for the stored value 1"),
        ("1/(X1-2)", r"stored value 2 \(row 2\)"),
        ("sqrt(1.5-X1)", r"stored value 2 \(row 2\)"),
    ],
)
def test_anything_else_is_refused_at_once(formula: str, why: str) -> None:
    begin = time.perf_counter()
    with pytest.raises(WrongFormula, match=why):
        evaluated(formula, X)
    assert time.perf_counter() - begin < 1.0


_NUMBERS = st.floats(-1e3, 1e3).map(lambda v: f"{v:.6g}")
_TREES = st.recursive(
    _NUMBERS | st.just("X1"),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda p: f"({p[0]}{p[1]}{p[2]})"),
        st.tuples(st.sampled_from(["sin", "cos", "exp", "atan", "tanh"]), inner).map(
            lambda p: f"{p[0]}({p[1]})"
        ),
        inner.map(lambda i: f"-{i}" if not i.startswith("-") else i),
    ),
    max_leaves=12,
)


@given(_TREES, st.floats(-100.0, 100.0))
def test_as_python_computes(formula: str, value: float) -> None:
    names = {"X1": value, **{n: getattr(math, n, None) for n in FUNCTIONS}}
    try:
        expected = eval(formula, {"__builtins__": {}}, names)
    except (ArithmeticError, ValueError):
        expected = math.nan  # unless something takes the infinite in: exp(-1/0) is 0
    try:
        found = evaluated(formula, np.array([value]))[0]
    except WrongFormula:
        assert not math.isfinite(expected) or len(formula) > 1000
        return
    assert math.isfinite(found)
    assert math.isnan(expected) or found == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(st.text(max_size=60))
def test_no_text_ends_in_another_error(text: str) -> None:
    try:
        found = evaluated(text, X)
    except WrongFormula as error:
        said = str(error)
        found = X
    else:
        said = ""
    assert "\n" not in said
    assert np.isfinite(found).all()
