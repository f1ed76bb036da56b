"""Velocities that are derived of motions with corners."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.direction_of_motion import uncertain
from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals

N = 4000
STARTS: Index = np.array([0, N])
T = np.arange(N) * 1e-3


def triangle(random: np.random.Generator) -> tuple[Array, Array]:
    """Deflection [m], and its velocity, of 10 mm at 1 to 4 Hz."""
    frequency, phase = random.uniform(1.0, 4.0), random.random()
    p = (frequency * T + phase) % 1.0
    return 0.02 * np.abs(p - 0.5) - 0.005, 0.02 * frequency * np.sign(p - 0.5)


def dwells(random: np.random.Generator) -> tuple[Array, Array]:
    """The same of ramps of 0.1 s with rests of 0.15 s between."""
    p = (T + random.random()) % 0.5
    x = np.interp(p, [0.0, 0.1, 0.25, 0.35, 0.5], [0.0, 0.01, 0.01, 0.0, 0.0])
    return x, 0.1 * (np.where(p < 0.1, 1.0, 0.0) - np.where((p > 0.25) & (p < 0.35), 1.0, 0.0))


@pytest.mark.parametrize("noise", [1e-7, 2e-6])
@pytest.mark.parametrize("seed", range(5))
def test_the_direction_of_a_triangle_is_right_to_its_turns(seed: int, noise: float) -> None:
    """The error was 0.082 to 0.142 of the speed, what a window of 20 ms makes of a turn."""
    random = np.random.default_rng(seed)
    x, true = triangle(random)
    xdot, note = derive_xdot(T, x + noise * random.standard_normal(N), STARTS)
    assert "next to corners" in note
    assert np.sqrt(np.mean((xdot - true) ** 2)) < 0.07 * np.std(true)
    assert np.mean(np.sign(xdot) != np.sign(true)) < 0.004


@pytest.mark.parametrize("seed", range(5))
def test_a_rest_between_ramps_has_no_speed(seed: int) -> None:
    random = np.random.default_rng(seed)
    x, true = dwells(random)
    xdot, _ = derive_xdot(T, np.round((x + 1e-6 * random.standard_normal(N)) / 1e-6) * 1e-6, STARTS)
    moving = true != 0.0
    assert np.sqrt(np.mean((xdot - true) ** 2)) < 0.1 * np.std(true)
    assert np.mean(np.sign(xdot[moving]) == np.sign(true[moving])) > 0.98
    # Within half a window of a ramp a rest is told apart from it.
    near = np.convolve(moving, np.ones(15), "same") > 0
    still = ~moving & near
    assert np.mean(xdot[still] == 0.0) > 0.8


@pytest.mark.parametrize("noise", [0.0, 1e-7, 5e-6])
@pytest.mark.parametrize("frequency", [0.5, 3.0, 12.0])
def test_a_smooth_motion_has_no_corner(frequency: float, noise: float) -> None:
    random = np.random.default_rng(7)
    x = 0.01 * np.sin(2.0 * np.pi * frequency * T) + noise * random.standard_normal(N)
    assert "corner" not in derive_xdot(T, x, STARTS)[1]
    steps = 1e-5 * np.round(x / 1e-5)
    assert "corner" not in derive_xdot(T, steps, STARTS)[1]


@pytest.mark.parametrize("clock", ["even", "uneven"])
@pytest.mark.parametrize("noise", [1e-5, 5e-5, 2e-4])
def test_noise_gives_a_rod_at_rest_no_direction(noise: float, clock: str) -> None:
    """Of 0.1 to 2 % of the stroke, of any width of the window: all rests had one, at random."""
    random = np.random.default_rng(int(1e6 * noise))
    t = T + (0.2e-3 * random.uniform(-1.0, 1.0, N) if clock == "uneven" else 0.0)
    x = np.interp(t, [0.0, 1.0, 1.3, 2.0, 2.3, 4.0], [0.0, 0.0, 0.01, 0.01, 0.0, 0.0])
    xdot, _ = derive_xdot(t, x + noise * random.standard_normal(N), STARTS)
    ramps = ((t > 1.0) & (t < 1.3), (t > 2.0) & (t < 2.3))
    moving = ramps[0] | ramps[1]
    assert np.mean(np.sign(xdot[moving]) == np.where(ramps[0], 1.0, -1.0)[moving]) > 0.97
    rest = np.convolve(moving, np.ones(81), "same") == 0
    assert np.mean(xdot[rest] == 0.0) > 0.99


@pytest.mark.parametrize("noise", [1e-6, 1e-5])
def test_a_rest_goes_on_to_the_ramp_beside_it(noise: float) -> None:
    """Windows see a ramp that begins softly half their width before, of a direction of its own."""
    random = np.random.default_rng(9)
    sharp, _ = dwells(random)
    x = np.convolve(np.pad(sharp, 8, mode="edge"), np.full(17, 1.0 / 17.0), "valid")
    true = np.gradient(x, T)
    xdot, _ = derive_xdot(T, x + noise * random.standard_normal(N), STARTS)
    rest = np.abs(true) < 1e-9
    assert np.mean(rest) > 0.4
    assert np.mean(xdot[rest][20:-20] != 0.0) < 0.05


@pytest.mark.parametrize("speed", [1e-4, 1e-3])
def test_what_creeps_keeps_its_direction(speed: float) -> None:
    """As of a test of the friction alone, whose speed a window does not see above the noise."""
    t = np.arange(20_000) * 1e-3
    x = speed * (5.0 - np.abs(t % 10.0 - 5.0))
    noisy = x + 0.02 * speed * np.random.default_rng(2).standard_normal(t.size)
    xdot, _ = derive_xdot(t, noisy, np.array([0, t.size]))
    true = np.where(t % 10.0 < 5.0, 1.0, -1.0)
    assert np.mean(np.sign(xdot) == true) > 0.9
    assert np.mean(xdot == 0.0) < 0.05


@pytest.mark.parametrize("noise", [1e-6, 3e-6])
def test_a_direction_of_a_derived_triangle_is_right_or_uncertain(noise: float) -> None:
    """Up to one turn in 13 was a sample from where it is, and none of these was doubted."""
    wrong = late = doubted = turns = 0
    for seed in range(20):
        random = np.random.default_rng([seed, 3])
        x, true = triangle(random)
        noisy = x + noise * random.standard_normal(N)
        xdot, _ = derive_xdot(T, noisy, STARTS)
        signals = Signals(T, noisy, xdot, np.zeros(N), np.full(N, 1e-3), STARTS, derived=True)
        unsure = uncertain(signals)
        inner = slice(20, -20)  # a turn in the last half of a window is not seen
        other = (np.sign(xdot) != np.sign(true))[inner]
        late += int(np.sum(other))
        wrong += int(np.sum(other & ~unsure[inner]))
        doubted += int(np.sum(unsure))
        turns += int(np.sum(np.diff(np.sign(true)) != 0))
    assert turns > 300
    assert late > 0
    assert wrong == 0
    assert doubted < 5 * turns
