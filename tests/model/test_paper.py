"""Eqs. 12, 13 and 18 against the independent solution, and the conventions at rest."""

from __future__ import annotations

import numpy as np
import pytest
from rig import TRUTH, campaign, recording

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.paper import field_law, yield_force


def signals(t: Array, xdot: Array, duty: Array | None = None) -> Signals:
    zero = np.zeros(len(t))
    r = Recording(
        t=t, x=zero, xdot=xdot, duty=zero if duty is None else duty,
        starts=np.array([0, len(t)], dtype=np.intp), names=("r",),
    )  # fmt: skip
    return Signals.of(r)


def test_lag_check_value() -> None:
    t = np.arange(101) * 0.00043
    up = np.where(np.arange(101) < 0, 0.0, 1.0)
    s = signals(t, np.ones(101))
    u = up.copy()
    u[0] = 1.0
    force = yield_force(s, u, u, 0.043, 0.043)
    assert force == pytest.approx(np.ones(101))
    u = np.concatenate([[0.0], np.ones(101)])
    s = signals(np.arange(102) * 0.00043, np.ones(102))
    assert yield_force(s, u, u, 0.043, 0.043)[101] == pytest.approx(1 - np.exp(-1), rel=1e-12)


def test_field_law_check_value_and_null() -> None:
    assert field_law(np.array([0.25]), 0.5) == pytest.approx([0.5])
    assert field_law(np.array([0.0, 1.0]), 0.2373) == pytest.approx([0.0, 1.0])


def test_field_law_of_held_duty_is_the_power() -> None:
    duty = np.repeat(np.random.default_rng(1).random(40), 50)
    assert np.array_equal(field_law(duty, 0.3948), duty**0.3948)


def test_force_is_odd_at_rest() -> None:
    """sign(0) = 0: at rest only the gas spring acts (Eq. 18)."""
    t = np.arange(5) * 0.01
    r = Recording(
        t=t, x=np.full(5, 0.01), xdot=np.zeros(5), duty=np.full(5, 0.3),
        starts=np.array([0, 5], dtype=np.intp), names=("r",),
    )  # fmt: skip
    assert Model().force(Signals.of(r), TRUTH) == pytest.approx(0.01 * 263.1168)


def test_direction_at_rest_is_the_last_one() -> None:
    xdot = np.array([0.0, -1.0, 0.0, 0.0, 2.0, 0.0, -1.0])
    up = signals(np.arange(7) * 0.1, xdot).compressing
    assert up.tolist() == [False, False, False, False, True, True, False]


def test_states_restart_at_each_record() -> None:
    one = campaign().select([2])
    twice = campaign().select([2, 2])
    force = Model().force(Signals.of(twice), TRUTH)
    alone = Model().force(Signals.of(one), TRUTH)
    assert np.array_equal(force[: len(one)], alone)
    assert np.array_equal(force[len(one) :], alone)


@pytest.mark.parametrize(("rate", "part"), [(200.0, 1e-3), (1000.0, 1e-4)])
def test_force_equals_the_independent_solution(rate: float, part: float) -> None:
    """Within 0.1 % of the range away from sign changes, even at 200 Hz."""
    r = campaign(rate)
    error = Model().force(Signals.of(r), TRUTH) - r.force
    s = Signals.of(r)
    after = s.since_reversal > 1.5 / rate
    before = np.append(np.abs(np.diff(np.sign(s.xdot))) == 0, True)
    away = after & before
    assert away.mean() > 0.9
    assert np.abs(error[away]).max() < part * np.ptp(r.force)


def test_uneven_sampling_changes_nothing() -> None:
    rng = np.random.default_rng(3)
    t = np.cumsum(rng.uniform(0.0005, 0.0015, 8000))
    x, xdot = 0.01 * np.sin(9 * t), 0.09 * np.cos(9 * t)
    duty = np.where(np.floor(t / 0.37) % 2 == 0, 0.1, 0.3)
    r = recording(t, x, xdot, duty)
    error = Model().force(Signals.of(r), TRUTH) - r.force
    away = Signals.of(r).since_reversal > 0.003
    before = np.append(np.diff(np.sign(xdot)) == 0, True)
    assert np.abs(error[away & before]).max() < 5e-4 * np.ptp(r.force)


def test_zero_time_constant_is_the_static_law() -> None:
    r = campaign().select([2])
    values = TRUTH | {"compression.T_d": 0.0, "release.T_d": 0.0}
    s = Signals.of(r)
    up = r.xdot > 0
    sigma = np.where(up, TRUTH["compression.sigma"], TRUTH["release.sigma"])
    beta = np.where(up, TRUTH["compression.beta"], TRUTH["release.beta"])
    static = sigma * r.duty**beta * np.sign(r.xdot)
    assert Model().parts(s, values)["yield"] == pytest.approx(static)
