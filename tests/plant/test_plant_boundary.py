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
            assert name not in {"__import__", "exec", "eval"}, path
            if name == "import_module":
                # Twins are found by their file names: those beside the file that looks, no others.
                assert path == ROOM / "twins" / "__init__.py"
                assert ast.unparse(node.args[0]).startswith("f'{__name__}.")
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOM)))
def test_the_plant_imports_nothing_of_erdctl(path: Path) -> None:
    for module in modules(path):
        top = module.split(".")[0]
        if top == "erdctl":
            assert module == "erdctl.plant" or module.startswith("erdctl.plant.")
        else:
            assert top in OTHERS or top in sys.stdlib_module_names, module


@pytest.mark.parametrize(
    "code",
    [
        "import erdctl.plant",
        "from erdctl.plant import twins; [twins.get(n) for n in twins.FIRST]",
        "from erdctl.plant.twins import power_law_yield, preyield_elasticity, force_smoothing",
    ],
)
def test_the_plant_loads_nothing_else_of_erdctl(code: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", f"{code}; import sys; print(*sys.modules)"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    loaded = {m for m in run.stdout.split() if m.split(".")[0] == "erdctl"}
    assert {m for m in loaded if not m.startswith("erdctl.plant")} == {"erdctl"}
