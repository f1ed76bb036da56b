"""Which files of tests run untraced: those that reach next to no line that others do not.

    : > tests/untraced.txt; pytest --cov-context=test
    PYTHONPATH=tests python tests/choose_untraced.py .coverage > tests/untraced.txt

The other way round: files stay traced by the greatest number of lines that none before reaches,
down to LEAST. What is new is traced until this is run again, by hand, when tests take too long.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Mapping, Set

from coverage import CoverageData
from places import ROOT

LEAST = 10  # lines; fewer are not worth the time, and the coverage printed is that much too low


def reached(data: CoverageData) -> dict[str, set[tuple[str, int]]]:
    """Lines (file, number) that each file of tests reaches, by its path in tests/."""
    out: dict[str, set[tuple[str, int]]] = defaultdict(set)
    for file in data.measured_files():
        for line, contexts in data.contexts_by_lineno(file).items():
            for context in contexts:
                out[context.partition("::")[0].removeprefix("tests/")].add((file, line))
    out.pop("", None)  # what is imported before the first test
    return out


def chosen(of: Mapping[str, Set[tuple[str, int]]], least: int = LEAST) -> list[str]:
    """Files that are traced, the one with most lines first."""
    left = set().union(*of.values())
    out: list[str] = []
    while True:
        best = max(sorted(of), key=lambda test: len(of[test] & left), default=None)
        if best is None or len(of[best] & left) < least:
            return out
        out.append(best)
        left -= of[best]


def main() -> None:
    data = CoverageData(sys.argv[1])
    data.read()
    traced = chosen(reached(data))
    tests = {p.relative_to(ROOT / "tests").as_posix() for p in (ROOT / "tests").rglob("test_*.py")}
    print("\n".join(sorted(tests - set(traced))))
    print(f"{len(traced)} of {len(tests)} files are traced", file=sys.stderr)


if __name__ == "__main__":
    main()
