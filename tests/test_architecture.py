"""The rooms of the house: which way imports point, and what starting up may cost."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from places import FIXTURES, ROOT

from erdctl import effects

PACKAGE = ROOT / "erdctl"
FILES = sorted(PACKAGE.rglob("*.py"))

# Each room may import those on lower floors, and its own. Data and result types lie at the bottom.
FLOORS: tuple[tuple[str, ...], ...] = (
    ("errors", "quantity", "recording", "workers", "__init__"),
    ("kernels", "plant", "signals", "noise", "motion", "waveforms", "series", "recurrences"),
    ("paper", "effect", "drive", "faults", "geometry", "amplifier"),
    ("effects", "blocks", "strokes"),
    ("response",),
    ("model",),
    ("parameters", "excitation", "fit"),
    ("two_step", "score", "assess", "coverage"),
    ("identify", "simulate", "mimic", "diagnose", "inspect", "dyno", "misfit", "yield_points"),
    ("io", "report"),
    ("prove",),
    ("cli",),
    ("__main__",),
)
FLOOR_OF = {room: level for level, rooms in enumerate(FLOORS) for room in rooms}


def room(module: str) -> str:
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


def imported(path: Path) -> list[str]:
    out = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            whole = (PACKAGE.parent / Path(*node.module.split("."))).is_dir()
            out += [f"{node.module}.{a.name}" if whole else node.module for a in node.names]
        elif isinstance(node, ast.Import):
            out += [a.name for a in node.names]
    return out


def own(path: Path) -> list[str]:
    return [m for m in imported(path) if m.split(".")[0] == "erdctl"]


def name_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(p for p in parts if p != "__init__")


def test_every_room_has_a_floor() -> None:
    assert {room(name_of(p)) for p in FILES} == set(FLOOR_OF)


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_imports_point_down(path: Path) -> None:
    here = room(name_of(path))
    for module in own(path):
        there = room(module if module != "erdctl.__version__" else "erdctl")
        assert there == here or FLOOR_OF[there] < FLOOR_OF[here], f"{path.name} imports {module}"


@pytest.mark.parametrize("path", sorted((PACKAGE / "effects").glob("*.py")), ids=name_of)
def test_no_effect_imports_another(path: Path) -> None:
    if path.name != "__init__.py":
        assert not [m for m in own(path) if m.startswith("erdctl.effects")]


# The plant of the proof hides effects, and must name what it has hidden.
CATALOGUED = [p for p in FILES if p.relative_to(PACKAGE).parts[0] != "plant"]


@pytest.mark.parametrize("path", CATALOGUED, ids=name_of)
def test_no_effect_is_named_outside_its_file(path: Path) -> None:
    names = {p.stem for p in (PACKAGE / "effects").glob("*.py")} - {"__init__", path.stem}
    strings = {
        node.value
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    # The fault kinds are the contract's names of Eqs. 20-23, which mimic and simulate share.
    allowed = {"oil_leakage", "electrical_fault", "deformation_fault"}
    if path.stem != "faults":
        # An effect says which others force data can hardly tell from it.
        own = effects.get(path.stem) if path.stem in effects.names() else None
        allowed = {*own.equivalents, *own.beside} if own else set()
    assert not (strings & names) - allowed


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_files_hold_one_idea(path: Path) -> None:
    assert len(path.read_text().splitlines()) <= 320


def test_the_generator_of_fixtures_shares_no_code() -> None:
    for path in FIXTURES.glob("*.py"):
        assert not own(path), path


def loaded(code: str) -> set[str]:
    run = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport sys; print(*sys.modules)"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    return set(run.stdout.split())


def test_start_is_light() -> None:
    heavy = {"numpy", "scipy", "pandas", "pyarrow", "rich", "pint", "matplotlib", "pydantic"}
    assert not loaded("import erdctl.cli.app") & heavy


def test_simulate_and_validate_stay_light() -> None:
    code = (
        "import erdctl.simulate, erdctl.score, erdctl.io.parameters, erdctl.io.logs,"
        " erdctl.io.tables"
    )
    assert not loaded(code) & {"scipy", "pandas", "rich", "pint", "matplotlib", "pydantic"}
