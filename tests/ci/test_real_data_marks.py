"""Where the real recordings are at hand, a session in which their tests did not run fails."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

INI = """
[tool.pytest.ini_options]
testpaths = ["tests"]
addopts = "-q --strict-markers -m 'not benchmark'"
markers = ["benchmark: x"]
"""
PLAIN = "def test_plain():\n    pass\n"
RUNS = "import pytest\n\n@pytest.mark.real_data\ndef test_real():\n    pass\n"
SKIPS = RUNS.replace("    pass", "    pytest.skip('not at hand')")
LEFT_OUT = f"import pytest\npytest.importorskip('no_such_library')\n{RUNS}"
NOT_CALLED = RUNS.replace("def test_real", "def real")
NONE_RAN = "no test on real recordings ran of tests/test_real.py"


def session(
    folder: Path, test: str, *arguments: str, shared: bool = True
) -> subprocess.CompletedProcess[str]:
    """A session over a plain test and one file more, with the project's own conftest."""
    tests = folder / "work" / "tests"
    tests.mkdir(parents=True)
    for name in ("conftest.py", "places.py", "quick_approx.py", "real_data.py", "untraced.txt"):
        shutil.copyfile(ROOT / "tests" / name, tests / name)
    (tests / "test_plain.py").write_text(PLAIN)
    (tests / "test_real.py").write_text(test)
    (folder / "work" / "pyproject.toml").write_text(INI)
    if shared:
        (folder / "shared" / "data").mkdir(parents=True)
    own = {k: v for k, v in os.environ.items() if not k.startswith(("PYTEST", "COV_", "COVERAGE"))}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments],
        cwd=folder / "work", capture_output=True, text=True, env=own,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("test", "shared", "workers", "code", "message"),
    [
        pytest.param(RUNS, True, "0", 0, "1 ran, 0 skipped", id="runs"),
        pytest.param(RUNS, True, "2", 0, "1 ran, 0 skipped", id="runs-in-processes"),
        pytest.param(SKIPS, True, "0", 1, "skipped, but", id="skips"),
        pytest.param(SKIPS, True, "1", 1, "skipped, but", id="skips-in-processes"),
        pytest.param(LEFT_OUT, True, "1", 1, NONE_RAN, id="left-out-in-processes"),
        pytest.param(NOT_CALLED, True, "0", 1, NONE_RAN, id="not-called"),
        pytest.param(SKIPS, False, "0", 0, "0 ran, 1 skipped (no folder", id="no-folder"),
    ],
)
def test_a_full_session(
    test: str, shared: bool, workers: str, code: int, message: str, tmp_path: Path
) -> None:
    done = session(tmp_path, test, "-n", workers, shared=shared)
    assert done.returncode == code, done.stdout + done.stderr
    assert message in done.stdout


@pytest.mark.parametrize("choice", [["tests/test_plain.py"], ["-k", "plain"]])
def test_a_part_of_the_suite_need_not_hold_them(choice: list[str], tmp_path: Path) -> None:
    assert session(tmp_path, RUNS, *choice).returncode == 0


def test_a_skip_in_a_part_of_the_suite_counts(tmp_path: Path) -> None:
    assert session(tmp_path, SKIPS, "tests/test_real.py").returncode == 1


def test_no_tests_is_no_success(tmp_path: Path) -> None:
    assert session(tmp_path, RUNS, "-k", "no_such_test").returncode == 5


def test_every_file_that_reads_them_carries_the_mark() -> None:
    """`rig.real` and SHARED lead to the recordings."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        text = path.read_text()
        if path != Path(__file__) and ("real(" in text or "import FIXTURES, SHARED" in text):
            assert "mark.real_data" in text, path
