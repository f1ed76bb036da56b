"""Acceleration: exact for a straight line, and what window and memory cost a sine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made import signals, sine, unit_forces

from erdctl.core.acceleration import HALF_CUBIC
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.effects.fluid_inertia import MEMORY


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


@pytest.mark.parametrize(("frequency", "noise"), [(1.0, 0.0), (7.0, 0.0), (7.0, 5e-3)])
def test_a_sine_passes_the_window(frequency: float, noise: float) -> None:
    s = sine(frequency, 0.01, 2.0, 1000.0)
    w = 2 * np.pi * frequency
    rough = noise * np.random.default_rng(2).standard_normal(len(s))
    found = s.with_motion(s.x, s.xdot + rough).xddot[20:-20]
    # What a cubic cannot follow begins with the fifth power: over h the part (w h)^4 / 504. Without
    # noise h need not be wide.
    passed = np.dot(found, s.x[20:-20]) / np.dot(s.x[20:-20], -(w**2) * s.x[20:-20])
    lost = (w * HALF_CUBIC) ** 4 / 504.0
    assert passed == pytest.approx(1.0 - (lost if noise else 0.0), abs=1e-3 if noise else 1e-6)


def test_a_stroke_that_turns_fast_has_its_whole_acceleration() -> None:
    """A triangle of 5 mm at 1 Hz, whose ends are round for 20 ms."""
    t, reach = np.arange(2000) / 500.0, 10
    ideal = 0.02 * np.where((t + 0.25) % 1.0 < 0.5, 1.0, -1.0)
    window = np.hanning(2 * reach + 1)
    speed = np.convolve(ideal, window / window.sum(), mode="same")
    exact = np.convolve(np.diff(ideal, prepend=ideal[0]) * 500.0, window / window.sum(), "same")
    inner = slice(50, -50)
    slope = signals(speed, t=t).xddot[inner]
    expected = 0.5 * (exact[inner] + exact[51:-49])  # a difference lies half a step before
    assert np.dot(slope, expected) / np.dot(expected, expected) == pytest.approx(1.0, abs=0.01)


def test_some_of_the_samples_have_the_acceleration_of_all() -> None:
    s = sine(7.0, 0.01, 2.0, 500.0)
    rows = np.arange(0, 1000, 10)
    some = replace(s, t=s.t[rows], x=s.x[rows], xdot=s.xdot[rows], duty=s.duty[rows],
                   step=np.append(np.full(99, 0.02), 0.0), starts=np.array([0, 100]),
                   sampled=(s, rows))  # fmt: skip
    assert (some.xddot == s.xddot[rows]).all()
    moved = some.with_motion(some.x, 0.5 * some.xdot)
    assert np.abs(moved.xddot).max() < 0.6 * np.abs(some.xddot).max()


def test_noise_is_averaged() -> None:
    noise = 1e-3 * np.random.default_rng(1).standard_normal(4000)
    slope = signals(noise, step=1e-3).xddot
    u = np.arange(-20, 21)
    squares = np.linalg.inv([[np.sum(u**2), np.sum(u**4)], [np.sum(u**4), np.sum(u**6)]])
    assert slope[20:-20].std() == pytest.approx(np.sqrt(squares[0, 0]), rel=0.1)


def past(s: Signals) -> Array:
    """(n,) acceleration as `simulate` has it, of 1 kg."""
    return get("fluid_inertia").past_alone().added(s, {})[0]


def test_the_past_alone_is_exact_for_a_line_at_any_steps() -> None:
    rng = np.random.default_rng(5)
    t = np.cumsum(10.0 ** rng.uniform(-5, -1.5, 300))
    rising = np.where(np.arange(300) < 180, 3.0, -7.0)
    s = signals(rising * t, t=t, starts=[0, 180, 299, 300])
    first = s.starts[:-1]
    assert past(s)[first].tolist() == [0.0, 0.0, 0.0]  # nothing is known of a slope yet
    rest = np.delete(np.arange(300), first)
    assert past(s)[rest] == pytest.approx(rising[rest], rel=1e-6)


def test_the_past_alone_follows_a_cubic_without_delay() -> None:
    """It has forgotten its start after 20 memories."""
    t = np.arange(2000) * 1e-4
    bends = 5.0 + 40.0 * t - 900.0 * t**2
    s = signals(5.0 * t + 20.0 * t**2 - 300.0 * t**3, t=t)
    assert past(s)[600:] == pytest.approx(bends[600:], abs=1e-3)


@pytest.mark.parametrize(("frequency", "gain"), [(7.0, 0.0022), (10.0, 0.0082), (20.0, 0.094)])
def test_a_sine_passes_the_memory(frequency: float, gain: float) -> None:
    """(q + q^2 + q^3 - 3 q^4) / T at i w, beside i w itself."""
    s = sine(frequency, 0.01, 2.0, 10000.0)
    w = 2 * np.pi * frequency
    q = 1j * w * MEMORY / (1.0 + 1j * w * MEMORY)
    passed = (q + q**2 + q**3 - 3.0 * q**4) / (1j * w * MEMORY)
    assert abs(passed) - 1.0 == pytest.approx(gain, abs=1e-3)
    late = np.interp(s.t + np.angle(passed) / w, s.t, -(w**2) * s.x)
    inner = slice(1000, -1000)
    assert past(s)[inner] == pytest.approx(abs(passed) * late[inner], abs=2e-3 * w**2 * 0.01)


def test_noise_in_the_past_alone() -> None:
    noise = 2e-3 * np.random.default_rng(1).standard_normal(20000)
    assert past(signals(noise, step=1e-3))[100:].std() == pytest.approx(0.9, rel=0.1)


def test_nothing_ahead_is_known() -> None:
    rng = np.random.default_rng(6)
    v, other = rng.standard_normal((2, 100))
    other[:60] = v[:60]
    before, after = (past(signals(x, step=1e-3)) for x in (v, other))
    assert np.array_equal(before[:60], after[:60])
    assert not np.array_equal(before[60:], after[60:])


@pytest.mark.parametrize("noise", [0.0, 1e-3])
@pytest.mark.parametrize(
    ("rate", "frequency"),
    [(200.0, 20.0), (250.0, 30.0), (500.0, 15.0), (500.0, 30.0), (2000.0, 20.0)],
)
def test_a_motion_that_is_fast_all_along_keeps_its_acceleration(
    rate: float, frequency: float, noise: float
) -> None:
    """The cubic over 40 ms loses 7 % of 20 Hz and 30 % of 30 Hz, and stood whatever the rate:
    nothing but noise was thought to differ from it all along."""
    s = sine(frequency, 0.002, 4.0, rate)
    w = 2 * np.pi * frequency
    rough = noise * w * 0.002 * np.random.default_rng(2).standard_normal(len(s))
    found, true = (v[50:-50] for v in (s.with_motion(s.x, s.xdot + rough).xddot, -(w**2) * s.x))
    assert np.dot(found, true) / np.dot(true, true) == pytest.approx(1.0, abs=0.01)
    assert np.sqrt(np.mean((found - true) ** 2)) < 0.01 * np.sqrt(np.mean(true**2))


def test_noise_alone_is_averaged_all_along() -> None:
    """Nothing of it is a motion that a wide window would miss."""
    t = np.arange(4000) / 500.0
    rough = np.random.default_rng(5).standard_normal(len(t))
    found = signals(rough, t=t).xddot[50:-50]
    k = np.arange(-10, 11)
    line = np.sqrt(1.0 / np.sum(k**2)) * 500.0  # the noise of the slope of a line as wide
    assert np.std(found) < 3.0 * line  # a cubic has 2.5 times as much
