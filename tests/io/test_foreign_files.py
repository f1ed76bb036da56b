"""Random dialects of one log read to the same numbers, or stop and name the option that decides."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest
from foreign_files import Foreign, draw

from erdctl.core.errors import ErdctlError
from erdctl.io.logs import read_logs

# ERDCTL_FOREIGN=10000 pytest tests/io/test_foreign_files.py for a long run
CASES = int(os.environ.get("ERDCTL_FOREIGN", "150"))
GROUPS = 8
_STAMPS = {"seconds", "ms"}


def wrong(case: Foreign, path: Path, text: list[str]) -> list[str]:
    """Channels that were read, but not to the numbers in the file."""
    read = read_logs([str(path)], maps=case.maps, text=text, need_force=True, report=lambda s: None)
    out = []
    for name, want in case.truth.items():
        got = getattr(read.recording, name)
        if name == "t" and case.about["clock"] not in _STAMPS:
            want = want - want[0]
        if len(got) != len(want) or not np.allclose(got, want, rtol=1e-12, atol=1e-12):
            out.append(name)
    return out


@pytest.mark.parametrize("group", range(GROUPS))
def test_no_wrong_number(group: int, tmp_path: Path) -> None:
    path = tmp_path / "lab.txt"
    stopped = 0
    for seed in range(group, CASES, GROUPS):
        case = draw(seed)
        path.write_bytes(case.data)
        try:
            assert not wrong(case, path, []), case.about
        except ErdctlError as error:
            stopped += 1
            message = str(error)
            options = re.findall(r"--text (\w+=\w+)", message)
            assert options, (case.about, message)
            # The option that is true of this file must settle it.
            called = {".": "point", ",": "comma"}
            true = f"decimal={called[case.about['decimal']]}"
            assert true in options, (case.about, message)
            assert not wrong(case, path, [true]), case.about
    assert stopped <= 2 + CASES // GROUPS // 20  # what is clear must not be asked


def test_the_generator_draws_all_kinds() -> None:
    drawn = [draw(seed).about for seed in range(200)]
    for key, least in {
        "separator": 8,
        "clock": 12,
        "encoding": 7,
        "style": 7,
        "decimal": 2,
    }.items():
        assert len({about[key] for about in drawn}) >= least, key
