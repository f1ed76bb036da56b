"""Equations of the catalogue become MathML, and what cannot be read stays text."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from erdctl.effects import catalogue
from erdctl.model.paper import EQUATIONS
from erdctl.report.page.mathml import FUNCTIONS, GREEK, NAMESPACE, equation, flowing, symbol

ALL = {e.name: e.equation for e in catalogue()} | {
    f"paper-{i}": text for i, text in enumerate(EQUATIONS)
}


def tags(text: str) -> list[str]:
    root = ElementTree.fromstring(str(equation(text)))
    return [element.tag.removeprefix(f"{{{NAMESPACE}}}") for element in root.iter()]


def words(markup: str) -> str:
    root = ElementTree.fromstring(markup)
    return "".join(root.itertext()).replace("\u2061", "")


@pytest.mark.parametrize("name", ALL)
def test_every_equation_is_typeset_whole(name: str) -> None:
    text = ALL[name]
    markup = str(equation(text))
    assert markup.startswith("<math")
    shown = words(markup)
    for letter in set(re.findall(r"\d+(?:\.\d+)?|[A-Za-z]+", text)):
        expected = GREEK.get(letter, letter)
        if letter.endswith("dot"):
            expected = letter[:-3]
        for part in re.split(r"(?<=d)\d(?=[a-z])", expected):  # the order of a derivative
            assert part in shown or part.rstrip("0123456789") in shown, (letter, shown)


def test_check_values() -> None:
    assert tags("g/2") == ["math", "mfrac", "mi", "mn"]
    assert tags("v^beta") == ["math", "msup", "mi", "mi"]
    assert words(str(symbol("T_d"))) == "Td"
    assert tags("m d2x/dt2").count("msup") == 2
    assert "−γ" in words(str(equation("(1 - a x)^-gamma")))
    # A fraction's bar stands for the brackets that held its parts together.
    assert words(str(equation("(a + b) / (2 c)"))) == "a+b2c"
    assert tags("xdot")[1] == "mover"


@pytest.mark.parametrize("text", ["F = (x", "F = |x", "x / ", "F = §", "^2", "<script>&"])
def test_what_cannot_be_read_stays_text(text: str) -> None:
    markup = str(equation(text))
    assert markup.startswith('<code class="equation">')
    assert "<script" not in markup
    assert words(markup) == text


def test_a_derivative_by_travel() -> None:
    """dF_y/d|x| is one fraction, with a d and the bars below."""
    root = ElementTree.fromstring(str(equation("x_d dF_y/d|x| + F_y = F_ER sign(xdot)")))
    (fraction,) = root.iter(f"{{{NAMESPACE}}}mfrac")
    over, under = ("".join(part.itertext()) for part in fraction)
    assert over == "dFy"
    assert under == "d|x|"


@pytest.mark.parametrize("name", ALL)
def test_no_sign_of_the_notation_is_left(name: str) -> None:
    """Every stroke is a fraction's bar, every `_` an index, every `^` a power."""
    text = ALL[name]
    markup = str(equation(text))
    root = ElementTree.fromstring(markup)
    shown = [e for e in root.iter() if e.tag.endswith(("}mi", "}mo", "}mn"))]
    assert not [e.text for e in shown if re.search(r"[_^/]|dot", e.text or "")]
    strokes = len(re.findall(r"/", text.replace("m/s", "")))
    assert markup.count("<mfrac>") == strokes
    powers = text.count("^") + 2 * len(re.findall(r"d2\w+/d", text))
    assert markup.count("<msup>") == powers
    # A name of several letters is a function, a word or the name of a group, never a mistake.
    named = {e.text for e in shown if e.tag.endswith("}mi") and len(e.text or "") > 1}
    indices = {i for n in re.findall(r"[A-Za-z]+_(\w+)", text) for i in [n]}
    assert named <= FUNCTIONS | {"gas", "viscous", "yield"} | indices


@pytest.mark.parametrize("name", ALL)
def test_an_equation_in_pieces_is_the_same(name: str) -> None:
    whole = words(str(equation(ALL[name]))).replace("\u2002", "")
    pieces = words(f"<body>{flowing(ALL[name])}</body>").replace("\u2002", "")
    assert pieces.replace(" ", "") == whole.replace(" ", "")
