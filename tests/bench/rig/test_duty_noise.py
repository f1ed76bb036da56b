"""A duty that was read back with noise: every sample was a step of the control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rig import TRUTH, campaign, noisy
from seeded import known_before
from test_rig_and_physics import recorded

from erdctl import plant
from erdctl.bench.held_duty import held_duty
from erdctl.bench.rig import look
from erdctl.core.recording import Array, Index
from erdctl.estimate.identify import identify

N = 3000
STARTS: Index = np.array([0, N])
SECONDS = np.arange(N) * 2e-3


def read_back(duty: Array, rms: float, seed: int, counts: bool = False) -> Array:
    """As a voltmeter gives it, of which nothing is below zero."""
    noise = rms * np.random.default_rng(seed).standard_normal(len(duty))
    read = np.round((duty + noise) / rms) * rms if counts else duty + noise
    return np.clip(read, 0.0, 1.0)


@given(
    seed=st.integers(0, 10_000),
    rms=st.floats(1e-4, 4e-3),
    steps=st.integers(0, 60),
    counts=st.booleans(),
)
def test_levels_are_found(seed: int, rms: float, steps: int, counts: bool) -> None:
    random = np.random.default_rng(seed)
    at = np.sort(random.choice(np.arange(1, N // 20), steps, replace=False)) * 20
    levels = 0.05 * random.integers(0, 20, steps + 1)
    duty = np.repeat(levels, np.diff(np.array([0, *at, N])))
    found = held_duty(read_back(duty, rms, seed, counts), STARTS)
    assert found is not None
    assert found.after == np.count_nonzero(np.diff(duty))
    assert np.abs(found.duty - duty).max() < 6.0 * rms / 20**0.5 + (0.5 * rms if counts else 0.0)
    assert not found.duty[duty == 0.0].any()


def test_a_level_that_flickers_now_and_then() -> None:
    duty = np.repeat([0.0, 0.3, 0.8], N // 3)
    flickers = np.random.default_rng(2).random(N) < 0.05
    found = held_duty(np.where(flickers, duty + 1e-3, duty), STARTS)
    assert found is not None
    assert found.after == 2
    assert np.abs(found.duty - duty).max() < 1e-4


def _closed_loop(random: np.random.Generator) -> Array:
    return np.clip(0.3 + 0.4 * np.sin(40.0 * SECONDS) + 0.02 * random.standard_normal(N), 0.0, 1.0)


def _staircase(random: np.random.Generator) -> Array:
    return 0.01 * np.floor(SECONDS / 0.1)


def _switched(random: np.random.Generator) -> Array:
    return np.repeat(random.integers(0, 2, N // 3), 3) * 0.4


MOVING: dict[str, Callable[[np.random.Generator], Array]] = {
    "held": lambda g: np.repeat([0.1, 0.105, 0.6], N // 3),
    "sine": lambda g: 0.5 + 0.4 * np.sin(5.0 * SECONDS),
    "a small sine": lambda g: 0.3 + 0.015 * np.sin(30.0 * SECONDS),
    "a slow ramp": lambda g: SECONDS / 10.0,
    "a ramp in whole steps": lambda g: np.round(SECONDS / 10.0, 3),
    "a sine in whole steps": lambda g: np.round(0.5 + 0.4 * np.sin(5.0 * SECONDS), 2),
    "a ramp with noise": lambda g: SECONDS / 10.0 + 1e-3 * g.standard_normal(N),
    "a sweep": lambda g: 0.5 + 0.02 * np.sin(4.0 * SECONDS**2),
    "a staircase": _staircase,
    "switched at every third sample": _switched,
    "a closed loop": _closed_loop,
    "noise that is the excitation": lambda g: np.clip(g.normal(0.5, 0.1, N), 0.0, 1.0),
}


@pytest.mark.parametrize("control", MOVING.values(), ids=MOVING)
def test_a_control_that_moves_stays_as_it_is(
    control: Callable[[np.random.Generator], Array],
) -> None:
    for seed in range(20):
        assert held_duty(control(np.random.default_rng(seed)), STARTS) is None


@pytest.mark.long
def test_logs_of_the_plant_have_it_where_it_was_put() -> None:
    known = known_before("deflection_offset")
    for seed in range(1760000, 1760004):
        r = recorded(plant.draw(seed, known=known))
        assert held_duty(r.duty, r.starts) is None
        found = held_duty(read_back(r.duty, 2e-3, seed), r.starts)
        assert found is not None
        held = np.concatenate([
            np.full(end - first, np.count_nonzero(np.diff(r.duty[first:end])) * 16 < end - first)
            for first, end in zip(r.starts[:-1], r.starts[1:], strict=True)
        ])  # fmt: skip
        off = np.abs(found.duty - r.duty)[held]
        assert np.mean(off > 2e-3) < 0.01


@pytest.mark.long
def test_fits_take_the_levels() -> None:
    """beta was 0.318 for 0.239, 80 standard errors off: noise at no control was a field."""
    sound = noisy(campaign(), 1)
    log = replace(sound, duty=read_back(sound.duty, 3e-3, 1))
    rig = look(log)
    assert [f.code for f in rig.faults] == ["duty_noise"]
    assert "steps of it in place of" in rig.lines()[0]
    clean, found = identify(sound).joint, identify(rig.usable()).joint
    for name in TRUTH:
        error = clean[name].stderr
        assert error is not None
        assert abs(found[name].value - clean[name].value) < 0.5 * error
    np.testing.assert_array_equal(rig.accept(["duty_noise"]).usable().duty, log.duty)
