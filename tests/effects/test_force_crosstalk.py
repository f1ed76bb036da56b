"""A force channel that picks up the control voltage."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.effects import get

RIVALS = (
    "cavitation", "coulomb_friction", "force_crosstalk", "force_offset", "gas_preload",
    "position_dependent_damping", "preyield_viscosity",
)  # fmt: skip


def seen(full: float, zero: float = 0.0) -> Recording:
    r = campaign(100.0, 8.0)
    assert r.force is not None
    return noisy(replace(r, force=r.force + full * r.duty + zero), 7, rms=0.2)


def named(r: Recording) -> tuple[Diagnosis, set[str]]:
    found = diagnose(r, [get(n) for n in RIVALS], limits=False, learning=False)
    return found, {f.effect.name for f in found.findings}


@pytest.mark.few(1)
@pytest.mark.parametrize("full", [4.0, -2.0])
def test_it_has_a_name(full: float) -> None:
    """An audit's log of 1.75 N at full duty was said to cavitate, 2 mm of void and all."""
    found, names = named(seen(full))
    assert names == {"force_crosstalk"}
    assert found.findings[0].equivalent == ()
    assert found.verdict.value == "explained"
    assert found.fit.values["force_crosstalk.F_u"] == pytest.approx(full, abs=0.15)


@pytest.mark.long
def test_beside_a_zero_of_the_channel() -> None:
    found, names = named(seen(4.0, zero=-3.0))
    assert names == {"force_crosstalk", "force_offset"}
    assert found.fit.values["force_offset.F_z"] == pytest.approx(-3.0, abs=0.1)


@pytest.mark.long
def test_at_one_duty_it_is_no_candidate() -> None:
    """A constant is a zero of the force there."""
    r = seen(0.0, zero=-3.0)
    found, names = named(replace(r, duty=np.full(len(r), 0.2)))
    assert "force_crosstalk" not in names
    assert "force_crosstalk" not in {e for f in found.findings for e in f.equivalent}
