"""A law that acts on one motion alone is no law of the damper."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest
from seeded import known_before

from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log


@pytest.mark.long
def test_a_swing_that_one_record_alone_excites_is_no_law(tmp_path: Path) -> None:
    """A valve that bleeds at one motion was a swing at that motion's frequency: the others gained,
    rid of it, and what was learned was twice as far off on fresh motion as the paper's model."""
    case = draw(1565011, known=known_before("deflection_offset"))
    assert [t.name for t in case.truth] == ["bleed_valve"]
    pq.write_table(log(case), tmp_path / "log.parquet")
    recording = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    found = diagnose(recording, [get("coulomb_friction")], limits=False)
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.learned is None
    assert not found.findings
