"""Acceleration: exact for a straight line, and what the window costs a sine."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, sine, unit_forces

from erdctl.core.signals import HALF_CUBIC


def test_check_value() -> None:
    t = np.arange(100) * 1e-3
    assert 2.0 * unit_forces("fluid_inertia", signals(0.5 * t, t=t), {}) == pytest.approx(
        np.ones((1, 100))
    )


def test_uneven_steps_and_records() -> None:
    rng = np.random.default_rng(3)
    t = np.cumsum(rng.uniform(5e-4, 2e-3, 200))
    rising = np.where(np.arange(200) < 120, 3.0, -7.0)
    s = signals(rising * t, t=t, starts=[0, 120, 199, 200])
    assert s.xddot[:199] == pytest.approx(rising[:199])
    assert s.xddot[199] == 0.0  # a record of one sample has no acceleration


@pytest.mark.parametrize("frequency", [1.0, 7.0])
def test_a_sine_passes_the_window(frequency: float) -> None:
    s = sine(frequency, 0.01, 2.0, 1000.0)
    w = 2 * np.pi * frequency
    # What a cubic cannot follow begins with the fifth power: over h the part (w h)^4 / 504.
    expected = -(w**2) * s.x * (1.0 - (w * HALF_CUBIC) ** 4 / 504.0)
    inner = slice(20, -20)
    assert s.xddot[inner] == pytest.approx(expected[inner], abs=2e-4 * w**2 * 0.01)


def test_noise_is_averaged() -> None:
    noise = 1e-3 * np.random.default_rng(1).standard_normal(4000)
    slope = signals(noise, step=1e-3).xddot
    u = np.arange(-20, 21)
    squares = np.linalg.inv([[np.sum(u**2), np.sum(u**4)], [np.sum(u**4), np.sum(u**6)]])
    assert slope[20:-20].std() == pytest.approx(np.sqrt(squares[0, 0]), rel=0.1)
