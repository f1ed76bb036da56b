"""Effects that come together, beside those that were found: neither gains alone there.

`mr_sine` without its fast motion: an average, a sign law of the speed and travel until the yield
force is back are found. What is viscous and what yields follow a power of the speed each; either of
them alone leaves as much as before, both leave half of it.
"""

from __future__ import annotations

import pytest
from peers import error, of_model
from places import SHARED
from rig import real

from erdctl.core.blocks import thinned
from erdctl.diagnose.companion_effects import companion_sets
from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import get
from erdctl.io.logs import read_logs

CANDIDATES = (
    "force_smoothing", "preyield_viscosity", "preyield_elasticity", "power_law_yield",
    "shear_thinning", "backlash", "mount_compliance", "coulomb_friction",
    "preyield_field_dependence",
)  # fmt: skip
TOGETHER = {"power_law_yield", "shear_thinning"}


def test_one_fluid_has_both_laws() -> None:
    sets = [{e.name for e in found} for found in companion_sets([get(n) for n in CANDIDATES])]
    assert TOGETHER in sets


@pytest.mark.real_data
def test_they_are_found_together_and_hold_on_another_motion() -> None:
    log = read_logs([str(real("mr_sine.parquet", SHARED))], need_force=True, report=str).recording
    fast = ["5mm_3Hz" in name for name in log.names]
    fitted, other = (
        log.select([i for i, held in enumerate(fast) if held is out]) for out in (False, True)
    )
    candidates = [get(n) for n in CANDIDATES]
    found = diagnose(thinned(fitted, 6_000), candidates, limits=False, learning=False)
    assert {f.effect.name for f in found.findings} >= TOGETHER
    assert error(other, of_model(found.selection.base, other)) > 0.07
    assert error(other, of_model(found.selection.best, other)) < 0.025
