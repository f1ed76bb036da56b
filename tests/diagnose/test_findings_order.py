"""The finding that takes most of the misfit comes first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.findings import findings
from erdctl.diagnose.resolved import away_from_turns
from erdctl.effects import get


def rubbing_and_turbulent() -> Diagnosis:
    r = campaign()
    assert r.force is not None
    force = r.force + 3.0 * np.sign(r.xdot) + 40.0 * r.xdot * np.abs(r.xdot)
    return diagnose(
        noisy(replace(r, force=force), seed=4, rms=0.3),
        [get("quadratic_damping"), get("coulomb_friction")],
        limits=False,
    )


@pytest.mark.long
def test_what_faint_effects_can_stand_in_for_still_goes_first() -> None:
    """With friction away the rest may fit nearly as well; alone it takes the most by far."""
    found = rubbing_and_turbulent()
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


@pytest.mark.long
def test_what_takes_its_part_next_to_turns_goes_after_what_is_strong_elsewhere() -> None:
    """A velocity that is a little noisy has the wrong sign there: twice the yield force at once."""
    found = rubbing_and_turbulent()
    best = found.selection.best
    turns = away_from_turns(best.problem.block.signals) == 0.0
    assert 0 < np.count_nonzero(turns) < 0.2 * len(turns)
    # As if without quadratic damping the error were large next to turns, and no other.
    off = np.where(turns, 1e3, best.cross_validated)
    there = replace(best, cross_validated=off)
    without = {**found.selection.without, "quadratic_damping": there}
    singles = tuple(h for h in found.selection.singles if h.effects[-1].name == "coulomb_friction")
    again = findings(found.problem, replace(found.selection, without=without, singles=singles))
    assert [f.effect.name for f in again] == ["coulomb_friction", "quadratic_damping"]
    assert again[0].gain.gain < again[1].gain.gain
