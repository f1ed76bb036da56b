"""The table of the paper in CONTRIBUTING: what it names exists, and all of the paper has a row."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from places import ROOT

PACKAGE, TESTS = ROOT / "erdctl", ROOT / "tests"


class Row(NamedTuple):
    """A row of the table, by its columns."""

    paper: str
    what: str
    where: str
    command: str
    test: str


def rows() -> list[Row]:
    text = (ROOT / "CONTRIBUTING.md").read_text()
    table = text.split("| paper | what | where |")[1].splitlines()[2:]
    lines = [line for line in table if line.startswith("|")]
    return [Row(*(cell.strip() for cell in line.strip("| ").split(" | "))) for line in lines]


ROWS = rows()


@cache
def defined(path: Path) -> dict[str, ast.AST]:
    """What a file defines: functions, classes and their members, and names that are assigned."""
    return members(ast.parse(path.read_text()))


def members(inside: ast.AST) -> dict[str, ast.AST]:
    out: dict[str, ast.AST] = {}
    for node in getattr(inside, "body", []):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            out[node.name] = node
        elif isinstance(node, ast.Assign):
            out |= {t.id: node for t in node.targets if isinstance(t, ast.Name)}
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            out[node.target.id] = node
    return out


def exists(name: str) -> bool:
    """Whether `room.module`, or what is in one, is there; no import, so that it costs nothing."""
    words = name.split(".")
    for k in range(len(words), 0, -1):
        path = PACKAGE.joinpath(*words[:k]).with_suffix(".py")
        if path.is_file():
            found = defined(path)
            for word in words[k:]:
                if word not in found:
                    return False
                found = members(found[word])
            return True
    return False


def test_the_table_has_a_row_for_all_of_the_paper() -> None:
    """Eqs. 1-35, Tables 1-3, Figs. 1-30."""
    found: dict[str, set[int]] = {"Eq": set(), "Table": set(), "Fig": set()}
    for row in ROWS:
        kind = re.match(r"Eq|Table|Fig", row.paper)
        assert kind, row.paper
        for low, high in re.findall(r"(\d+)(?:-(\d+))?", row.paper):
            found[kind[0]] |= set(range(int(low), int(high or low) + 1))
    assert found == {
        "Eq": set(range(1, 36)), "Table": set(range(1, 4)), "Fig": set(range(1, 31))
    }  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=lambda r: r.paper)
def test_what_it_names_exists(row: Row) -> None:
    places = re.findall(r"`([^`]+)`", row.where)
    assert places or "nothing to compute" in row.where
    for place in places:
        assert (ROOT / place).is_file() if "/" in place else exists(place), place


@pytest.mark.parametrize("row", ROWS, ids=lambda r: r.paper)
def test_the_tests_that_it_names_exist(row: Row) -> None:
    names = re.findall(r"`([^`]+)`", row.test)
    assert names
    path = TESTS
    for name in names:
        file, colons, test = name.rpartition("::")
        if colons:  # otherwise that of the name before
            path = TESTS / f"{file}.py"
        assert path.is_file(), name
        assert test.startswith("test_"), name
        assert test in defined(path), name


def test_a_name_that_is_gone_is_seen() -> None:
    assert exists("model.paper.yield_force")
    assert exists("model.composed.Model.force")
    assert not exists("model.paper.no_such_force")
    assert not exists("model.composed.Model.no_such_force")
    assert not exists("paper.yield_force")
