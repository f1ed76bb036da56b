"""The paper's model at its best, and the noise that misfit is measured by."""

from __future__ import annotations

import numpy as np
import pytest
from plant_rig import ACTING, DAMPER, campaign, effect, hidden, over, plain, rms, samples

from erdctl.plant.noise import ForceNoise, MotionNoise, draw_force_noise, draw_motion_noise
from erdctl.plant.refit import predicted, refit, shape_of
from erdctl.plant.simulate import forces


def test_it_finds_the_plain_damper_again() -> None:
    found = refit(samples(), plain(), [shape_of(DAMPER) + 0.5, shape_of(DAMPER) - 0.5])
    assert found.rms < 1e-4 * np.ptp(plain())
    for side, expected in zip(found.plant[:2], DAMPER[:2], strict=True):
        np.testing.assert_allclose(side, expected, rtol=2e-3)


def test_prediction_is_the_plain_plant() -> None:
    apart = predicted(samples(), DAMPER) - plain()
    assert rms(apart) < 1e-5 * np.ptp(plain())


@pytest.mark.parametrize("name", ACTING)
def test_it_absorbs_a_part_and_never_adds(name: str) -> None:
    plant = hidden(name, effect(name).start)
    force = forces(plant, over())
    found = refit(samples(), force, [shape_of(DAMPER)])
    assert found.rms <= rms(force - forces(plant.plain(), over())) * 1.001
    np.testing.assert_allclose(found.force + found.rest, force, atol=1e-9 * np.ptp(force))


@pytest.mark.parametrize("colour", ["white", "ar1", "pink"])
def test_force_noise_has_its_rms_and_colour(colour: str) -> None:
    noise = ForceNoise(colour, 0.95, 0.01, 0.0, 50.0).scaled(200.0)
    n = noise.at(np.random.default_rng(3), [20_000, 30_000], 500.0)
    assert noise.rms == pytest.approx(2.0)
    assert rms(n) == pytest.approx(2.0)
    lag_1 = float(np.corrcoef(n[:-1], n[1:])[0, 1])
    low, high = {"white": (-0.03, 0.03), "ar1": (0.93, 0.97), "pink": (0.5, 0.99)}[colour]
    assert low < lag_1 < high


def test_a_mains_line_is_a_part_of_the_noise() -> None:
    noise = ForceNoise("white", 0.95, 0.01, 0.1, 50.0).scaled(100.0)
    n = noise.at(np.random.default_rng(3), [50_000], 500.0)
    spectrum = np.abs(np.fft.rfft(n)) ** 2
    line = spectrum[np.argmin(np.abs(np.fft.rfftfreq(50_000, 1 / 500) - 50.0))] / spectrum.sum()
    assert line == pytest.approx(0.1, rel=0.05)
    assert rms(n) == pytest.approx(1.0)


def test_noise_is_a_small_part_of_the_range() -> None:
    drawn = [draw_force_noise(np.random.default_rng(s)) for s in range(200)]
    assert all(0.003 <= n.fraction <= 0.02 for n in drawn)
    assert {n.colour for n in drawn} == {"white", "ar1", "pink"}
    assert all(0.9 <= n.rho <= 0.99 for n in drawn)
    assert drawn[0].scaled(1.0, 100.0).fraction == 0.02


@pytest.mark.parametrize("kind", ["savgol", "difference"])
def test_measured_motion_turns_at_the_wrong_sample_at_times(kind: str) -> None:
    noise = MotionNoise(kind, 2e-6, 5e-6, 15, 30.0)
    random = np.random.default_rng(1)
    wrong, errors = [], []
    for ride in over():
        _, x, v = ride.sampled()
        read, speed = noise.at(random, x, v, ride.record.rate)
        assert np.abs(read - x).max() < 2e-5
        np.testing.assert_allclose(read / 5e-6, np.round(read / 5e-6), atol=1e-6)
        errors.append(rms(speed - v) / rms(v))
        wrong.append(np.mean(speed * v < 0))
    assert 0 < np.mean(wrong) < 0.01
    assert 0 < max(errors) < 0.06
    _, x, v = over()[0].sampled()
    exact = MotionNoise("exact", 2e-6, 5e-6, 15, 30.0).at(random, x, v, 250.0)
    assert exact[0] is x
    assert exact[1] is v


def test_half_of_the_logs_have_measured_motion() -> None:
    kinds = [draw_motion_noise(np.random.default_rng(s), campaign()).kind for s in range(300)]
    assert 0.4 < kinds.count("exact") / 300 < 0.6
    assert draw_motion_noise(np.random.default_rng(0), campaign(), "exact").kind == "exact"
    assert draw_motion_noise(np.random.default_rng(0), campaign(), "measured").kind != "exact"
