"""A mount and a yield force that is made from more than the sign of the speed, in one damper."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from erdctl.core.blocks import thinned
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get, names
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log

SAMPLES = 3000  # of 35,630: steps of 48 ms, whose own errors no play may take


@pytest.mark.long
@pytest.mark.parametrize("name", ["yield_hysteresis", "signed_yield_lag"])
def test_both_are_named(name: str, tmp_path: Path) -> None:
    """No model had both: one was named, and the other's force was said to be of other effects."""
    pair = ["mount_compliance", name]
    case = draw(1, kind="pair", effects=pair, known=names(), level=6.0, colour="white")
    pq.write_table(log(case), tmp_path / "log.parquet")
    recording = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    candidates = [get(n) for n in (*pair, "backlash")]
    few = thinned(recording, SAMPLES)
    found = diagnose(few, candidates, limits=False, learning=False)
    assert {f.effect.name for f in found.findings} == set(pair)
    assert found.verdict is Verdict.EXPLAINED
