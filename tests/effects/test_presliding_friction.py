"""Dahl's loop: by hand, and against an ODE solver."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, sine, unit_forces
from scipy.integrate import solve_ivp

from erdctl.effects.presliding_friction import presliding_friction, slid_before


def test_check_value() -> None:
    """-1 + 2 exp(-1) at 0.1 mm after the reversal, x_d = 0.1 mm: 92.5 and 102.5 um there."""
    xdot = np.where(np.arange(40) < 20, 0.1, -0.1)  # 10 um a step, the turn half-way in one
    s = signals(xdot, step=1e-4)
    z = unit_forces("presliding_friction", s, {"x_d": 1e-4})[0]
    assert z[:20] == pytest.approx(np.ones(20))
    assert s.path_since_reversal[[20, 29, 30]] == pytest.approx([2.5e-6, 92.5e-6, 102.5e-6])
    left = (1 + z[29]) ** 0.25 * (1 + z[30]) ** 0.75
    assert left - 1 == pytest.approx(-1 + 2 * np.exp(-1), abs=1e-9)


def test_first_state() -> None:
    s = signals([0.0, 0.1, 0.1, -0.1, -0.1, -0.1], step=1e-3, starts=[0, 3, 6])
    z = unit_forces("presliding_friction", s, {"x_d": 1e-4})[0]
    assert z[0] == 0.0
    assert z[1] == pytest.approx(1 - np.exp(-0.5))  # 0.05 mm from rest
    assert z[3:] == pytest.approx([-1, -1, -1])


@pytest.mark.parametrize("rate", [200.0, 2000.0])
@pytest.mark.parametrize("x_d", [1e-4, 2e-3, 5e-2])
def test_state_equals_an_ode_solver(rate: float, x_d: float) -> None:
    """dz/dt = (xdot - z |xdot|) / x_d."""
    frequency, amplitude = 1.5, 0.01
    w = 2 * np.pi * frequency
    s = sine(frequency, amplitude, 2.0, rate)

    def slope(t: float, z: list[float]) -> list[float]:
        v = amplitude * w * np.cos(w * t)
        return [(v - z[0] * abs(v)) / x_d]

    z = unit_forces("presliding_friction", s, {"x_d": x_d})[0]
    solution = solve_ivp(
        slope, (0.0, s.t[-1]), [z[0]], method="LSODA", t_eval=s.t, rtol=1e-9, atol=1e-10,
        max_step=1e-3,
    )  # fmt: skip
    assert np.sqrt(np.mean((z - solution.y[0]) ** 2)) < (4e-3 if rate > 1000 else 1e-2)


@pytest.mark.parametrize("first", [0, 31, 60, 77])
def test_a_record_begins_as_if_its_motion_had_gone_on_before(first: int) -> None:
    """Of a long sine the part from the sample `first` of its third cycle on, and that alone."""
    long = sine(1.0, 0.01, 6.0, 100.0)
    a = 200 + first
    alone = signals(long.xdot[a:], x=long.x[a:], step=0.01)
    whole, cut = (unit_forces("presliding_friction", s, {"x_d": 0.02})[0] for s in (long, alone))
    assert abs(whole[a]) < 0.5  # it has not slid long
    assert cut == pytest.approx(whole[a:], abs=0.02)


def test_a_motion_that_begins_slowly_has_not_gone_on_before() -> None:
    """It grows from nearly nothing about the place that it passes fast later on, as in a record of
    a real damper at 3 Hz (`mr_sine`): the seal was held to have slid the way that it does there."""
    t = np.arange(400) / 100.0
    w, grown = 2.0 * np.pi, np.minimum(t / 2.0, 1.0)
    x = -0.01 * grown * np.sin(w * t) - 1e-6
    xdot = np.gradient(x, t)
    xdot[0] = -1e-4  # noise of a sensor
    z, past = (
        of_seal(signals(xdot, x=x, t=t), {"x_d": 2e-3})[0]
        for of_seal in (presliding_friction, slid_before)
    )
    assert z == pytest.approx(past, abs=1e-12)
