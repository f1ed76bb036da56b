"""What a log does not resolve in time has no name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.resolved import away_from_turns, next_to_turns
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start

NAMES = ("mount_compliance", "backlash", "signed_yield_lag")


@pytest.fixture(scope="module")
def smeared() -> Recording:
    """The first sample behind each turn holds a part of the force before it, and no more does."""
    r = noisy(campaign(100.0, 8.0), seed=31)
    assert r.force is not None
    turn = np.diff(np.sign(r.xdot)) != 0.0
    turn[r.starts[1:-1] - 1] = False
    behind = np.flatnonzero(turn) + 1
    force = r.force.copy()
    force[behind] += 0.3 * (r.force[behind - 1] - r.force[behind])
    return replace(r, force=force)


@pytest.mark.long
def test_the_samples_of_turns_alone_name_nothing(smeared: Recording) -> None:
    found = diagnose(smeared, [get(n) for n in NAMES], limits=False, learning=False)
    assert found.findings == ()
    assert found.verdict == "unexplained"
    assert "of a reversal" in found.mismatch[0].text


def test_what_a_hypothesis_takes_at_turns_and_elsewhere(smeared: Recording) -> None:
    problem = prepare(smeared)
    base = fit_hypothesis(problem, (), [fresh_start(0.05, 0.4)])
    between = away_from_turns(problem.block.signals)
    assert 0.01 < float(np.mean(between == 0.0)) < 0.1
    for away, is_next in ((1.0, True), (0.999, True), (0.9, False)):
        part = np.where(between > 0.0, away, 0.5)
        other = replace(base, cross_validated=base.cross_validated * part)
        assert next_to_turns(problem, base, other) is is_next
