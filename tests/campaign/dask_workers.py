"""A Dask cluster of processes, as on several machines."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

from campaigns import ENV


class DaskWorkers:
    """A scheduler and its workers, each a process with nothing but the scheduler's file in common.

    file : of the scheduler;  workers : that may be killed
    """

    def __init__(self, folder: Path, count: int) -> None:
        self.file, self.folder = folder / "scheduler.json", folder
        self.scheduler = self._start("dask_scheduler", "--port", "0")
        end = time.monotonic() + 60.0
        while not self.file.exists():
            assert time.monotonic() < end, "the scheduler does not come up"
            time.sleep(0.05)
        self.workers = [
            self._start("dask_worker", "--nthreads", "1", "--no-nanny", "--local-directory",
                        str(folder))
            for _ in range(count)
        ]  # fmt: skip

    def _start(self, program: str, *words: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{program}", *words, "--no-dashboard",
             "--scheduler-file", str(self.file)],
            env=ENV, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd="/",
        )  # fmt: skip

    def end(self) -> None:
        """End all of them."""
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()
