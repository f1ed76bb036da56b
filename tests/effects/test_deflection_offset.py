"""The deflection counts from another place than that where the gas spring is at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import get
from erdctl.model.composed import Model

RIVALS = (
    "coulomb_friction", "deflection_offset", "field_viscosity", "force_offset", "gas_preload",
    "position_dependent_damping",
)  # fmt: skip


@pytest.mark.parametrize("zero", [0.02, -0.06])
def test_a_channel_that_counts_from_elsewhere(zero: float) -> None:
    """Each spring pulls by what it is stretched from its own rest, whatever the channel shows."""
    s = Signals.of(campaign(100.0, 8.0))
    model = Model((get("deflection_offset"),))
    shifted = s.with_motion(s.x + zero, s.xdot)
    force = model.force(shifted, {**TRUTH, "deflection_offset.x_z": zero})
    assert force == pytest.approx(Model().force(s, TRUTH), abs=1e-9)


@pytest.mark.few(1)
@pytest.mark.parametrize("zero", [0.02, 0.06])
def test_a_deflection_from_an_end_of_its_range_is_no_zero_of_the_force(zero: float) -> None:
    """The force channel was said to have a zero error of -4 N, the damping to vary over the stroke
    and the viscosity to grow with the field: the springs of the two directions are not alike."""
    clean = campaign(100.0, 8.0)
    seen = noisy(replace(clean, x=clean.x + zero), 3, rms=0.2)
    found = diagnose(seen, [get(n) for n in RIVALS], limits=False)
    (finding,) = found.findings
    assert finding.effect.name == "deflection_offset"
    assert finding.equivalent == ()
    assert found.verdict.value == "explained"
    x_z = found.fit.values["deflection_offset.x_z"]
    assert x_z == pytest.approx(zero, abs=1e-3)


@pytest.mark.long
def test_alike_springs_tell_it_from_no_zero_of_the_force() -> None:
    clean = campaign(100.0, 8.0)
    assert clean.force is not None
    one = 600.0  # N/m, in both directions
    k = np.where(clean.xdot > 0.0, TRUTH["compression.k_nom"], TRUTH["release.k_nom"])
    alike = replace(clean, x=clean.x + 0.01, force=clean.force + (one - k) * clean.x)
    found = diagnose(noisy(alike, 4, rms=0.2), [get(n) for n in RIVALS], limits=False)
    (finding,) = found.findings
    assert {finding.effect.name, *finding.equivalent} >= {"deflection_offset", "force_offset"}


@pytest.mark.long
def test_where_nothing_tells_a_zero_of_the_force_has_the_name() -> None:
    """It is the plainer one; the fit of either is the better one by chance."""
    clean = campaign(100.0, 8.0)
    assert clean.force is not None
    k = np.where(clean.xdot > 0.0, TRUTH["compression.k_nom"], TRUTH["release.k_nom"])
    alike = replace(clean, force=clean.force + (600.0 - k) * clean.x - 1.0)
    for seed in (0, 2):  # the one fits a little better in the one, the other in the other
        found = diagnose(noisy(alike, seed, rms=0.2), [get(n) for n in RIVALS], limits=False)
        (finding,) = found.findings
        assert finding.effect.name == "force_offset"
        assert "deflection_offset" in finding.equivalent
