"""Self-heating: by hand, and against an ODE solver in continuous time."""

from __future__ import annotations

import numpy as np
import pytest
from made import force, signals, sine
from scipy.integrate import solve_ivp

from erdctl.model.recurrences import fading


def test_check_value() -> None:
    s = signals(np.ones(3), step=0.1)
    p = {"a_v": np.log(2), "a_y": 0.0, "tau": 1e6}
    found = force("thermal_fade", s, p, k_nom=0.0, c_vis=10.0, sigma=0.0)
    assert found == pytest.approx([10.0, 5.0, 10 * 2**-1.5], rel=1e-6)


def test_recurrence_check_value() -> None:
    s = signals(np.ones(3), step=0.1)
    f_v, f_y = fading(np.full(3, 10.0), np.zeros(3), s.xdot, s.step, s.starts, np.log(2), 0.0, 1e9)
    assert f_v == pytest.approx([1.0, 0.5, 2**-1.5])
    assert np.array_equal(f_y, np.ones(3))


@pytest.mark.parametrize("tau", [2.0, 50.0])
def test_force_equals_an_ode_solver(tau: float) -> None:
    k, c, Y, a_v, a_y = 200.0, 70.0, 20.0 * 0.3**0.5, 0.1, 0.2
    frequency, amplitude = 1.5, 0.01
    w = 2 * np.pi * frequency
    s = sine(frequency, amplitude, 20.0, 500.0, duty=0.3)

    def power(t: float, h: float) -> float:
        v = amplitude * w * np.cos(w * t)
        return float(c * v * v * np.exp(-a_v * h) + Y * abs(v) * np.exp(-a_y * h))

    heat = solve_ivp(
        lambda t, h: power(t, h[0]) - h[0] / tau, (0.0, s.t[-1]), [0.0],
        t_eval=s.t, rtol=1e-9, atol=1e-9, max_step=0.02,
    ).y[0]  # fmt: skip
    expected = (
        k * s.x + c * s.xdot * np.exp(-a_v * heat) + Y * np.sign(s.xdot) * np.exp(-a_y * heat)
    )
    found = force("thermal_fade", s, {"a_v": a_v, "a_y": a_y, "tau": tau})
    plain = force("thermal_fade", s, {"a_v": 0.0, "a_y": 0.0, "tau": tau})
    assert np.abs(found - plain).max() > 0.05 * np.ptp(plain)
    assert found == pytest.approx(expected, abs=1e-3 * np.ptp(plain))


def test_temperature_restarts_with_each_record() -> None:
    p = {"a_v": 0.1, "a_y": 0.1, "tau": 100.0}
    one = signals(np.ones(50))
    two = signals(np.ones(100), starts=[0, 50, 100])
    assert force("thermal_fade", two, p)[50:] == pytest.approx(force("thermal_fade", one, p))
