"""The worked values in docstrings hold, and no effect comes without one, or without a source."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest
from doc_checks import docstrings, has_checks, wrong_checks, wrong_effect
from places import ROOT

from erdctl.effects import GROUP

PACKAGE = ROOT / "erdctl"


def name_of(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


FILES = {name_of(p): p for p in sorted(PACKAGE.rglob("*.py"))}
CHECKED = [name for name, path in FILES.items() if has_checks(path.read_text())]
# An effect of another package is held to the same, where one is installed.
OTHERS = sorted({e.module for e in entry_points(group=GROUP)} - {*FILES})
EFFECTS = [name for name in FILES if name.startswith(f"{GROUP}.")] + OTHERS


def text_of(name: str) -> str:
    spec = find_spec(name)
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).read_text()


@pytest.mark.parametrize("name", [*CHECKED, *OTHERS])
def test_worked_values_hold(name: str) -> None:
    found = wrong_checks(text_of(name), name, vars(import_module(name)))
    assert not found, "\n".join(found)


@pytest.mark.parametrize("name", EFFECTS)
def test_an_effect_has_equation_check_and_source(name: str) -> None:
    found = wrong_effect(text_of(name), name, import_module(name).EFFECT.source)
    assert not found, "\n".join(found)


def test_every_room_that_computes_is_checked() -> None:
    """So that a change of the parser does not pass by finding nothing."""
    rooms = {name.split(".")[1] for name in CHECKED}
    assert {"model", "effects", "score", "bench", "estimate", "diagnose", "plant"} <= rooms
    assert {name for name in FILES if name.startswith(f"{GROUP}.")} <= {*CHECKED}


# What somebody else might add: complete, and then with one thing missing or wrong.
STRANGER = '''"""Wear of a seal with the way that it has gone.

    F = F_w |xdot|^(1/2) sign(xdot)

xdot : (n,) piston speed [m/s];  F_w : [N s^(1/2)/m^(1/2)], off at 0
Valid for seals that have run in.
Check: F_w = 10, xdot = 0.04, -0.09 m/s gives 2, -3 N.
>>> (10.0 * seal_wear(signals([0.04, -0.09]), {})[0]).round(9).tolist()
[2.0, -3.0]

Source: A. Stranger, Wear of seals, Journal of Wear 7 (2031) 1-2.
"""

import numpy as np


def seal_wear(s, p):
    """(1, n) force for F_w = 1."""
    return np.array([np.sqrt(np.abs(s.xdot)) * s.sign])
'''
CITED = "Stranger, Journal of Wear 7 (2031) 1-2"


def found_in(text: str, cited: str = CITED) -> list[str]:
    module = ModuleType("seal_wear")
    exec(compile(text, "seal_wear.py", "exec"), vars(module))
    return [
        *wrong_checks(text, "seal_wear.py", vars(module)),
        *wrong_effect(text, "seal_wear.py", cited),
    ]


def test_an_effect_that_a_stranger_adds_is_run() -> None:
    assert found_in(STRANGER) == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Source: A. Stranger", "After A. Stranger", "no 'Source:'"),
        ("A. Stranger, Wear of seals, Journal of Wear 7 (2031)", "common knowledge", "no author"),
        (" (2031)", "", "no author and year"),
        (" (2031)", " (2013)", "differ in the year"),
        ("Check: ", "So: ", "no 'Check:'"),
        (">>> (10.0", "(10.0", "'Check:' without lines that run"),
        ("[2.0, -3.0]\n", "", "'Check:' without lines that run"),
        ("[2.0, -3.0]", "[2.0, 3.0]", "Expected:\n    [2.0, 3.0]\nGot:\n    [2.0, -3.0]"),
        ("np.sqrt(", "np.cbrt(", "Failed example"),
        ("seal_wear(signals", "seal_tear(signals", "NameError"),
        (">>> (10.0", ">>>(10.0", "lacks blank"),
        ("gives 2, -3 N", "gives 2, -4 N", "not in the words of 'Check:': 3"),
        ("    F = F_w", "F = F_w", "no equation"),
    ],
)
def test_an_effect_with_something_missing_or_wrong_is_refused(
    old: str, new: str, said: str
) -> None:
    assert STRANGER.count(old) == 1
    found = found_in(STRANGER.replace(old, new))
    assert len(found) == 1
    assert said in found[0]
    assert "seal_wear.py" in found[0]


def test_an_effect_must_declare_its_source() -> None:
    for cited in ("", "common knowledge, 2031", "Stranger, Journal of Wear"):
        assert "EFFECT.source names no author and year" in found_in(STRANGER, cited)[0]
    paper = "the ER damper paper, Eq. 3"
    own = STRANGER.partition("Source: ")[2].partition("\n")[0]
    assert found_in(STRANGER.replace(own, paper), paper) == []


def test_a_failure_names_file_and_line() -> None:
    found = found_in(STRANGER.replace("[2.0, -3.0]", "[2.0, -4.0]"))
    line = STRANGER.splitlines().index(next(x for x in STRANGER.splitlines() if ">>>" in x)) + 1
    assert f'File "seal_wear.py", line {line}, in module' in found[0]


def test_lines_before_the_check_are_not_its() -> None:
    text = '"""A sum.\n\n>>> 1 + 1\n2\n\nCheck: 2 and 3 give 5.\n"""\n'
    assert "'Check:' without lines that run" in wrong_checks(text, "sum.py", {})[0]


def test_docstrings_are_found_wherever_they_are() -> None:
    text = (
        '"""Module."""\nclass A:\n    """Class."""\n    @property\n    def b(self):\n'
        '        """Property."""\n        def c():\n            """Inner."""\n'
    )
    assert [d.text for d in docstrings(text)] == ["Module.", "Class.", "Property.", "Inner."]
