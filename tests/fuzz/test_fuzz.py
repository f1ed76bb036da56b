"""Damaged and hostile input of every kind through every command: an error in words, or a result.

`pytest -m fuzz -n 0 -s --no-cov tests/fuzz` runs 10,000 cases and prints the table. One case again:
`python tests/fuzz/fuzz_harness.py SEED COUNT NUMBER` with `tests` on PYTHONPATH.
"""

from __future__ import annotations

import os
from collections import Counter
from itertools import islice
from pathlib import Path
from types import ModuleType

import fuzz_harness
import json_files
import pytest
import text_files
from fuzz_harness import Finding, Trial, Worker, attempt, run, table, trials

SHORT, LONG = 80, 10_000
SEED = 20_260
Outcome = tuple[dict[str, fuzz_harness.Row], list[Finding]]


@pytest.fixture(scope="module")
def short(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """What came of the part of the cases that every test run has."""
    return run(trials(SEED, SHORT), tmp_path_factory.mktemp("cases"), workers=2)


def check(seed: int, count: int, outcome: Outcome) -> None:
    rows, findings = outcome
    print(f"\nseed {seed}\n{table(rows)}")
    assert not findings, "\n".join(
        f"#{f.trial.number} of seed {seed}, {count}: {str(f)[:600]}" for f in findings
    )
    assert sum(row.cases for row in rows.values()) == count


def test_a_part_of_the_cases(short: Outcome) -> None:
    check(SEED, SHORT, short)


@pytest.mark.fuzz
def test_ten_thousand_cases(tmp_path: Path) -> None:
    seed = int(os.environ.get("FUZZ_SEED", "1"))
    check(seed, LONG, run(trials(seed, LONG), tmp_path, workers=2))


@pytest.mark.parametrize("maker", [text_files, json_files], ids=lambda m: m.__name__)
def test_a_seed_gives_the_same_cases_every_time(maker: ModuleType) -> None:
    first, second, other = ([*maker.cases(s, 40)] for s in (3, 3, 4))
    assert first == second
    assert first != other


def test_cases_are_neither_all_refused_nor_all_accepted(short: Outcome) -> None:
    """A generator whose every case is refused in the first line tests the first line."""
    rows, _ = short
    codes = sum((row.codes for row in rows.values()), Counter[int]())
    assert codes[0] > SHORT / 12
    assert codes[3] > SHORT / 12


SPOILED = {
    "traceback": "raise ValueError('x')",
    "crash": "os.kill(os.getpid(), 11)",
    "hang": "time.sleep(30)",
    "exit code": "return 1",
    "control bytes": "os.write(2, b'erdctl: error: case.csv \\x1b[2J\\n'); return 3",
    "loud": "os.write(2, b'x' * 100_000); return 0",
    "message": "os.write(2, b'erdctl: error: it went wrong\\n'); return 3",
    "half written": "os.write(1, b'half'); os.write(2, b'erdctl: error: case.csv: x\\n'); return 3",
    "left over": "open('.erdctl-12.tmp', 'w'); return 0",
    "memory": "bytearray(300 << 20); return 0",
    "input": "open('case.csv', 'w'); return 0",
    "nan": "os.write(1, b'{\"nrmse\": NaN}'); return 0",
}


@pytest.mark.parametrize("kind", SPOILED)
def test_the_harness_sees(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A command that does what must not be, in place of erdctl."""
    package = tmp_path / "fake" / "erdctl" / "cli"
    package.mkdir(parents=True)
    for folder in (package, package.parent):
        (folder / "__init__.py").write_text("")
    (package / "app.py").write_text(f"import os, time\ndef run(words):\n    {SPOILED[kind]}\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "fake"))
    monkeypatch.setattr(fuzz_harness, "HANG", 0.4 if kind == "hang" else 60.0)
    monkeypatch.setattr(fuzz_harness, "MEMORY", 200 << 20)
    (tmp_path / "place").mkdir()
    worker = Worker(tmp_path / "place")
    trial = Trial(0, "csv: sound", b"t,x\n", ".csv", "validate P {} --json")
    try:
        found: list[Finding] = attempt(worker, trial, fuzz_harness.Row())
    finally:
        worker.end()
    assert kind in {f.kind for f in found}


def test_every_generator_takes_its_turn() -> None:
    families = {t.family for t in islice(trials(5, 300), 100)}
    assert {"csv", "text", "parameters", "geometry"} <= families
