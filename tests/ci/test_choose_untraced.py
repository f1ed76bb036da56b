"""The files whose tests run untraced."""

from __future__ import annotations

from choose_untraced import chosen, seconds
from places import ROOT


def lines(file: str, *numbers: int) -> set[tuple[str, int]]:
    return {(file, n) for n in numbers}


def test_what_reaches_most_lines_in_a_second_is_traced() -> None:
    of = {
        "a": lines("f", *range(20)),
        "b": lines("f", *range(10, 50)),
        "same as b": lines("f", *range(10, 50)),
        "few": lines("g", *range(9)),
        "ten": lines("h", *range(10)),
    }
    assert chosen(of, {"same as b": 0.2}) == ["b", "a", "ten"]
    assert chosen(of, {"b": 0.2}) == ["same as b", "a", "ten"]
    slow = {"b": 3.9, "same as b": 4.1, "ten": 1.1}
    assert chosen(of, slow) == ["a"]  # 30 lines that are left of b, in 3.9 s
    assert chosen(of, slow | {"b": 2.9}) == ["a", "b"]
    assert chosen({}, {}) == []


def test_how_long_a_file_takes_is_read_from_what_pytest_prints() -> None:
    printed = """
12.50s call     tests/docs/test_docs.py::test_the_tutorial
0.25s setup    tests/docs/test_docs.py::test_b[x-1.0s call     tests/a.py::b]
1.00s call     tests/test_c.py::test_c
1 failed, 3 passed in 14.25s (0:00:14)
"""
    assert seconds(printed) == {"docs/test_docs.py": 12.75, "test_c.py": 1.0}


def test_those_that_are_listed_are_there() -> None:
    tests = ROOT / "tests"
    listed = (tests / "untraced.txt").read_text().split()
    assert len(listed) > 100
    assert [name for name in listed if not (tests / name).is_file()] == []
