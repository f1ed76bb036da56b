"""Numbers that decide stand in one file, each with what it is, what it decides and its origin."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from places import ROOT

ROOM = ROOT / "erdctl" / "diagnose"
FILE = ROOM / "thresholds.py"
OTHERS = sorted(p for p in ROOM.rglob("*.py") if p != FILE)

# Numbers that decide nothing: they count, halve, square, or keep from dividing by zero.
PLAIN = {0, 1, 2, 3, 0.5, 1e-300}
# Scale of the median absolute value of a normal noise; floors; units and shares in words.
KNOWN = {1.4826, 100, 1000, 4, 0.2, 9}


def constants(path: Path) -> list[str]:
    """Names of the module-level constants of a file that hold numbers."""
    out = []
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.Assign) and _numbers(node.value):
            for target in node.targets:
                names = target.elts if isinstance(target, ast.Tuple) else [target]
                out += [n.id for n in names if isinstance(n, ast.Name)]
    return out


def _numbers(value: ast.expr) -> list[float]:
    return [
        n.value for n in ast.walk(value)
        if isinstance(n, ast.Constant) and isinstance(n.value, (int, float))
        and not isinstance(n.value, bool)
    ]  # fmt: skip


def test_every_threshold_says_its_origin() -> None:
    """A comment block stands above each; `Origin:` is the last thing that it says."""
    lines = FILE.read_text().splitlines()
    for number, line in enumerate(lines):
        if re.match(r"[A-Z][A-Z_, ]* = ", line):
            above = number - 1
            while re.match(r"[A-Z][A-Z_, ]* = ", lines[above]):
                above -= 1  # constants of one block
            block = []
            while lines[above].startswith("#"):
                block.append(lines[above])
                above -= 1
            assert block, f"line {number + 1}: {line} has no comment"
            text = "\n".join(reversed(block))
            assert "Origin:" in text or "the same" in text.lower(), text


@pytest.mark.parametrize("path", OTHERS, ids=lambda p: p.stem)
def test_no_other_file_has_numbers_that_decide(path: Path) -> None:
    tree = ast.parse(path.read_text())
    assert not [n for n in constants(path) if n.isupper() and n != "UNITS"], path
    compared = [
        number
        for node in ast.walk(tree)
        if isinstance(node, ast.Compare)
        for side in (node.left, *node.comparators)
        for number in _numbers(side)
    ]
    assert not set(compared) - PLAIN - KNOWN, (path, compared)


def test_every_threshold_is_used() -> None:
    used = " ".join(p.read_text() for p in OTHERS)
    assert [n for n in constants(FILE) if f"thresholds.{n}" not in used] == []
