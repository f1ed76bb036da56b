"""Sudden jumps in a residual are told from noise of any colour, spikes and coarse channels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign
from scipy.signal import lfilter

from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.impulses import impulse_share


@pytest.fixture(scope="module")
def problem() -> Problem:
    return prepare(campaign())


def noise(problem: Problem, correlation: float, seed: int = 5) -> np.ndarray:
    white = np.random.default_rng(seed).normal(size=len(problem.block.force))
    return np.asarray(lfilter([np.sqrt(1 - correlation**2)], [1.0, -correlation], white))


@pytest.mark.parametrize("correlation", [0.0, 0.9, 0.99])
def test_noise_has_none(problem: Problem, correlation: float) -> None:
    assert impulse_share(problem, noise(problem, correlation)) == 0.0


@pytest.mark.parametrize("correlation", [0.0, 0.9, 0.99])
def test_a_seal_that_sticks_and_slips_has(problem: Problem, correlation: float) -> None:
    """Stretched with the deflection, sprung back every 8 mm: a saw-tooth of its own phase."""
    saw = 20.0 * np.mod(problem.block.signals.x / 0.008 + 0.3, 1.0)
    share = impulse_share(problem, saw - saw.mean() + noise(problem, correlation))
    assert share > 0.5


def test_spikes_are_not_jumps(problem: Problem) -> None:
    values = noise(problem, 0.9)
    values[np.random.default_rng(3).integers(0, len(values), 200)] += 30.0
    assert impulse_share(problem, values) == 0.0


def test_steps_of_a_coarse_channel_are_not_jumps(problem: Problem) -> None:
    smooth = 3.0 * np.sin(problem.block.signals.t)
    force = np.round(problem.block.force + smooth)
    coarse = replace(problem, block=problem.block._replace(force=force))
    assert impulse_share(coarse, np.round(smooth) - smooth) == 0.0


def test_jumps_where_a_model_jumps_are_its_own(problem: Problem) -> None:
    """At reversals and steps of the duty a slightly wrong model misses by a jump too."""
    assert (
        impulse_share(problem, 3.0 * problem.block.signals.sign + 0.1 * noise(problem, 0.0)) == 0.0
    )
