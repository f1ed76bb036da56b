"""Campaigns run as a user does, in a process of their own, and what they wrote."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import fleet
import pyarrow as pa
import pyarrow.parquet as pq
from places import ROOT

DAMPERS, MONTHS = 4, 6
ENV = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}


class AtOnce(Executor):
    """Does a job in this process, when it is asked to: no worker has to be started."""

    def submit(self, fn: Any, /, *args: Any, **options: Any) -> Future[Any]:
        out: Future[Any] = Future()
        out.set_result(fn(*args, **options))
        return out


def words(where: Path, table: str, *more: str) -> list[str]:
    """The command for the logs in WHERE/lab; paths are relative, so that tables can be compared."""
    return [
        sys.executable, "-m", "erdctl", "campaign", "run", "lab", "-o", table,
        "--label", fleet.LABEL, *more,
    ]  # fmt: skip


def run(where: Path, table: str, *more: str, code: int = 0) -> str:
    """What a campaign says on stderr."""
    done = subprocess.run(
        words(where, table, *more), cwd=where, env=ENV, capture_output=True, text=True
    )
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    return done.stderr


def begun(where: Path, table: str, *more: str) -> subprocess.Popen[str]:
    """A campaign that is under way."""
    return subprocess.Popen(
        words(where, table, *more), cwd=where, env=ENV, stderr=subprocess.PIPE, text=True
    )


def entries(folder: Path) -> list[Path]:
    """Of the logs that are done, one file each."""
    return [p for p in folder.glob("??/*.json") if p.name.count(".") == 1]


def rows(table: Path) -> list[dict[str, Any]]:
    found: pa.Table = pq.read_table(table)
    return found.to_pylist()


def document(table: Path, row: dict[str, Any], command: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(
        (table.parent / dict(row["documents"])[command]).read_bytes()
    )
    return found
