"""The rooms of the house: which way imports point, file by file, and what starting up may cost."""

from __future__ import annotations

import ast
import subprocess
import sys
from functools import cache
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


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text())


def imported(path: Path, *, at_run_time: bool = False) -> list[str]:
    """Modules that a file imports; `at_run_time` leaves out those that only types need."""
    tree = parsed(path)
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


# Each rule is one test over all files: a test for each file takes a minute of each machine.
@pytest.mark.parametrize("here", ROOMS)
def test_imports_point_to_rooms_before(here: str) -> None:
    allowed = set(ROOMS[: ROOMS.index(here) + 1])
    inside = {m: p for m, p in MODULES.items() if room(m) == here}
    wrong = [
        f"{m} imports {o}" for m, p in inside.items() for o in own(p) if room(o) not in allowed
    ]
    assert wrong == []


def test_no_circle_of_files() -> None:
    """Of the imports at run time; the face loads lazily what it shows, and is left out."""
    graph = {m: {*own(p, at_run_time=True)} - {m, "erdctl"} for m, p in MODULES.items()}
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as circle:
        pytest.fail(" -> ".join(circle.args[1]))


EFFECTS = sorted((PACKAGE / "effects").glob("[!_]*.py"))


def test_no_effect_imports_another() -> None:
    found = {p.stem: [m for m in own(p) if m.startswith("erdctl.effects")] for p in EFFECTS}
    assert {name: others for name, others in found.items() if others} == {}


def test_no_effect_is_named_outside_its_file() -> None:
    # The plant of the proof hides effects, and must name what it has hidden.
    inside = {m: p for m, p in MODULES.items() if room(m) != "plant"}
    found = {m: effects_named_in(p) for m, p in inside.items()}
    assert {m: named for m, named in found.items() if named} == {}


def effects_named_in(path: Path) -> set[str]:
    """Those of the catalogue that a file has no reason to name."""
    known = {p.stem for p in EFFECTS} - {path.stem}
    strings = {
        node.value
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    # The fault kinds are the contract's names of Eqs. 20-23, which mimic and simulate share.
    allowed = {"oil_leakage", "electrical_fault", "deformation_fault"}
    # A rig check says before any fit what an effect of the same name says after one.
    if path.parent.name == "rig":
        allowed = {"velocity_noise"}
    elif path.stem != "faults":
        # An effect says which others force data can hardly tell from it, and which are part of it,
        # and which have the name before it.
        effect = get(path.stem) if path.stem in names() else None
        allowed = set()
        if effect:
            allowed = {*effect.equivalents, *effect.companions, *effect.includes}
            allowed |= {*effect.richer_than, *effect.gives_way_to}
    return (strings & known) - allowed


def test_files_hold_one_idea() -> None:
    lines = {m: len(p.read_text().splitlines()) for m, p in MODULES.items() if m not in TABLE}
    assert {m: n for m, n in lines.items() if n > LONGEST} == {}


def test_one_class_has_one_name() -> None:
    """Of two classes with one name a reader takes the wrong one."""
    found: dict[str, str] = {}
    for path in FILES:
        for node in parsed(path).body:
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


def test_commands_on_parquet_load_no_compute_functions(tmp_path: Path) -> None:
    """To import them takes longer than all of pyarrow; 60,000 rows in 24 records need none."""
    log, fitted = str(FIXTURES / "healthy_campaign.parquet"), str(tmp_path / "damper.json")
    force = str(tmp_path / "force.parquet")
    for words in (
        ["identify", log, "-o", fitted],
        ["simulate", fitted, log, "-o", force],
        ["validate", fitted, force],
        ["inspect", log],
    ):
        found = loaded(f"from erdctl.cli.app import run\nassert not run({words})")
        assert "pyarrow.parquet" in found
        assert "pyarrow.compute" not in found, words
