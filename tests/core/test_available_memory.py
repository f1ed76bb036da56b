"""What the system says of free memory."""

from __future__ import annotations

from pathlib import Path

import pytest

from erdctl.core import memory


def test_available_is_plausible() -> None:
    found = memory.available()
    assert found is None or 10**7 < found < 10**14


def test_memory_limits_of_containers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = {
        "/proc/self/cgroup": ["0::/job"],
        f"{tmp_path}/job/memory.max": ["1000000"],
        f"{tmp_path}/job/memory.current": ["900000"],
        f"{tmp_path}/job/memory.stat": ["anon 5", "inactive_file 300000"],
    }
    monkeypatch.setattr(memory, "_CGROUP", str(tmp_path))
    monkeypatch.setattr(memory, "_lines", lambda path: files.get(path, []))
    assert memory._of_the_container() == 400_000
    files[f"{tmp_path}/job/memory.max"] = ["max"]
    assert memory._of_the_container() is None
