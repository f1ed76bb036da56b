"""The proof is worth something only if the plant shares nothing with what it tests."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

ROOM = ROOT / "erdctl" / "plant"
FILES = sorted(ROOM.rglob("*.py"))
OTHERS = {"numpy", "scipy", "numba", "pyarrow"}


def modules(path: Path) -> list[str]:
    found = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "a relative import may leave the room unseen"
            found.append(node.module or "")
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            assert name not in {"__import__", "import_module", "exec", "eval"}, path
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOM)))
def test_the_plant_imports_nothing_of_erdctl(path: Path) -> None:
    for module in modules(path):
        top = module.split(".")[0]
        if top == "erdctl":
            assert module == "erdctl.plant" or module.startswith("erdctl.plant.")
        else:
            assert top in OTHERS or top in sys.stdlib_module_names, module


def test_importing_the_plant_loads_nothing_else_of_erdctl() -> None:
    run = subprocess.run(
        [sys.executable, "-c", "import erdctl.plant, sys; print(*sys.modules)"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    loaded = {m for m in run.stdout.split() if m.split(".")[0] == "erdctl"}
    assert {m for m in loaded if not m.startswith("erdctl.plant")} == {"erdctl"}


def test_the_fault_names_and_units_are_spelt_out_here() -> None:
    from erdctl.plant.hidden import CATALOGUE, OUTSIDE, UNITS

    assert len(CATALOGUE) == 28
    assert len(OUTSIDE) >= 8
    assert not set(CATALOGUE) & set(OUTSIDE)
    for effect in (*CATALOGUE.values(), *OUTSIDE.values()):
        assert effect.shows
        assert all(path.split(".")[1] in UNITS for path in effect.shows)
