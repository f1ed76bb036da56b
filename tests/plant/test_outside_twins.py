"""Twins of what the catalogue does not hold, each against a solution by hand."""

from __future__ import annotations

import numpy as np
import pytest
from plant_rig import DAMPER, UNKNOWN, effect, record, scales, sine

from erdctl.model.learned.coordinates import KINDS
from erdctl.model.learned.law import LawSlot
from erdctl.plant import DutyProgramme, Plant, Side, draw, key, simulate
from erdctl.plant.simulate import ride
from erdctl.plant.twins import (
    bent_linkage,
    chain_ageing,
    eccentric_electrodes,
    flow_discharge,
    gas_loss,
    oil_sloshing,
    remanent_field,
    slow_chains,
    sticking_after_turns,
    stroke_softening,
    swarming,
)

BINGHAM = Plant(*[Side(k_nom=0.0, c_vis=0.0, T_d=0.0, sigma=20.0, beta=1.0)] * 2)
SPRING = Plant(*[Side(k_nom=1000.0, c_vis=50.0, T_d=0.0, sigma=0.0, beta=1.0)] * 2)
F, A = 1.25, 0.01  # Hz, m
STEPS = DutyProgramme((0.2, 0.8, 0.4), (0, 400, 800))
TONE = record(sine(F, A), STEPS, seconds=5.0)
T, X, V = ride(TONE).sampled()
DUTY = STEPS.levels[0] * (T * 250 < 400 - 0.5) + 0.8 * ((T * 250 > 399.5) & (T * 250 < 799.5))
DUTY = np.where(T * 250 > 799.5, 0.4, DUTY)
YIELD = 20.0 * DUTY * np.sign(V)
# Duty is that of the step before a sample, so that the samples next to a step are left out.
STEADY = np.abs(T[:, None] * 250 - np.array([400, 800])).min(axis=1) > 1.5
STEADY &= np.abs(V) > 1e-3


def close(force: np.ndarray, expected: np.ndarray, within: float = 1e-6) -> None:
    np.testing.assert_allclose(force[STEADY], expected[STEADY], atol=within)


def test_the_packing_loosens_with_the_largest_stroke() -> None:
    plant = BINGHAM.with_own(stroke_softening.HOOKS, loss=0.5, span=A, power=1.0)
    largest = np.maximum.accumulate(np.abs(X))
    close(simulate(plant, TONE), YIELD * (1.0 - 0.5 * largest / A), 1e-3)


def test_a_charge_stays_behind_the_highest_duty() -> None:
    plant = BINGHAM.with_own(remanent_field.HOOKS, force=3.0, top=0.8)
    highest = np.maximum.accumulate(DUTY)
    close(simulate(plant, TONE), YIELD + 3.0 * highest / 0.8 * np.sign(V))


def test_chains_thicken_while_the_field_stands() -> None:
    plant = BINGHAM.with_own(chain_ageing.HOOKS, growth=0.5, time=0.3)
    at = T - np.select([T * 250 > 799.5, T * 250 > 399.5], [3.2, 1.6], -np.inf)
    close(simulate(plant, TONE), YIELD * (1.0 + 0.5 * (1.0 - np.exp(-at / 0.3))), 0.02)


def test_the_gap_closes_towards_one_end() -> None:
    plant = BINGHAM.with_own(eccentric_electrodes.HOOKS, pull=0.4, span=A, top=0.8)
    close(simulate(plant, TONE), YIELD * (1.0 + 0.4 * X / A * DUTY / 0.8))


def test_particles_swarm_in_a_slow_flow() -> None:
    plant = SPRING.with_own(swarming.HOOKS, growth=2.0, top=0.8, speed=0.03)
    swarm = 1.0 + 2.0 * DUTY / 0.8 * np.exp(-np.abs(V) / 0.03)
    close(simulate(plant, TONE), 1000.0 * X + 50.0 * V * swarm)


def test_the_flow_carries_charge_away() -> None:
    plant = BINGHAM.with_own(flow_discharge.HOOKS, loss=0.5, speed=0.1)
    close(simulate(plant, TONE), YIELD * (1.0 - 0.5 * np.abs(V) / 0.1), 0.02)


def test_a_linkage_bends_the_stroke() -> None:
    plant = SPRING.with_own(
        bent_linkage.HOOKS, bend=0.2, span=A, k_c=1000.0, k_r=1000.0, c_c=50.0, c_r=50.0
    )
    more = 0.2 * A * np.sin(0.5 * np.pi * X / A)
    faster = np.gradient(more, T)
    close(simulate(plant, TONE), 1000.0 * (X + more) + 50.0 * (V + faster), 0.02)


def test_gas_escapes_with_the_travel() -> None:
    plant = SPRING.with_own(gas_loss.HOOKS, loss=0.5, travel=0.1, k_c=1000.0, k_r=1000.0)
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(X)))])
    left = 1.0 - 0.5 * (1.0 - np.exp(-way / 0.1))
    close(simulate(plant, TONE), 1000.0 * X * left + 50.0 * V, 0.02)


def test_a_seal_sticks_after_each_turn_and_not_before_the_first() -> None:
    plant = BINGHAM.with_own(sticking_after_turns.HOOKS, force=5.0, time=0.05)
    more = (simulate(plant, TONE) - simulate(BINGHAM, TONE)) * np.sign(V)
    turns = (np.pi / 2 - 0.3 + np.pi * np.arange(20)) / (2 * np.pi * F)
    turns = turns[turns > 0.0]
    since = T - turns[np.maximum(np.searchsorted(turns, T, side="right") - 1, 0)]
    expected = np.where(turns[0] > T, 0.0, 5.0 * np.exp(-since / 0.05))
    close(more, expected, 0.05)


def test_oil_sloshes_at_its_own_frequency() -> None:
    """Long after the start, as a sine does: y = a w |v| / |w^2 - W^2 + 2 i d w W|."""
    rate, damping, speed = 3.0, 0.2, 2 * np.pi * F * A
    plant = SPRING.with_own(oil_sloshing.HOOKS, force=4.0, rate=rate, damping=damping, speed=speed)
    more = simulate(plant, TONE) - simulate(SPRING, TONE)
    w, W = 2 * np.pi * rate, 2 * np.pi * F
    size = 4.0 * w * W / abs(w**2 - W**2 + 2j * damping * w * W)
    late = T > 3.0
    assert np.abs(more[late]).max() == pytest.approx(size, rel=0.02)
    assert more[0] == 0.0


def test_chains_form_more_slowly_in_a_weak_field() -> None:
    """After a step from 0.2 to 0.8 the time constant is T (1 + s (1 - 0.8 / 0.8)) = T."""
    side = Side(k_nom=0.0, c_vis=0.0, T_d=0.1, sigma=20.0, beta=1.0)
    base = Plant(side, side)
    plant = base.with_own(
        slow_chains.HOOKS, slower=2.0, top=0.8, T_c=0.1, T_r=0.1, sigma_c=20.0, sigma_r=20.0,
        beta_c=1.0, beta_r=1.0,
    )  # fmt: skip
    forward = record(sine(0.02, 0.1, 0.0), STEPS, seconds=5.0)  # never turns
    force, t = simulate(plant, forward), ride(forward).sampled()[0]
    rise, fall = (t > 1.65) & (t < 3.15), t > 3.25
    up = 20.0 * (0.8 - 0.6 * np.exp(-(t - 1.6) / 0.1))
    down = 20.0 * (0.4 + 0.4 * np.exp(-(t - 3.2) / 0.2))
    np.testing.assert_allclose(force[rise], up[rise], rtol=0.01)
    np.testing.assert_allclose(force[fall], down[fall], rtol=0.01)


@pytest.mark.parametrize("name", UNKNOWN)
def test_a_law_is_a_number_beyond_what_it_was_drawn_for(name: str) -> None:
    """Fresh records go beyond the stroke, the speed and the duty of the log."""
    e = effect(name)
    shape = {k: b for k, (_, b) in e.shape.items()}
    plant = e.build(DAMPER, e.high, shape, scales())
    force = simulate(plant, record(sine(2.0, 0.025), DutyProgramme((0.9, 0.0), (0, 300))))
    assert np.abs(force).max() < 1e6


@pytest.mark.parametrize("name", UNKNOWN)
def test_a_law_lies_where_one_can_be_learned(name: str) -> None:
    lies = effect(name).lies
    if lies is not None:
        for slot, coordinates in [(lies.slot, lies.coordinates), *lies.alike]:
            assert slot in list(LawSlot)
            assert set(coordinates) <= set(KINDS)


def test_enough_kinds_lie_somewhere_in_every_slot() -> None:
    lies = [effect(name).lies for name in UNKNOWN]
    assert sum(found is not None for found in lies) >= 16
    slots = {found.slot for found in lies if found is not None}
    assert slots >= {"force", "friction", "yield", "viscous", "gas", "lag", "duty", "deflection"}
    assert sum(len(found.coordinates) == 2 for found in lies if found is not None) >= 2


def test_the_key_says_where() -> None:
    case = draw(3, known=(), effects=["remanent_field"], kind="unknown")
    (said,) = key(case)["effects"]
    assert said["lies"] == {
        "slot": "friction", "coordinates": ["largest_duty"], "curve": "B z/U", "alike": [],
    }  # fmt: skip
