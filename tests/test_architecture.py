"""The rooms of the house: which way imports point, file by file, and what starting up may cost."""

from __future__ import annotations

import ast
import subprocess
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from places import FIXTURES, ROOT

from erdctl.effects import get, names

PACKAGE = ROOT / "erdctl"
FILES = sorted(PACKAGE.rglob("*.py"))

# Each room may import those before it, and its own. `plant` may import none: see the plant's tests.
ROOMS = (
    "core", "model", "effects", "score", "bench", "estimate", "diagnose", "mimic", "compare",
    "plant", "io", "export", "report", "prove", "interface", "campaign", "cli",
)  # fmt: skip
FLAT = {"__init__", "__main__"}  # the package's face, and `python -m erdctl`
LONGEST = 320  # lines of a file
TABLE = {"erdctl.diagnose.thresholds"}  # of constants, each with its words: one place to look


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(p for p in parts if p != "__init__")


MODULES = {name_of(p): p for p in FILES}


def room(module: str) -> str:
    return module.split(".")[1] if "." in module else "__init__"


def imported(path: Path, *, at_run_time: bool = False) -> list[str]:
    """Modules that a file imports; `at_run_time` leaves out those that only types need."""
    tree = ast.parse(path.read_text())
    out: list[str] = []
    skipped = {
        inner
        for node in ast.walk(tree)
        if at_run_time and isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if node in skipped:
            continue
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                out.append(inner if inner in MODULES else str(node.module))
        elif isinstance(node, ast.Import):
            out += [a.name for a in node.names]
    return out


def own(path: Path, *, at_run_time: bool = False) -> list[str]:
    found = imported(path, at_run_time=at_run_time)
    return [m for m in found if m.split(".")[0] == "erdctl"]


def test_every_file_is_in_a_room() -> None:
    assert {room(m) for m in MODULES} == {*ROOMS, *FLAT}
    assert {p.stem for p in PACKAGE.glob("*.py")} == FLAT


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_imports_point_to_rooms_before(path: Path) -> None:
    here = room(name_of(path))
    if here in FLAT:
        return
    allowed = set(ROOMS[: ROOMS.index(here) + 1])
    for module in own(path):
        assert room(module) in allowed, f"{name_of(path)} imports {module}"


def test_no_circle_of_files() -> None:
    """Of the imports at run time; the face loads lazily what it shows, and is left out."""
    graph = {m: {*own(p, at_run_time=True)} - {m, "erdctl"} for m, p in MODULES.items()}
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as circle:
        pytest.fail(" -> ".join(circle.args[1]))


@pytest.mark.parametrize("path", sorted((PACKAGE / "effects").glob("*.py")), ids=name_of)
def test_no_effect_imports_another(path: Path) -> None:
    if path.name != "__init__.py":
        assert not [m for m in own(path) if m.startswith("erdctl.effects")]


# The plant of the proof hides effects, and must name what it has hidden.
CATALOGUED = [p for p in FILES if p.relative_to(PACKAGE).parts[0] != "plant"]


@pytest.mark.parametrize("path", CATALOGUED, ids=name_of)
def test_no_effect_is_named_outside_its_file(path: Path) -> None:
    known = {p.stem for p in (PACKAGE / "effects").glob("*.py")} - {"__init__", path.stem}
    strings = {
        node.value
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    # The fault kinds are the contract's names of Eqs. 20-23, which mimic and simulate share.
    allowed = {"oil_leakage", "electrical_fault", "deformation_fault"}
    # A rig check says before any fit what an effect of the same name says after one.
    if path.parent.name == "rig":
        allowed = {"velocity_noise"}
    elif path.stem != "faults":
        # An effect says which others force data can hardly tell from it, and which are part of it.
        effect = get(path.stem) if path.stem in names() else None
        allowed = {*effect.equivalents, *effect.companions, *effect.includes} if effect else set()
    assert not (strings & known) - allowed


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_files_hold_one_idea(path: Path) -> None:
    assert name_of(path) in TABLE or len(path.read_text().splitlines()) <= LONGEST


def test_one_class_has_one_name() -> None:
    """Of two classes with one name a reader takes the wrong one."""
    found: dict[str, str] = {}
    for path in FILES:
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef):
                assert node.name not in found, f"{node.name}: {path} and {found[node.name]}"
                found[node.name] = str(path)


def test_tests_mirror_the_rooms() -> None:
    known = {p.relative_to(PACKAGE) for p in PACKAGE.rglob("*") if p.is_dir()}
    besides = {Path(p) for p in ("benchmarks", "ci", "docs", "fixtures", "fuzz")}
    folders = {p.parent.relative_to(ROOT / "tests") for p in (ROOT / "tests").rglob("test_*.py")}
    assert folders - {Path(".")} - besides <= known
    assert {Path(r) for r in ROOMS} <= folders


def test_files_of_tests_have_names_of_their_own() -> None:
    """Without packages pytest imports them by name."""
    names = [p.name for p in (ROOT / "tests").rglob("*.py") if p.name != "conftest.py"]
    assert {n for n in names if names.count(n) > 1} == set()


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
    heavy |= {"dask", "distributed"}
    assert not loaded("import erdctl, erdctl.cli.app") & heavy


def test_simulate_and_validate_stay_light() -> None:
    code = (
        "import erdctl.model.simulate, erdctl.score.nrmse, erdctl.io.parameters, erdctl.io.logs,"
        " erdctl.io.tables"
    )
    assert not loaded(code) & {"scipy", "pandas", "rich", "pint", "matplotlib", "pydantic"}
