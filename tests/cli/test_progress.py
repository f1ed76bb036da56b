"""What a user sees on a terminal while a diagnosis runs."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest
from places import FIXTURES

pty = pytest.importorskip("pty", reason="this system has no pseudo terminals")


def test_stage_effect_and_elapsed() -> None:
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "erdctl", "diagnose",
               str(FIXTURES / "healthy_noisy_motion.csv"), "-o", os.devnull,
               "--effects", "coulomb_friction,time_skew", "--jobs", "1"]  # fmt: skip
    env = {**os.environ, "TERM": "xterm", "COLUMNS": "100"}
    with subprocess.Popen(command, stderr=theirs, stdout=subprocess.DEVNULL, env=env) as run:
        os.close(theirs)
        shown = bytearray()
        while True:
            try:
                part = os.read(ours, 65536)
            except OSError:  # Linux says so when the other end is closed
                break
            if not part:
                break
            shown += part
    os.close(ours)
    assert run.returncode == 0
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown.decode())
    assert re.search(r"each effect: (coulomb_friction|time_skew).*0:00:\d\d", text), text
    assert "Verdict" in text
