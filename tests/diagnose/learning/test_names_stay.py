"""A law that does the same as a name, and fits better, leaves the name what it is."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest
from seeded import known_before

from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log


@pytest.mark.long
def test_chains_of_many_lengths_are_still_a_pre_yield_elasticity(tmp_path: Path) -> None:
    """They break one after the other, and the effect of the catalogue all alike: 97 % of what the
    paper's model misses. A curve over the travel since a turn fits better, and the name was gone:
    no effect of the catalogue explained the misfit."""
    case = draw(1580399, known=known_before("deflection_offset"))
    assert [t.name for t in case.truth] == ["preyield_elasticity"]
    pq.write_table(log(case), tmp_path / "log.parquet")
    recording = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    found = diagnose(recording, [get("preyield_elasticity")], limits=False)
    assert [f.effect.name for f in found.findings] == ["preyield_elasticity"]
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.learned is not None
    assert "no effect that was tried explains what those named leave" in remaining_text(found)
    assert found.corrected.overall.nrmse < 0.35 * found.baseline.overall.nrmse
