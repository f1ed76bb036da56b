"""A terminal gets tables, bars and progress; everything else plain text, or nothing if quiet."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from places import FIXTURES
from terminals import on_terminal

LOG, TABLE_2 = str(FIXTURES / "healthy_noisy_motion.csv"), str(FIXTURES / "table_2.json")
COLOUR = re.compile(r"\x1b\[[0-9;]*(?:3[0-7]|38;|9[0-7])[0-9;]*m")


def piped(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "erdctl", *words], capture_output=True, text=True, check=True
    )


def test_bars_grow_with_the_error() -> None:
    text = on_terminal("validate", TABLE_2, LOG)
    assert COLOUR.search(text)
    rows = re.findall(r"│\s+\d+ %\s+│.*", re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text))
    cells = [[cell.strip() for cell in row.strip("│\r ").split("│")] for row in rows]
    drawn = {float(c[3]): len(c[4]) for c in cells}
    assert len(drawn) >= 3
    assert max(drawn.values()) >= 15
    assert sorted(drawn.values()) == [drawn[v] for v in sorted(drawn)]


def test_no_color_takes_the_colour_and_leaves_the_bars() -> None:
    text = on_terminal("validate", TABLE_2, LOG, NO_COLOR="1")
    assert not COLOUR.search(text)
    assert "█" in text


def test_a_dumb_terminal_and_a_pipe_get_the_same_plain_text() -> None:
    dumb = on_terminal("validate", TABLE_2, LOG, TERM="dumb").replace("\r\n", "\n")
    assert dumb == piped("validate", TABLE_2, LOG).stderr
    assert "\x1b" not in dumb
    assert "█" not in dumb


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("words", "stages"),
    [
        (["identify", LOG], ["reading", "fitting: all parameters, start 2, 3 of 5 (40 %)"]),
        (["validate", TABLE_2, LOG], ["1 of 1 (0 %)", "simulating: 8000 samples, 1 of 1 (0 %)"]),
        (["inspect", LOG], ["reading", "inspecting: 8000 samples, 1 of 1 (0 %)"]),
        (["simulate", TABLE_2, LOG], ["reading", "simulating"]),
        (["mimic", TABLE_2, str(FIXTURES / "schedule_60s.csv"), "--fault", "oil=0.5"],
         ["reading", "computing: the sequence of fl, 1 of 1 (0 %)"]),
    ],
    ids=lambda v: v[0],
)  # fmt: skip
def test_progress(words: list[str], stages: list[str]) -> None:
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", on_terminal(*words))
    for stage in stages:
        assert stage in text


def test_quiet_leaves_data_and_takes_the_rest() -> None:
    loud, quiet = piped("identify", LOG), piped("identify", LOG, "--quiet")
    assert loud.stderr
    assert quiet.stderr == ""
    assert quiet.stdout == loud.stdout
    assert on_terminal("identify", LOG, "-q") == ""


def test_quiet_keeps_warnings_and_errors(tmp_path: Path) -> None:
    hot = str(FIXTURES / "schedule_hot.csv")
    run = piped("mimic", TABLE_2, hot, "--fault", "oil=0.5", "--force", "--quiet",
                "-o", str(tmp_path / "pwm.csv"))  # fmt: skip
    assert run.stderr.splitlines() == [row for row in run.stderr.splitlines() if "warning" in row]
    assert "above the limit" in run.stderr
    command = [sys.executable, "-m", "erdctl", "inspect", "-q", "no-such.csv"]
    bad = subprocess.run(command, capture_output=True, text=True)
    assert bad.returncode == 2
    assert bad.stderr.startswith("erdctl: error:")


def completed(words: str) -> set[str]:
    """What a shell offers behind these words, by the protocol that bash and Typer speak."""
    env = {**os.environ, "_ERDCTL_COMPLETE": "complete_bash", "COMP_WORDS": f"erdctl {words}",
           "COMP_CWORD": str(len(words.split()) + words.endswith(" "))}  # fmt: skip
    run = subprocess.run([sys.executable, "-m", "erdctl"], capture_output=True, text=True, env=env)
    assert run.stderr == ""
    return set(run.stdout.split())


@pytest.mark.few(8)
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("ins", "inspect"),
        ("inspect --js", "--json"),
        ("effects back", "backlash"),
        ("diagnose a.csv --effects back", "backlash"),
        ("diagnose a.csv --effects backlash,mount", "backlash,mount_compliance"),
        ("diagnose a.csv --exclude thermal", "thermal_fade"),
        ("prove --effects cav", "cavitation"),
        ("plot a.csv --kind sl", "slow"),
        ("plot a.csv --kind before", "before-after"),
        ("validate p.json a.csv --plot mis", "misfit:"),
        ("simulate p.json a.csv --fault el", "electrical="),
        ("schema diag", "diagnosis"),
        ("schema pro", "proof"),
    ],
)
def test_shell_completion(words: str, expected: str) -> None:
    assert completed(words) == {expected} or expected in completed(words)
    start = words.split()[-1]
    assert all(w.startswith(start) for w in completed(words))


@pytest.mark.parametrize("words", ["effects ", "schema ", "plot a.csv --kind "])
def test_shell_completion_of_all(words: str) -> None:
    from erdctl.effects import names
    from erdctl.io.shapes import SCHEMAS
    from erdctl.report import pictures

    known = {
        "effects": {*names()},
        "schema": {*SCHEMAS, "proof", "proof-on"},
        "plot": {*pictures.names()},
    }
    assert completed(words) == known[words.split()[0]]
