"""The better velocity reaches to the ends of a record."""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import signals

from erdctl.effects.velocity_noise import velocity_noise


def record(late: float, noise: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Deflection, its true velocity and the logged one, of 3 s at 400 Hz."""
    t, w = np.arange(1200) / 400.0, 2 * np.pi * 2.3
    logged = 0.02 * w * np.cos(w * (t - late))
    logged += noise * np.random.default_rng(7).standard_normal(len(t))
    return 0.02 * np.sin(w * t), 0.02 * w * np.cos(w * t), logged


@pytest.mark.parametrize("end", [slice(1, 40), slice(-40, -1)])
def test_a_late_velocity_is_mended_at_the_ends(end: slice) -> None:
    x, true, logged = record(late=0.004, noise=0.0)
    better = velocity_noise(signals(logged, x=x, step=1 / 400.0), {"w": 1.0}).xdot
    assert np.abs(better - true)[end].max() < 0.06 * np.abs(logged - true)[end].max()


@pytest.mark.parametrize("end", [slice(1, 40), slice(-40, -1)])
def test_a_noisy_velocity_is_mended_at_the_ends(end: slice) -> None:
    x, true, logged = record(late=0.0, noise=0.01)
    better = velocity_noise(signals(logged, x=x, step=1 / 400.0), {"w": 1.0}).xdot
    assert np.std((better - true)[end]) < 0.2 * np.std((logged - true)[end])


def test_a_deflection_too_coarse_for_slopes_over_few_samples_leaves_the_ends() -> None:
    """Steps of 0.2 mm are 0.04 m/s from sample to sample: worse than what they were to mend."""
    x, _, logged = record(late=0.0005, noise=0.0)
    coarse = np.round(x / 2e-4) * 2e-4
    better = velocity_noise(signals(logged, x=coarse, step=1 / 400.0), {"w": 1.0}).xdot
    assert (better[:2] == logged[:2]).all()


@pytest.mark.parametrize("samples", [90, 160, 400])
def test_a_short_record_has_a_better_velocity_too(samples: int) -> None:
    """A log of short records was left with its late velocity, and its stiffness 5 % low."""
    x, true, logged = (c[:samples] for c in record(late=0.002, noise=0.002))
    better = velocity_noise(signals(logged, x=x, step=1 / 400.0), {"w": 1.0}).xdot
    inner = slice(20, -20)
    assert np.std((better - true)[inner]) < 0.3 * np.std((logged - true)[inner])


def test_slopes_of_a_smooth_chirp_do_not_follow_what_is_late() -> None:
    """Their differences are tiny and could make up any curve, with weights of thousands."""
    t, late = np.arange(540) / 100.0, 0.004
    phase, rate = 2 * np.pi * (0.3 * t + 0.35 * t**2), 2 * np.pi * (0.3 + 0.7 * t)
    x, true = 0.01 * np.sin(phase), 0.01 * rate * np.cos(phase)
    logged = np.interp(t - late, t, true) + 5e-4 * np.random.default_rng(3).standard_normal(len(t))
    better = velocity_noise(signals(logged, x=x, step=0.01), {"w": 1.0}).xdot
    inner, slope = slice(60, -60), np.gradient(true, t)

    def lag(v: np.ndarray) -> float:
        a = slope[inner]
        return float(-np.dot((v - true)[inner], a) / np.dot(a, a))

    assert lag(logged) == pytest.approx(late, rel=0.1)
    assert abs(lag(better)) < 0.25 * late


def test_the_first_and_the_last_sample_go_on_as_fast_as_their_neighbours_say() -> None:
    x, true, logged = record(late=0.004, noise=0.0)
    better = velocity_noise(signals(logged, x=x, step=1 / 400.0), {"w": 1.0}).xdot
    assert (np.abs(better - true) < 0.1 * np.abs(logged - true).max())[[0, -1]].all()
