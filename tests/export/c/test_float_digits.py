"""Where single precision would lose what counts: what is left of a way, and of a step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from c_built import FLOAT, block_of, forces
from places import FIXTURES

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values


def signals(t: Array, duty: Array) -> Signals:
    x, xdot = 0.01 * np.sin(9.0 * t), 0.09 * np.cos(9.0 * t)
    step = np.append(np.diff(t), 0.0)
    return Signals(t=t, x=x, xdot=xdot, duty=duty, step=step, starts=np.array([0, len(t)]))


def off(name: str, own: dict[str, float], s: Signals) -> float:
    """Largest difference over the range of the force."""
    model, values = Model((get(name),)), PAPER | {f"{name}.{k}": v for k, v in own.items()}
    expected = model.past_alone().force(s, values)
    found = forces(block_of(model, values, s), s, FLOAT)
    return float(np.abs(found - expected).max() / np.ptp(expected))


@pytest.mark.parametrize("T_full", [0.02, 0.05, 0.1])
def test_what_rounding_leaves_of_a_duty_that_slews_to_0_is_none(T_full: float) -> None:
    """A whole number of steps takes it there: beyond is v^beta of a duty of 1e-8."""
    t = 0.002 * np.arange(2000)
    levels = np.random.default_rng(5).choice([0.0, 0.12, 0.2, 0.4], 40)
    assert off("supply_slew", {"T_full": T_full}, signals(t, np.repeat(levels, 50))) < 1e-6


@pytest.mark.parametrize("t_r", [0.0, 0.0625, 1.0])
def test_an_onset_keeps_the_parts_of_its_first_and_last_step(t_r: float) -> None:
    """Far from the start of the record; steps and onsets are such as a float holds."""
    s = signals(np.arange(20_000) / 2048, np.full(20_000, 0.3))
    for shift in (0.0, 2.0**-13, 2.0**-12):
        assert off("oil_leakage", {"f": 0.5, "t_0": 8.0 + shift, "t_r": t_r}, s) < 1e-6


def test_time_goes_on_in_steps_that_a_float_does_not_hold() -> None:
    s = signals(0.0007 * np.arange(15_000), np.full(15_000, 0.3))
    assert off("oil_leakage", {"f": 0.5, "t_0": 8.0, "t_r": 0.25}, s) < 1e-6


def test_a_clock_that_began_long_ago_costs_its_own_digits_only() -> None:
    s = signals(np.arange(8000) / 2048, np.full(8000, 0.3))
    s = replace(s, t=s.t + 512.0)
    assert off("oil_leakage", {"f": 0.5, "t_0": 514.0, "t_r": 0.5}, s) < 1e-6
