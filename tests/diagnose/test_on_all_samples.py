"""What was searched on some samples is fitted to all from more than one dip of the cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign

from erdctl.diagnose.executor import Executor
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.on_all_samples import _on_all_samples, refit
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.search import Selection, base_starts
from erdctl.effects import get

DELAY = 0.0175  # s
SKEW = "time_skew.tau"


def test_a_smaller_model_is_fitted_from_the_delay_of_the_best_one() -> None:
    """The cost has a dip wherever a jump of the force meets one of the model."""
    r = campaign()
    force = np.concatenate([np.interp(r.t[s] - DELAY, r.t[s], r.force[s]) for s in r.slices])
    force += np.random.default_rng(1).normal(0.0, 0.3, len(force))
    problem = prepare(replace(r, force=force))
    skew, friction = get("time_skew"), get("coulomb_friction")
    stuck = fit_hypothesis(problem, (skew,), [{SKEW: -0.3}])
    assert abs(stuck.values[SKEW] - DELAY) > 0.01
    best = fit_hypothesis(problem, (skew, friction), [{SKEW: 0.015}])
    again = _on_all_samples(problem, [stuck, best], best, Executor([problem]))
    found = again[frozenset({"time_skew"})]
    # In its dip, which is as wide as a step of 5 ms; a few steps of the search do not end in it.
    assert found.values[SKEW] == pytest.approx(DELAY, abs=2.5e-3)
    assert found.score < stuck.score


def test_a_search_on_as_many_samples_of_which_few_have_weight_is_fitted_to_all() -> None:
    """The search of a log of a hopping wheel had all of its samples, and nearly all without weight;
    "what remains, 0.615 N rms, is noise" was of those, and 1.7 N were left of all."""
    problem = prepare(campaign())
    weight = problem.block.weight * (np.arange(len(problem.block.force)) % 7 == 0)
    rows = np.arange(len(weight))
    searched = replace(
        problem, block=problem.block._replace(weight=weight),
        recording=problem.recording.take(rows, problem.recording.starts, problem.recording.names),
    )  # fmt: skip
    base = fit_hypothesis(searched, (), base_starts({})[:1])
    found = refit(problem, Selection(base, base, (), {}, {}), Executor([problem]))
    assert np.array_equal(found.best.problem.block.weight, problem.block.weight)
    assert found.best.score != base.score
