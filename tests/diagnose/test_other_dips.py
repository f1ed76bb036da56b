"""A fit of several effects is not left in a dip that was the deepest beside fewer."""

from __future__ import annotations

import pytest
from peers import error, of_model
from places import SHARED
from rig import real

from erdctl.core.blocks import thinned
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.search import search
from erdctl.diagnose.slight_lag import freed
from erdctl.effects import get
from erdctl.io.logs import read_logs

JOINT = "damped_backlash"
EFFECTS = (JOINT, "power_law_yield", "field_threshold", "presliding_friction")


@pytest.mark.real_data
def test_the_joint_of_a_real_damper_is_found_once_the_fluid_is() -> None:
    """Fitted with nothing beside it, it had a film of 63 kN s/m between stiff flanks, and kept it
    as three laws of the fluid came: 0.039 of range was left on the motion that no fit has seen."""
    path = str(real("mr_raw.parquet", SHARED))
    r = read_logs([path], need_force=True, report=lambda line: None).recording
    fitted, other = (
        r.select([i for i, name in enumerate(r.names) if name.startswith(motion)])
        for motion in ("5mm_3Hz", "25mm_0.5Hz")
    )
    problem = freed(prepare(thinned(fitted, 3_000)))
    found = search(problem, [get(name) for name in EFFECTS], 4, Executor([problem])).best
    assert {e.name for e in found.effects} == {*EFFECTS}
    assert found.values[f"{JOINT}.c_m"] == pytest.approx(26e3, rel=0.1)
    assert error(other, of_model(found, other)) < 0.022
