"""An effect that may be absent within its own error is no finding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.fit_errors import fit_errors, may_be_absent
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start


@pytest.mark.parametrize(("zero", "absent"), [(0.0, True), (0.5, False)])
def test_a_zero_that_the_log_has_not_told(zero: float, absent: bool) -> None:
    r = noisy(campaign(100.0, 6.0), seed=8)
    assert r.force is not None
    problem = prepare(replace(r, force=r.force + zero))
    effect = get("force_offset")
    fit, _ = fit_errors(problem, fit_hypothesis(problem, [effect], [fresh_start(0.05, 0.4)]))
    assert fit.values[effect.key("F_z")] == pytest.approx(zero, abs=0.1)
    assert may_be_absent(effect, fit) is absent


def test_one_of_several_parameters_may_be_off() -> None:
    """A drift that is a straight line has no curvature, and is a drift."""
    r = noisy(campaign(100.0, 6.0), seed=9)
    assert r.force is not None
    since = r.t - np.repeat(r.t[r.starts[:-1]], np.diff(r.starts))
    problem = prepare(replace(r, force=r.force + 0.5 * since))
    effect = get("force_drift")
    fit, _ = fit_errors(problem, fit_hypothesis(problem, [effect], [fresh_start(0.05, 0.4)]))
    assert abs(fit.values[effect.key("d_2")]) < 3.0 * fit.stderr[effect.key("d_2")]
    assert not may_be_absent(effect, fit)


def test_an_interval_that_is_open_to_a_bound_says_nothing() -> None:
    """Under misfit the profile of an average may be open to 0, however much the average takes."""
    r = noisy(campaign(100.0, 6.0), seed=10)
    problem = prepare(r)
    effect = get("force_smoothing")
    (name,) = effect.off
    start = {**fresh_start(0.05, 0.4), name: 0.1}
    fit, _ = fit_errors(problem, fit_hypothesis(problem, [effect], [start], 1))
    there = replace(fit, values={**fit.values, name: 0.1})
    assert not may_be_absent(effect, replace(there, intervals={name: (0.0, 0.3)}))
    assert not may_be_absent(effect, replace(there, intervals={name: (0.05, 0.3)}))
