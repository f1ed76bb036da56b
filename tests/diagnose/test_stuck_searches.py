"""A search that was caught at a bound must not make an effect look worth something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl import effects
from erdctl.diagnose.executor import Crew
from erdctl.diagnose.forward_step import Seen, extension, key_of
from erdctl.diagnose.hypothesis import Trial, attempt, fresh_start
from erdctl.diagnose.problem import Study, prepare
from erdctl.diagnose.screening import Prospect
from erdctl.diagnose.search import _lesser
from erdctl.estimate.least_squares import SHORTEST, at_bound
from erdctl.model.paper import QUANTITIES

FRICTION = effects.get("coulomb_friction")


@pytest.fixture(scope="module")
def study() -> Study:
    return prepare(noisy(campaign(100.0, 6.0), seed=4))


def no_steps(study: Study) -> Trial:
    """The paper's model as from a search that never left a lag of nothing."""
    trial = attempt(study, (), [fresh_start(0.05, 0.4)])
    stuck = {**trial.values, **fresh_start(SHORTEST, 0.4)}
    s = study.block.signals
    error = study.block.force - trial.model.force(s, stuck)
    return replace(trial, values=stuck, residual=error, unseen=error)


def test_a_parameter_at_its_bound_is_known() -> None:
    T_d, beta = QUANTITIES["T_d"], QUANTITIES["beta"]
    assert at_bound(T_d, SHORTEST)
    assert at_bound(T_d, T_d.high)
    assert not at_bound(T_d, 0.04)
    assert at_bound(beta, beta.low)
    assert not at_bound(beta, 0.4)


def test_what_is_added_to_a_cornered_model_also_starts_afresh(study: Study) -> None:
    prospect = Prospect(FRICTION, 0.1, ({},))
    cornered = no_steps(study)
    free = replace(cornered, values={**cornered.values, **fresh_start(0.03, 0.5)})
    assert len(extension("", free, prospect).starts) == 1
    *_, last = extension("", cornered, prospect).starts
    assert not at_bound(QUANTITIES["T_d"], last["compression.T_d"])


def test_a_smaller_model_is_searched_for_from_where_the_larger_ended(study: Study) -> None:
    base = no_steps(study)
    larger = attempt(study, (FRICTION,), [fresh_start(0.05, 0.4)])
    seen = Seen([base, larger])
    (lesser,) = _lesser(study, base, larger, seen, Crew([study]))
    assert lesser.score < 0.8 * base.score
    assert seen[key_of(base.effects)] is lesser
    assert lesser.score == pytest.approx(larger.score, rel=0.02)  # nothing rubs in this log
    assert np.ptp(lesser.residual) < np.ptp(base.residual)
    (again,) = _lesser(study, base, larger, seen, Crew([study]))
    assert again is lesser
