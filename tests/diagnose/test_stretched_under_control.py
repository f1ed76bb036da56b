"""Dampers of the literature whose yield force is stretched before it yields, under a control that
steps: what is stretched follows the control with it (`tests/literature_dampers.py`)."""

from __future__ import annotations

from pathlib import Path

import literature_dampers
import pytest

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get
from erdctl.io.logs import read_logs

CANDIDATES = (
    "preyield_elasticity", "presliding_friction", "field_viscosity", "mount_compliance",
    "preyield_viscosity", "signed_yield_lag", "coulomb_friction",
)  # fmt: skip


@pytest.fixture
def dahl(tmp_path: Path) -> Recording:
    path = tmp_path / "dahl.parquet"
    literature_dampers.log("dahl", 11, random=True, records=5).to_parquet(path)
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


@pytest.mark.long
def test_dahls_damper_under_a_control_that_steps_is_explained(dahl: Recording) -> None:
    """33 N was left beyond a noise of 13 by a force that builds up anew after each step;
    T_d was 4 ms for 16.7, `field_viscosity` was not named, and the log was `unexplained`."""
    found = diagnose(dahl, [get(name) for name in CANDIDATES], limits=False, learning=False)
    names = {f.effect.name for f in found.findings}
    assert names == {"preyield_elasticity", "presliding_friction", "field_viscosity"}
    assert found.verdict is Verdict.EXPLAINED
    for way in ("compression", "release"):
        assert found.fit.values[f"{way}.T_d"] == pytest.approx(1.0 / 60.0, rel=0.03)
