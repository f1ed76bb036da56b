"""Which files of tests run untraced: those that reach few lines that others do not, for their time.

    : > tests/untraced.txt; pytest --cov-context=test --durations=0 --durations-min=0 > took.txt
    PYTHONPATH=tests python tests/choose_untraced.py .coverage took.txt > tests/untraced.txt

The other way round: files stay traced by the greatest number of lines in a second that none before
reaches, down to LEAST and SLOWEST. What is new is traced until this is run again, by hand, when
tests take too long.
"""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from collections.abc import Mapping, Set
from pathlib import Path

from coverage import CoverageData
from places import ROOT

LEAST = 10  # lines; fewer are not worth the time, and the coverage printed is that much too low
SLOWEST = 10.0  # lines a second
QUICK = 0.1  # s, within which times are the machine's affair
TOOK = re.compile(r"^([\d.]+)s (?:setup|call|teardown) +tests/(.+?)::", re.MULTILINE)


def reached(data: CoverageData) -> dict[str, set[tuple[str, int]]]:
    """Lines (file, number) that each file of tests reaches, by its path in tests/."""
    out: dict[str, set[tuple[str, int]]] = defaultdict(set)
    for file in data.measured_files():
        for line, contexts in data.contexts_by_lineno(file).items():
            for context in contexts:
                out[context.partition("::")[0].removeprefix("tests/")].add((file, line))
    out.pop("", None)  # what is imported before the first test
    return out


def seconds(printed: str) -> dict[str, float]:
    """How long each file takes, from what pytest prints of durations."""
    out: dict[str, float] = defaultdict(float)
    for took, file in TOOK.findall(printed):
        out[file] += float(took)
    return out


def chosen(of: Mapping[str, Set[tuple[str, int]]], took: Mapping[str, float]) -> list[str]:
    """Files that are traced, the one with most lines in a second first."""
    left = set().union(*of.values())
    out: list[str] = []

    def rate(test: str) -> float:
        return len(of[test] & left) / max(took.get(test, 0.0), QUICK)

    while True:
        worth = [t for t in sorted(of) if len(of[t] & left) >= LEAST and rate(t) >= SLOWEST]
        if not worth:
            return out
        out.append(max(worth, key=rate))
        left -= of[out[-1]]


def main() -> None:
    data = CoverageData(sys.argv[1])
    data.read()
    traced = chosen(reached(data), seconds(Path(sys.argv[2]).read_text()))
    tests = {p.relative_to(ROOT / "tests").as_posix() for p in (ROOT / "tests").rglob("test_*.py")}
    print("\n".join(sorted(tests - set(traced))))
    print(f"{len(traced)} of {len(tests)} files are traced", file=sys.stderr)


if __name__ == "__main__":
    main()
