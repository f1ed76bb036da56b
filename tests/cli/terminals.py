"""Commands on a pseudo terminal."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pty = pytest.importorskip("pty", reason="this system has no pseudo terminals")


def on_terminal(*words: str, **env: str) -> str:
    """What a command shows on stderr if that is a terminal."""
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "erdctl", *words]
    world = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "FORCE_COLOR")}
    world |= {"TERM": "xterm-256color", "COLUMNS": "120"} | env
    with subprocess.Popen(command, stderr=theirs, stdout=subprocess.DEVNULL, env=world) as run:
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
    return shown.decode()
