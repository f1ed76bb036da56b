"""CI runs the README's two set-up commands: it fails where it does not find exactly two."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from places import ROOT

README = ROOT / "README.md"
SCRIPT = ROOT / ".ci" / "readme_commands"
INSTALL, TEST = "pip install . && erdctl --help", "pip install '.[test]' && pytest"


def extract(readme: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["bash", str(SCRIPT), str(readme)], capture_output=True, text=True)


def doctored(folder: Path, fence: str, *commands: str) -> Path:
    path = folder / "README.md"
    rows = ["# x", "", fence, *commands, "```", "", "```sh", "erdctl effects", "```"]
    path.write_text("\n".join(rows) + "\n")
    return path


def test_the_readme_has_two_commands() -> None:
    done = extract(README)
    assert done.returncode == 0, done.stderr
    first, second = done.stdout.splitlines()
    assert first.startswith("pip install . && erdctl identify ")
    assert second == TEST


def test_a_good_readme(tmp_path: Path) -> None:
    done = extract(doctored(tmp_path, "```sh setup", INSTALL, "", TEST))
    assert done.stdout.splitlines() == [INSTALL, TEST]


@pytest.mark.parametrize(
    ("fence", "commands", "message"),
    [
        ("```sh install", [INSTALL, TEST], "exactly two commands are expected"),
        ("```sh", [INSTALL, TEST], "found 0"),
        ("```sh setup", [], "found 0"),
        ("```sh setup", [INSTALL], "found 1"),
        ("```sh setup", [INSTALL, TEST, "true"], "found 3"),
        ("```sh setup", ["true", "true"], "must install and run erdctl"),
        ("```sh setup", [TEST, INSTALL], "must install and run erdctl"),
    ],
)
def test_a_doctored_readme_is_refused(
    fence: str, commands: list[str], message: str, tmp_path: Path
) -> None:
    done = extract(doctored(tmp_path, fence, *commands))
    assert done.returncode == 1
    assert message in done.stderr
    assert done.stdout == ""


def test_ci_stops_where_the_commands_are_missing() -> None:
    """`set -e` sees the failure of an assignment, but not that of a substitution in an argument."""
    text = (ROOT / ".ci" / "run").read_text()
    assert "\nset -euo pipefail\n" in text
    assert "\ncommands=$(.ci/readme_commands README.md)\n" in text
