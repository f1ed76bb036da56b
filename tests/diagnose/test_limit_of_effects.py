"""The data end the search: with more effects allowed than they ask for, the names are the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get

CANDIDATES = [
    "coulomb_friction", "quadratic_damping", "fluid_inertia", "force_offset", "shear_thinning",
    "position_dependent_damping", "force_drift",
]  # fmt: skip


SHORT = {"limits": False, "learning": False}  # no name rests on either


@pytest.fixture(scope="module")
def log() -> Recording:
    """Friction, turbulence and a zero error."""
    r = noisy(campaign(100.0, 6.0), seed=17)
    assert r.force is not None
    return replace(r, force=r.force + 2.0 * np.sign(r.xdot) + 60.0 * r.xdot * np.abs(r.xdot) - 1.5)


def test_names_do_not_change_with_the_limit(log: Recording) -> None:
    tried = [*map(get, CANDIDATES)]
    names = {
        most: [f.effect.name for f in diagnose(log, tried, most=most, **SHORT).findings]
        for most in (3, 12)  # as many as they ask for, and more than there are
    }
    assert set(names[3]) == {"coulomb_friction", "quadratic_damping", "force_offset"}
    assert names[3] == names[12]


def test_fewer_than_the_data_ask_for_explain_nothing(log: Recording) -> None:
    found = diagnose(log, [*map(get, CANDIDATES)], most=1, **SHORT)
    assert len(found.findings) <= 1
    assert found.verdict is Verdict.UNEXPLAINED
