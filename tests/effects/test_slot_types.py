"""A function whose signature does not fit its slot fails the type checker."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from places import ROOT


def test_wrong_signatures_are_found() -> None:
    pytest.importorskip("mypy")
    run = subprocess.run(
        [sys.executable, "-m", "mypy", "tests/effects/wrong_signatures.py"],
        capture_output=True, text=True, cwd=ROOT,
    )  # fmt: skip
    errors = [line for line in run.stdout.splitlines() if ": error:" in line]
    found = [re.search(r'"(\w+)" has incompatible type .* expected "(\w+)"', e) for e in errors]
    assert [m.groups() for m in found if m] == [
        ("ControlSlot", "SamplesFunction"),
        ("ScaleSlot", "ScaleFunction"),
        ("FieldSlot", "FieldFunction"),
        ("SeriesSlot", "NumberFunction"),
    ], run.stdout
