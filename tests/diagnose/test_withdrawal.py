"""One effect of two fails on records that nothing has seen: the other keeps its name."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest
from seeded import KNOWN

from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import get
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log


@pytest.mark.long
def test_what_does_not_hold_takes_no_other_with_it(tmp_path: Path) -> None:
    """A threshold of the field between two levels of the log, in a record kept aside a level in its
    steepest part. A dead time of five times the noise lost its name with it."""
    case = draw(1552011, kind="crowded", known=[*KNOWN, "damped_backlash"])
    assert case.truth[0].name == "input_delay"
    pq.write_table(log(case), tmp_path / "log.parquet")
    found = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    candidates = [get(n) for n in ("input_delay", "field_threshold", "signed_yield_lag")]
    said = diagnose(found, candidates, limits=False, learning=False)
    assert [f.effect.name for f in said.findings] == ["input_delay"]
    assert [e.name for e in said.withdrawn] == ["field_threshold"]
    assert said.unseen[0].after < 0.8 * said.unseen[0].before
    assert said.unseen[0].names
    assert not said.unseen[0].never_seen  # it has decided
