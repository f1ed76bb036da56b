"""Tests on real recordings may be skipped where the recordings are missing, and nowhere else.

The recordings do not come with the project; they lie in `../shared/data`. Tests that read them have
the mark `real_data`. Where the folder is there, a session fails if such a test was skipped, and a
full session fails if none ran of a file that holds some. Reports of all processes arrive at the
first one, so this holds under xdist, too.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

MARK = "real_data"


class RealData:
    """Counts tests on real recordings, and fails the session where one that could run did not."""

    def __init__(self, config: pytest.Config, tests: Path, shared: Path) -> None:
        self.config = config
        self.tests = tests
        self.shared = shared
        self.ran: list[str] = []
        self.skipped: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if MARK not in report.keywords:
            return
        if report.skipped:
            self.skipped.append(report.nodeid)
        elif report.when == "call":
            self.ran.append(report.nodeid)

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if self.problems() and session.exitstatus in (
            pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED
        ):  # fmt: skip
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if self.ran or self.skipped or self.full():
            terminalreporter.write_line(
                f"tests on real recordings: {len(self.ran)} ran, {len(self.skipped)} skipped"
                + ("" if self.shared.is_dir() else f" (no folder {self.shared})")
            )
        for problem in self.problems():
            terminalreporter.write_line(f"ERROR {problem}", red=True)

    def problems(self) -> list[str]:
        """Why this session must not pass."""
        if not self.shared.is_dir() or self.config.option.collectonly:
            return []
        found = [f"skipped, but {self.shared} is there: {name}" for name in self.skipped]
        if self.full():
            ran = {name.split("::")[0] for name in self.ran}
            found += [
                f"{self.shared} is there, but no test on real recordings ran of {file}"
                for file in sorted(self.files() - ran)
            ]
        return found

    def full(self) -> bool:
        """Whether the whole suite was asked for: no paths, and no choice but the project's own."""
        option = self.config.option
        defaults = list(self.config.getini("addopts"))
        own = defaults[defaults.index("-m") + 1] if "-m" in defaults else ""
        return (
            self.config.args_source is pytest.Config.ArgsSource.TESTPATHS
            and not option.keyword
            and option.markexpr == own
            and not getattr(option, "lf", False)
            and not option.deselect
            and not option.collectonly
        )

    def files(self) -> set[str]:
        """Files that hold marked tests, as node ids name them."""
        root = self.config.rootpath
        return {
            path.relative_to(root).as_posix()
            for path in self.tests.rglob("test_*.py")
            if _marks(path)
        }


def _marks(path: Path) -> bool:
    """Whether a file uses the mark, other than in a text."""
    nodes = ast.walk(ast.parse(path.read_text()))
    return any(
        isinstance(n, ast.Attribute) and n.attr == MARK and ast.unparse(n.value).endswith("mark")
        for n in nodes
    )
