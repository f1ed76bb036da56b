"""Files of kilobytes that claim gigabytes: each refused, or read, within 2 GiB and a minute."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from binary_files import BOMBS, bomb, cases

PROGRAM = """
import os, resource, sys
from erdctl.core.errors import ErdctlError
from erdctl.io.containers.isolated import _reader
from erdctl.io.convert import read_converted
from erdctl.io.tables import write_table
code = 0
try:
    write_table(read_converted(sys.argv[1], say=lambda line: None), sys.argv[2])
except ErdctlError as error:
    print(error)
    code = int(error.exit_code)
_reader(os.getpid()).stop()
print(max(resource.getrusage(who).ru_maxrss
          for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))
sys.exit(code)
"""


@pytest.mark.few(6)
@pytest.mark.parametrize("name", BOMBS)
def test_memory_is_bounded(name: str, tmp_path: Path) -> None:
    data, suffix = bomb(name)
    path = tmp_path / f"log{suffix}"
    path.write_bytes(data)
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(path), str(tmp_path / "out.feather")],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stderr == ""
    *said, peak = done.stdout.splitlines()
    assert int(peak) < 2 << 20  # kB
    if name != "tdms that claims":  # its segments say how long they are, which is right
        assert done.returncode in (3, 4)
        assert len(said) == 1
        assert said[0].startswith(str(path))


def test_the_same_seed_gives_the_same_cases() -> None:
    first, second = (list(cases(7, 60)) for _ in range(2))
    damaged = [case for case in first if not case[0].startswith("bomb")]
    assert damaged == [case for case in second if not case[0].startswith("bomb")]
    assert [case[0] for case in first] == [case[0] for case in second]
    assert [label for label, _, _ in cases(8, 60)] != [label for label, _, _ in first]
