"""Twins that bring their own physics, each against a solution by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from plant_rig import DAMPER, RATE, constant, effect, hidden, over, record, rms, scales, sine

from erdctl.plant import DutyProgramme, Plant, Side, draw, log, simulate
from erdctl.plant.own import velocity
from erdctl.plant.simulate import forces, ride
from erdctl.plant.twins import (
    field_viscosity,
    force_offset,
    force_smoothing,
    gas_thermal_drift,
    power_law_yield,
    preyield_elasticity,
    preyield_field_dependence,
    velocity_noise,
)

F, A = 1.25, 0.01  # Hz, m
SPRING = Plant(*[Side(k_nom=1000.0, c_vis=0.0, T_d=0.02, sigma=0.0, beta=1.0)] * 2)
BINGHAM = Plant(*[Side(k_nom=0.0, c_vis=0.0, T_d=0.02, sigma=20.0, beta=1.0)] * 2)
TONE = record(sine(F, A), constant(1.0), seconds=6.0)


def test_the_yield_force_goes_with_a_power_of_speed_above_the_knee() -> None:
    plant = BINGHAM.with_own(power_law_yield.HOOKS, n=0.5, v_0=0.04, v_k=1e-6)
    _, _, v = ride(TONE).sampled()
    force = simulate(plant, TONE)
    np.testing.assert_allclose(force, 20 * np.sign(v) * np.sqrt(np.abs(v) / 0.04), rtol=1e-4)


@pytest.mark.parametrize("n", [0.05, 0.1, 0.3, 1.0])
def test_no_drawn_knee_is_an_effect_of_its_own(n: float) -> None:
    """Where one was as high as 3 % of n times the top speed it was named, as yielding there."""
    speed, highest = 2 * math.pi * F * A, power_law_yield.TWIN.shape["knee"][1]
    law = {"n": n, "v_0": 0.5 * speed}
    sharp = simulate(BINGHAM.with_own(power_law_yield.HOOKS, **law, v_k=1e-9), TONE)
    drawn = BINGHAM.with_own(power_law_yield.HOOKS, **law, v_k=highest * n * speed)
    assert np.std(simulate(drawn, TONE) - sharp) < 0.002 * np.std(sharp)


def test_and_creeps_like_a_viscous_fluid_below_it() -> None:
    plant = BINGHAM.with_own(power_law_yield.HOOKS, n=0.5, v_0=0.04, v_k=10.0)
    _, _, v = ride(TONE).sampled()
    slope = 20 * math.sqrt(10.0 / 0.04) / 10.0
    np.testing.assert_allclose(simulate(plant, TONE), slope * v, rtol=1e-3, atol=1e-9)


def test_chains_stretch_before_they_break() -> None:
    """After a turn q = mean of max(1 - u / d_j, -1), u the way back; before it all are broken."""
    x_y = 0.002
    plant = BINGHAM.with_own(preyield_elasticity.HOOKS, x_y=x_y)
    _, x, v = ride(TONE).sampled()
    force = simulate(plant, TONE)
    breaks = x_y * np.arange(0.1, 2.0, 0.2)
    late = np.arange(len(x)) > RATE / F
    gone = (x.max() - x)[late & (v < 0)]  # the top is within 1e-3 of the highest sample
    q = np.maximum(1 - gone[:, None] / breaks, -1.0).mean(axis=1)
    np.testing.assert_allclose(force[late & (v < 0)], 20 * q, atol=0.15)
    assert force[late & (v < 0)].min() == pytest.approx(-20.0)


@pytest.mark.parametrize("window", [0.02, 0.1, 0.4])
def test_an_average_over_a_part_of_the_cycle_shrinks_a_sine(window: float) -> None:
    """sinc(w) sinc(w/4) of it is left, where the windows are inside the record."""
    plant = SPRING.with_own(force_smoothing.HOOKS, window=window)
    _, x, _ = ride(TONE).sampled()
    left = np.sinc(window) * np.sinc(window / 4)
    inside = slice(round(RATE / F), -round(RATE / F))
    np.testing.assert_allclose(
        simulate(plant, TONE)[inside], 1000 * left * x[inside], atol=1e-3 * 1000 * A
    )
    assert simulate(plant, TONE)[0] == pytest.approx(1000 * x[0])


def test_a_jump_becomes_a_slope_with_rounded_ends() -> None:
    w = 0.1
    plant = BINGHAM.with_own(force_smoothing.HOOKS, window=w)
    t, _, v = ride(TONE).sampled()
    since = t - (1.5 * math.pi - 0.3) / (2 * math.pi * F) - 1 / F  # from a turn upwards
    width = w / F
    middle = np.abs(since) < 0.3 * width
    force = simulate(plant, TONE)
    np.testing.assert_allclose(force[middle], 40 * since[middle] / width, atol=0.05)
    assert np.all(np.diff(force[np.abs(since) < 0.6 * width]) > 0)
    assert force[np.abs(since) < width].max() == pytest.approx(20.0, abs=1e-6)
    assert v[middle][-1] > 0 > v[middle][0]


def test_a_record_that_does_not_turn_is_not_smoothed() -> None:
    slow = record(sine(0.02, A, -0.5), constant(1.0), seconds=2.0)
    smooth = simulate(DAMPER.with_own(force_smoothing.HOOKS, window=0.3), slow)
    np.testing.assert_array_equal(smooth, simulate(DAMPER, slow))


def test_a_zero_error_is_a_constant() -> None:
    plant = DAMPER.with_own(force_offset.HOOKS, zero=-0.5)
    np.testing.assert_allclose(simulate(plant, TONE), simulate(DAMPER, TONE) - 0.5)


def test_chains_thicken_the_fluid_within_their_time() -> None:
    """c v (1 + s (U/U_top)^k (1 - exp(-t/T))) after a step from no field."""
    at, T = 500, 0.05
    dashpot = Plant(*[Side(k_nom=0.0, c_vis=100.0, T_d=0.02, sigma=0.0, beta=1.0)] * 2)
    plant = dashpot.with_own(field_viscosity.HOOKS, growth=2.0, top=0.4, power=1.5, chains=T)
    tone = record(sine(F, A), DutyProgramme((0.0, 0.2), (0, at)), seconds=6.0)
    t, _, v = ride(tone).sampled()
    grown = np.where(t > t[at], 1 - np.exp(-(t - t[at]) / T), 0.0)
    expected = 100 * v * (1 + 2 * 0.5**1.5 * grown)
    np.testing.assert_allclose(simulate(plant, tone), expected, rtol=1e-6, atol=1e-9)


def test_the_gas_warms_by_the_work_done() -> None:
    """A dashpot: T' = heating c v^2 - cooling T, and F_g T / T_0 more force."""
    c, heating, cooling = 400.0, 2.0, 0.3
    dashpot = Plant(*[Side(k_nom=0.0, c_vis=c, T_d=0.02, sigma=0.0, beta=1.0)] * 2)
    plant = dashpot.with_own(gas_thermal_drift.HOOKS, static=30.0, heating=heating, cooling=cooling)
    t, _, v = ride(TONE).sampled()
    gained = simulate(plant, TONE) - c * v
    whole = slice(round(RATE / F), None, round(RATE / F))  # once a cycle, the power is its mean
    mean = heating * c * (2 * math.pi * F * A) ** 2 / 2
    expected = 30.0 / 293.0 * mean / cooling * (1 - np.exp(-cooling * t))
    np.testing.assert_allclose(gained[whole], expected[whole], rtol=0.04)
    assert gained[0] == 0.0


def test_the_knee_of_a_creeping_fluid_goes_with_the_field() -> None:
    plant = BINGHAM.with_own(preyield_field_dependence.HOOKS, v_k=0.05, top=1.0, q=1.0)
    half = record(sine(F, A), constant(0.5), seconds=6.0)
    _, _, v = ride(half).sampled()
    force = simulate(plant, half)
    slow = np.abs(v) < 2e-3
    np.testing.assert_allclose(force[slow], 10 * v[slow] / 0.025, rtol=5e-3, atol=1e-6)
    assert np.abs(force).max() == pytest.approx(10.0, rel=2e-3)


def test_a_velocity_channel_is_noisy_and_late_and_the_force_is_not() -> None:
    plant = DAMPER.with_own(velocity_noise.HOOKS, noise=1e-3, samples=0.4, draw=7.0)
    np.testing.assert_array_equal(simulate(plant, TONE), simulate(DAMPER, TONE))
    _, _, v = ride(TONE).sampled()
    late = np.append(v[:1], 0.6 * v[1:] + 0.4 * v[:-1])
    noise = velocity(plant.own, v, 0) - late
    assert rms(noise) == pytest.approx(1e-3, rel=0.05)
    other = velocity(plant.own, v, 1) - late
    assert abs(np.corrcoef(noise, other)[0, 1]) < 0.1


def test_the_log_of_a_case_has_the_velocity_of_its_channel() -> None:
    case = draw(7399, effects=["velocity_noise"], level=1.0, motion="exact")
    table = log(case)
    v = np.concatenate([ride(r).sampled()[2] for r in case.campaign.records])
    found = rms(table["xdot"].to_numpy() - v)
    noise = dict(case.plant.own[0].values)["noise"]
    assert noise < found < 2.0 * noise  # and the delay
    assert case.truth[0].parameters["noise"] == (noise, "m/s")


@pytest.mark.parametrize("name", ["power_law_yield", "preyield_elasticity"])
def test_play_is_taken_up_before_the_law_sees_the_piston(name: str) -> None:
    """A piston that rests in its play bears no yield force but what is stretched."""
    both = hidden(name, effect(name).start).with_physics(gap=0.3 * scales().x)
    alone = DAMPER.with_physics(gap=0.3 * scales().x)
    gone = rms(forces(both, over()) - forces(alone, over()))
    assert 0.01 * rms(forces(alone, over())) < gone < rms(forces(alone, over()))
