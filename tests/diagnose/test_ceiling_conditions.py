"""Each condition by itself under which a force that stays about a level is the end of a range."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from erdctl.core.recording import Array
from erdctl.diagnose.residual.ceiling import _Side

NOISE, LEVEL, C = 0.4, 9.0, 10.0  # N, N, N s/m
T = np.arange(8000) / 400.0
RANDOM = np.random.default_rng(11)
WHITE = NOISE * RANDOM.standard_normal(len(T))
STEPS = np.repeat(RANDOM.uniform(2.0, 6.0, 200), 40)  # N, of the control


def side(xdot: Array, rest: Array, force: Array) -> _Side:
    """The upper side of a log whose model is the damper's."""
    model = C * xdot + rest
    problem: Any = SimpleNamespace(
        recording=SimpleNamespace(xdot=xdot),
        block=SimpleNamespace(force=force, weight=np.ones(len(force))),
    )
    values = {"compression.c_vis": C, "release.c_vis": C}
    fitted: Any = SimpleNamespace(values=values)
    left: Any = SimpleNamespace(noise_rms=NOISE, misfit_rms=0.1)
    return _Side(problem, fitted, model, left, 1.0)


def told(xdot: Array, rest: Array, force: Array) -> bool:
    """Whether an end of a range is seen."""
    it = side(xdot, rest, force)
    level, zone = it._level()
    return bool(zone.any()) and it._is_flat(zone, level)


def stopping(xdot: Array, rest: Array) -> Array:
    return np.asarray(np.minimum(C * xdot + rest, LEVEL))


FAST = np.sin(2.0 * np.pi * 1.7 * T)


def test_the_end_of_a_range() -> None:
    assert told(FAST, STEPS, stopping(FAST, STEPS) + WHITE)


def test_more_than_noise_is_left_there() -> None:
    assert not told(FAST, STEPS, stopping(FAST, STEPS) + 2.0 * WHITE)


@pytest.mark.parametrize("shown", ["motion", "control"])
def test_a_part_of_what_the_model_has_shows(shown: str) -> None:
    """By less than the noise, which its scatter would not tell."""
    slow, steps = 0.06 * FAST + 0.9, 0.15 * STEPS + 0.6
    part = 0.4 * C * slow if shown == "motion" else 0.6 * steps
    above = C * slow + steps > LEVEL
    force = np.where(above, LEVEL + part - part[above].mean(), C * slow + steps)
    assert not told(slow, steps, force + WHITE)


def test_few_visits() -> None:
    """Three, over which motion and control change by many times the noise."""
    slow = 6.0 * np.sin(2.0 * np.pi * 0.15 * T)
    rest = 3.0 + 8.0 * np.sin(2.0 * np.pi * 0.9 * T)
    rest = np.where(C * slow > 20.0, rest, 3.0)
    assert not told(slow, rest, stopping(slow, rest) + WHITE)


def test_a_control_that_never_changes() -> None:
    rest, exact = np.full(len(T), 4.0), np.round(64.0 * FAST) / 64.0
    assert not told(exact, rest, stopping(exact, rest) + WHITE)


def test_a_gain_that_chance_makes() -> None:
    """A model that is too high by less than a tenth of the noise."""
    _, zone = side(FAST, STEPS, C * FAST + STEPS - 0.03 + WHITE)._level()
    assert not zone.any()


def test_what_is_left_out_is_what_is_near_it() -> None:
    """All that the model has beyond, with the samples next to it; most others stay."""
    it = side(FAST, STEPS, stopping(FAST, STEPS) + WHITE)
    level, zone = it._level()
    out = it._at(zone, level)
    assert level == pytest.approx(LEVEL, abs=0.1)
    assert out[zone].all()
    assert out[C * FAST + STEPS > LEVEL].mean() > 0.98
    assert out[C * FAST + STEPS < LEVEL - 4.0 * NOISE].mean() < 0.02
