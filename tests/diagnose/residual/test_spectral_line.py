"""A hum of the force channel is named at every rate of the samples, and noise has none."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import trajectories
from rig import recording

from erdctl.core.recording import Array, concatenate
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.spectral_line import spectral_lines

RATES = [95.0, 100.0, 120.0, 125.0, 128.0, 200.0, 256.0, 500.0, 1000.0]
BEYOND = 8.0  # Hz, what the motion below does not reach


@cache
def problem(rate: float) -> Problem:
    """Four records, none as long as another."""
    out = []
    for i in range(4):
        t = np.arange(round((9.0 + 1.7 * i) * rate)) / rate
        m = trajectories.sine(0.7 + 0.4 * i, 0.012 - 0.002 * i, 0.4 * i)
        duty = trajectories.random_hold(np.random.default_rng(i), t, (0.0, 0.2, 0.4))
        out.append(recording(t, m.x(t), m.velocity(t), duty, f"{i}", m.velocity_at))
    return prepare(concatenate(out))


def white(at: Problem, seed: int) -> Array:
    return np.random.default_rng(seed).normal(size=len(at.block.force))


def aliased(frequency: float, rate: float) -> float:
    return abs(frequency - rate * round(frequency / rate))


PAIRS = [(r, m) for r in RATES for m in (50.0, 60.0, 100.0) if aliased(m, r) > BEYOND]


@pytest.mark.few(10)
@pytest.mark.parametrize(("rate", "mains"), PAIRS)
def test_at_every_rate(rate: float, mains: float) -> None:
    """Sampled at twice its frequency it is the last of the spectrum, where none was found."""
    at, line = problem(rate), aliased(mains, rate)
    for seed in range(5):
        noise, phase = white(at, seed), np.random.default_rng(seed).uniform(0.4, 2.7)
        hum = 2.0 * np.sqrt(2.0) * np.sin(2.0 * np.pi * mains * at.block.signals.t + phase)
        turned, found = spectral_lines(at, noise + hum)
        assert turned is None
        assert found is not None
        assert found.frequency == pytest.approx(line, abs=0.1)
        square = np.mean(hum**2)
        assert found.share == pytest.approx(square / (square + 1.0), abs=0.03)


@pytest.mark.parametrize("rate", RATES)
def test_a_swing_of_the_yield_force_turns_over(rate: float) -> None:
    at = problem(rate)
    for frequency in (0.23 * rate, 0.5 * rate):
        swing = 2.0 * np.cos(2.0 * np.pi * frequency * at.block.signals.t)
        turned, found = spectral_lines(at, white(at, 7) + swing * at.block.signals.sign)
        assert found is None
        assert turned is not None
        assert turned.frequency == pytest.approx(frequency, abs=0.1)


@pytest.mark.parametrize("rate", RATES)
def test_noise_has_none(rate: float) -> None:
    for seed in range(20):
        assert spectral_lines(problem(rate), white(problem(rate), 100 + seed)) == (None, None)
