"""What comes again with every so much travel is told from noise of any colour, and from a hum."""

from __future__ import annotations

import numpy as np
import pytest
import trajectories
from rig import noisy, recording
from scipy.signal import lfilter

from erdctl.core.recording import Array, concatenate
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.predictability import lack_of_fit_test
from erdctl.diagnose.residual.travel_line import travel_line

TOOTH = 1.1e-3  # m


@pytest.fixture(scope="module")
def problem() -> Problem:
    """Four slow records; the teeth have another phase in each stroke."""
    random, t, out = np.random.default_rng(3), np.arange(2400) / 200.0, []
    for i in range(4):
        m = trajectories.sine(0.23 + 0.11 * i, 0.015 - 0.002 * i, 0.4 * i)
        duty = trajectories.random_hold(random, t, (0.0, 0.1, 0.2, 0.3))
        out.append(recording(t, m.x(t), m.velocity(t), duty, f"{i}", m.velocity_at))
    return prepare(noisy(concatenate(out), seed=1))


def teeth(problem: Problem) -> Array:
    """(n,) a saw-tooth over travel, in each stroke from a phase of its own."""
    s = problem.block.signals
    begins = np.zeros(len(s), dtype=int)
    begins[np.concatenate([s.turns[0] + 1, s.starts[:-1]])] = 1
    stroke = np.cumsum(begins)
    phase = np.random.default_rng(2).uniform(size=stroke[-1] + 1)[stroke]
    return np.mod(np.cumsum(s.path[0]) / TOOTH + phase, 1.0) - 0.5


def noise(problem: Problem, correlation: float, seed: int) -> Array:
    white = np.random.default_rng(seed).normal(size=len(problem.block.force))
    return np.asarray(lfilter([np.sqrt(1 - correlation**2)], [1.0, -correlation], white))


@pytest.mark.parametrize("correlation", [0.0, 0.5, 0.9, 0.99])
@pytest.mark.parametrize("seed", range(5))
def test_noise_has_none(problem: Problem, correlation: float, seed: int) -> None:
    assert travel_line(problem, noise(problem, correlation, seed)) is None


@pytest.mark.parametrize("correlation", [0.0, 0.9])
def test_teeth_have_their_length(problem: Problem, correlation: float) -> None:
    found = travel_line(problem, 5.0 * teeth(problem) + noise(problem, correlation, 4))
    assert found is not None
    assert found.wavelength == pytest.approx(TOOTH, rel=0.02)
    assert 0.1 < found.share < 0.9


def test_what_teeth_leave_is_no_noise(problem: Problem) -> None:
    """No regression predicts them, as each stroke has another phase, and jumps are many."""
    chatter = 5.0 * teeth(problem) + 0.3 * noise(problem, 0.0, 6)
    left = lack_of_fit_test(problem, chatter)
    assert left.significant
    assert left.travel_line is not None
    assert left.noise_rms < 0.9 * np.sqrt(np.mean(chatter**2))


def test_a_hum_is_no_tooth(problem: Problem) -> None:
    """Where the speed hardly changes it is a line over travel, too: the one in time comes first."""
    hum = 3.0 * np.sin(2 * np.pi * 50.0 * problem.block.signals.t) + noise(problem, 0.0, 7)
    left = lack_of_fit_test(problem, hum)
    assert left.hum is not None
    assert left.travel_line is None
    assert not left.significant


def test_a_log_at_rest_or_of_few_strokes_has_none(problem: Problem) -> None:
    still = problem.recording.window(slice(0, 20), names=("short",))
    short = prepare(still)
    assert travel_line(short, np.ones(20)) is None
