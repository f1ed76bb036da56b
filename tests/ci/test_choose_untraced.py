"""The files whose tests run untraced."""

from __future__ import annotations

from choose_untraced import chosen
from places import ROOT


def test_as_few_as_reach_the_lines_are_traced() -> None:
    of = {
        "a": {("f", n) for n in range(10)},
        "b": {("f", n) for n in range(5, 25)},
        "c": {("f", n) for n in range(3, 8)},
        "d": {("g", 1)},
    }
    assert chosen(of, least=1) == ["b", "a", "d"]
    assert chosen(of, least=2) == ["b", "a"]
    assert chosen({}) == []


def test_those_that_are_listed_are_there() -> None:
    tests = ROOT / "tests"
    listed = (tests / "untraced.txt").read_text().split()
    assert len(listed) > 100
    assert [name for name in listed if not (tests / name).is_file()] == []
