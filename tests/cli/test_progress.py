"""What a user sees on a terminal while a diagnosis runs."""

from __future__ import annotations

import os
import re
from pathlib import Path

from places import FIXTURES
from terminals import on_terminal


def test_stage_effect_and_elapsed() -> None:
    shown = on_terminal(
        "diagnose", str(FIXTURES / "healthy_noisy_motion.csv"), "-o", os.devnull,
        "--effects", "coulomb_friction,time_skew", "--jobs", "1",
    )  # fmt: skip
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown)
    fraction = r"[12] of 2 \((0|50) %\)"
    line = rf"each effect: (coulomb_friction|time_skew), {fraction}.*0:00:\d\d"
    assert re.search(line, text), text
    assert "Verdict" in text


def test_how_many_logs_are_done_and_the_time_left(tmp_path: Path) -> None:
    logs = [str(FIXTURES / name) for name in ("worn_joint.parquet", "stuck_separator.parquet")]
    shown = on_terminal(
        "campaign", "run", *logs, "-o", str(tmp_path / "r.parquet"), "--steps", "inspect",
        "--jobs", "1",
    )  # fmt: skip
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown)
    line = r"campaign: \S+\.parquet [━╸╺ ]+ [12]/2 0:00:\d\d left (-:--|0:00):\S\S"
    assert re.search(line, text), text
    assert "2 done now, 0 before" in text
