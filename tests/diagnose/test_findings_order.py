"""The finding that takes most of the misfit comes first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rig import campaign, noisy

from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.findings import findings
from erdctl.effects import get


def test_what_faint_effects_can_stand_in_for_still_goes_first() -> None:
    """With friction away the rest may fit nearly as well; alone it takes the most by far."""
    r = campaign()
    assert r.force is not None
    force = r.force + 3.0 * np.sign(r.xdot) + 40.0 * r.xdot * np.abs(r.xdot)
    found = diagnose(
        noisy(replace(r, force=force), seed=4, rms=0.3),
        [get("quadratic_damping"), get("coulomb_friction")],
        limits=False,
    )
    names = [f.effect.name for f in found.findings]
    assert names == ["coulomb_friction", "quadratic_damping"]
    # As if without friction little were lost: a model that has hardly more than the best.
    near = replace(
        found.selection.best, cross_validated=1.005 * found.selection.best.cross_validated
    )
    stood_in = replace(
        found.selection, without={**found.selection.without, "coulomb_friction": near}
    )
    again = findings(found.problem, stood_in)
    assert [f.effect.name for f in again] == names
    assert again[0].gain.gain < again[1].gain.gain
