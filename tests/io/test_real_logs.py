"""Real recordings are read as they are."""

from __future__ import annotations

import pytest
from places import SHARED
from rig import real

from erdctl.io.logs import read_logs

pytestmark = pytest.mark.real_data


@pytest.mark.parametrize(
    ("name", "samples", "records", "missing"),
    [
        ("mr_raw.parquet", 37_188, 10, "no column xdot"),
        ("friction_semiactive.parquet", 61_444, 4, "no column duty"),
    ],
)
def test_a_real_recording(name: str, samples: int, records: int, missing: str) -> None:
    said: list[str] = []
    log = read_logs([str(real(name, SHARED))], need_force=True, report=said.append).recording
    assert (len(log), len(log.names)) == (samples, records)
    assert any(missing in line for line in said)
