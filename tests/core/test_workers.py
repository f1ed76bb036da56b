"""Worker processes end with the command that they work for, however it ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

PARENT = """
import os, time
from erdctl.core.workers import pool
if __name__ == "__main__":
    print(pool(1).submit(os.getpid).result(), flush=True)
    time.sleep(600)
"""


def test_a_killed_command_leaves_no_workers() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    worker = int(parent.stdout.readline())
    os.kill(worker, 0)  # it is there
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    for _ in range(600):
        if not _alive(worker):
            return
        time.sleep(0.1)
    raise AssertionError("the worker outlives its command")


def _alive(pid: int) -> bool:
    """Whether a process runs; one that ended and that nobody has buried does not."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False
