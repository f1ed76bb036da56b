"""Variance that depends on the state: noise that grows is noise, misfit of a random sign is not."""

from __future__ import annotations

import numpy as np
import pytest
from rig import campaign
from scipy.signal import lfilter

from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.predictability import lack_of_fit_test


@pytest.fixture(scope="module")
def problem() -> Problem:
    return prepare(campaign())


def noise(problem: Problem, correlation: float, seed: int) -> np.ndarray:
    white = np.random.default_rng(seed).normal(size=len(problem.block.force))
    return np.asarray(lfilter([np.sqrt(1 - correlation**2)], [1.0, -correlation], white))


@pytest.mark.parametrize("correlation", [0.0, 0.7])
def test_noise_that_grows_with_the_force_is_noise(problem: Problem, correlation: float) -> None:
    force = np.abs(problem.block.force)
    residual = (0.3 + 1.2 * force / force.max()) * noise(problem, correlation, 3)
    found = lack_of_fit_test(problem, residual)
    assert not found.significant
    assert found.noise_rms == pytest.approx(np.sqrt(np.mean(residual**2)), rel=0.05)


def test_a_slow_misfit_of_a_random_sign_is_none(problem: Problem) -> None:
    """Twice the noise where the piston is fast, each of some 50 ms with a sign of its own."""
    s = problem.block.signals
    fast = np.abs(s.xdot) > np.median(np.abs(s.xdot))
    sign = np.repeat(np.random.default_rng(4).choice([-1.0, 1.0], len(s) // 10 + 1), 10)[: len(s)]
    misfit = 0.6 * fast * sign
    found = lack_of_fit_test(problem, 0.3 * noise(problem, 0.0, 5) + misfit)
    assert found.significant
    assert found.misfit_rms == pytest.approx(np.sqrt(np.mean(misfit**2)), rel=0.3)
