"""A search that was caught at a bound must not make an effect look worth something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.forward_step import Exploration, Explored, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.screening import Candidate, Screen
from erdctl.effects import get
from erdctl.estimate.least_squares import NEAR, SHORTEST, at_bound
from erdctl.estimate.starts import fresh_start
from erdctl.model.paper import QUANTITIES

FRICTION = get("coulomb_friction")


@pytest.fixture(scope="module")
def problem() -> Problem:
    return prepare(noisy(campaign(100.0, 6.0), seed=4))


def no_steps(problem: Problem) -> Hypothesis:
    """The paper's model as from a search that never left a lag of nothing."""
    hypothesis = fit_hypothesis(problem, (), [fresh_start(0.05, 0.4)])
    stuck = {**hypothesis.values, **fresh_start(SHORTEST, 0.4)}
    s = problem.block.signals
    error = problem.block.force - hypothesis.model.force(s, stuck)
    fitted = replace(hypothesis.fitted, values=stuck, residual=error)
    return replace(hypothesis, fitted=fitted, cross_validated=error)


def test_a_parameter_at_its_bound_is_known() -> None:
    T_d, beta = QUANTITIES["T_d"], QUANTITIES["beta"]
    assert at_bound(T_d, SHORTEST, near=NEAR)
    assert at_bound(T_d, T_d.high, near=NEAR)
    assert not at_bound(T_d, 0.04, near=NEAR)
    assert at_bound(beta, beta.low, near=NEAR)
    assert not at_bound(beta, 0.4, near=NEAR)
    assert at_bound(beta, beta.low)
    assert not at_bound(T_d, SHORTEST)  # which a search cannot pass, but a value can


def test_what_is_added_to_a_model_at_a_bound_also_starts_afresh(problem: Problem) -> None:
    candidate = Candidate(FRICTION, 0.1, ({},))
    cornered = no_steps(problem)
    values = {**cornered.values, **fresh_start(0.03, 0.5)}
    free = replace(cornered, fitted=replace(cornered.fitted, values=values))
    assert len(with_effect("", free, candidate).starts) == 1
    *_, last = with_effect("", cornered, candidate).starts
    assert not at_bound(QUANTITIES["T_d"], last["compression.T_d"], near=NEAR)


def test_a_smaller_model_is_searched_for_from_where_the_larger_ended(problem: Problem) -> None:
    base = no_steps(problem)
    larger = fit_hypothesis(problem, (FRICTION,), [fresh_start(0.05, 0.4)])
    seen = Explored([base, larger])
    search = Exploration(problem, base, seen, Executor([problem]))
    (lesser,) = without_each(search, larger)
    assert lesser.score < 0.8 * base.score
    assert seen[key_of(base.effects)] is lesser
    assert lesser.score == pytest.approx(larger.score, rel=0.02)  # nothing rubs in this log
    assert np.ptp(lesser.residual) < np.ptp(base.residual)
    (again,) = without_each(search, larger)
    assert again is lesser


def test_starts_of_a_fine_grid_are_taken_from_different_valleys(problem: Problem) -> None:
    """The two best of 30 gaps that go up by 1.3 would be neighbours, and end in one place."""
    base = fit_hypothesis(problem, (), [{}])
    candidate = Screen(problem, base).candidate(get("backlash"))
    assert candidate is not None
    one, other = sorted(start["backlash.g"] for start in candidate.starts)
    assert other > 1.5 * one
