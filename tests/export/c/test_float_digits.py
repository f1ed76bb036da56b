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


@pytest.mark.parametrize(("step", "T_full"), [(0.005, 0.05), (0.005, 0.3), (0.002, 0.3)])
def test_what_rounding_leaves_of_a_duty_that_slews_to_0_is_none(step: float, T_full: float) -> None:
    """A whole number of steps takes it there: beyond is v^beta of a duty of 1e-8."""
    t = step * np.arange(4000)
    levels = np.random.default_rng(5).choice([0.0, 0.12, 0.2, 0.4], 40)
    assert off("supply_slew", {"T_full": T_full}, signals(t, np.repeat(levels, 100))) < 1e-6


@pytest.mark.parametrize("t_0", [2.0, 2.125, 4.0])
def test_an_onset_keeps_the_part_of_its_last_step(t_0: float) -> None:
    s = signals(0.002 * np.arange(3000), np.full(3000, 0.3))
    assert off("oil_leakage", {"f": 0.5, "t_0": t_0, "t_r": 1.0}, s) < 5e-7


def test_time_goes_on_although_the_clock_began_long_ago() -> None:
    """At 512 s a float has digits of 6e-5 s."""
    s = signals(0.001 * np.arange(4000), np.full(4000, 0.3))
    s = replace(s, t=s.t + 512.0)
    assert off("oil_leakage", {"f": 0.5, "t_0": 514.0, "t_r": 0.5}, s) < 1e-6
