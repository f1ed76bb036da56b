"""A sound log, to be spoilt in one place by each test."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from erdctl.io.logs import Log, read_logs

N = 200
Columns = dict[str, Any]


def sound() -> Columns:
    """Two records of 100 samples each."""
    t = np.tile(np.arange(N // 2) * 1e-3, 2)
    x = 0.01 * np.sin(40.0 * t)
    xdot = 0.4 * np.cos(40.0 * t)
    return {
        "t": t,
        "x": x,
        "xdot": xdot,
        "duty": np.repeat([0.1, 0.2], N // 2),
        "force": 100.0 * xdot,
        "record": np.repeat(["a", "b"], N // 2).tolist(),
    }


@pytest.fixture
def columns() -> Columns:
    return sound()


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., str]:
    """Write columns as a log of the given name; for CSV exactly as plain Python prints them."""

    def write(columns: Columns, name: str = "log.csv") -> str:
        path = tmp_path / name
        if path.suffix == ".csv":
            lines = [",".join(columns)]
            lines += [",".join(str(c) for c in row) for row in zip(*columns.values(), strict=True)]
            path.write_text("\n".join(lines) + "\n", newline="")
        else:
            import pyarrow.parquet as pq

            table = pa.table(columns)
            if path.suffix == ".parquet":
                pq.write_table(table, path)
            else:
                with (
                    pa.OSFile(str(path), "wb") as file,
                    pa.ipc.new_stream(file, table.schema) as writer,
                ):
                    writer.write_table(table)
        return str(path)

    return write


@pytest.fixture
def said() -> list[str]:
    """Lines that were reported."""
    return []


@pytest.fixture
def read(said: list[str]) -> Callable[..., Log]:
    def read(*paths: str, need_force: bool = True, **options: Any) -> Log:
        return read_logs(paths, need_force=need_force, report=said.append, **options)

    return read


@pytest.fixture
def stdin(monkeypatch: pytest.MonkeyPatch) -> Callable[[bytes], None]:
    """Put bytes on standard input."""

    def put(data: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    return put
