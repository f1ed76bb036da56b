"""One of a thing is said in the singular, and no sentence counts what it did not look at."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from places import FIXTURES
from rig import campaign
from typer.testing import CliRunner

from erdctl.bench.rig import look
from erdctl.cli.app import build
from erdctl.core.messages import counted

TABLE_2 = FIXTURES / "table_2.json"


def test_a_noun_follows_its_number() -> None:
    assert [counted(n, "more row") for n in (0, 1, 2)] == [
        "0 more rows",
        "1 more row",
        "2 more rows",
    ]


def said(*words: object) -> str:
    return str(CliRunner().invoke(build(), [*map(str, words)]).stderr)


def test_one_of_each(tmp_path: Path) -> None:
    t = np.delete(np.arange(600) * 1e-2, 300)  # one sample is lost
    w = 2 * np.pi * 0.7
    log = pd.DataFrame({"t": t, "x": 0.01 * np.sin(w * t), "xdot": 0.01 * w * np.cos(w * t)})
    path = tmp_path / "one.csv"
    log.assign(duty=0.2, force=300.0 * log.x + 70.0 * log.xdot).to_csv(path, index=False)
    inspected = said("inspect", path)
    assert "\n599 samples, 5.99 s in 1 record\n" in inspected
    assert "1 sample missing in 1 gap, the longest" in inspected
    validated = said("validate", TABLE_2, path, "--report", tmp_path / "page.html")
    shown = inspected + validated + (tmp_path / "page.html").read_text().split("<script")[0]
    assert re.findall(r"(?<![\d.])1 [a-z ]*(?:samples|records|gaps|levels|rows) ", shown) == []
    (tmp_path / "cut.csv").write_text("t,x\n0,1\n1\n")
    assert "1 cell where the header has 2 columns" in said("inspect", tmp_path / "cut.csv")


@pytest.mark.parametrize(("length", "part"), [(30, "0"), (None, "99.")])
def test_what_was_not_looked_at(length: int | None, part: str) -> None:
    r = campaign()
    starts = np.array([0, 30, 60]) if length else np.append(r.starts, len(r) + 30)
    rows = np.arange(starts[-1]) % len(r)
    short = r.take(rows, starts, [str(i) for i in range(len(starts) - 1)])
    lines = look(replace(short, t=np.arange(len(short)) * 5e-3)).lines()
    assert lines[-1].startswith(f"looked at {part}")
    assert lines[-1].endswith("and at no record of fewer than 40 samples")
    assert look(r).looked == 1.0
