"""A joint whose play is damped: against an ODE solver, and at the ends of its range."""

from __future__ import annotations

import numpy as np
import pytest
from made import PLAIN, force, sine
from scipy.integrate import solve_ivp

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.series_compliance import BEGUN

K, C, STROKE = 200.0, 70.0, 0.01
W = 2 * np.pi * 1.5


def solved(s: Signals, s_m: float, c_m: float, g: float, Y: float) -> Array:
    """de/dt = xdot - v;  F = e / s_m beyond the play + c_m de/dt = k x_p + c v + Y sign(v)."""

    def spring(e: float) -> float:
        return (max(e - g / 2, 0.0) + min(e + g / 2, 0.0)) / s_m

    def slope(t: float, e: float) -> float:
        rod = STROKE * W * np.cos(W * t)
        rest = spring(e) + c_m * rod - K * (STROKE * np.sin(W * t) - e)
        return float(rod - (rest - min(max(rest, -Y), Y)) / (C + c_m))

    soft = s_m / (1 + c_m * s_m / BEGUN)
    start = soft * (C * STROKE * W + Y) / (1 + K * soft) + g / 2
    found = solve_ivp(
        lambda t, y: [slope(t, y[0])], (0.0, s.t[-1]), [start], method="Radau", t_eval=s.t,
        rtol=1e-8, atol=1e-11, max_step=2e-3,
    )  # fmt: skip
    stretch = found.y[0]
    return np.array([spring(e) + c_m * slope(t, e) for t, e in zip(s.t, stretch, strict=True)])


@pytest.mark.few(9)
@pytest.mark.parametrize("rate", [250.0, 1000.0])
@pytest.mark.parametrize("g", [0.0, 2e-3])
@pytest.mark.parametrize("c_m", [30.0, 500.0, 5000.0])
@pytest.mark.parametrize("s_m", [1e-6, 2e-5, 2e-4])
def test_force_equals_an_ode_solver(s_m: float, c_m: float, g: float, rate: float) -> None:
    s, Y = sine(1.5, STROKE, 2.0, rate, duty=0.3), 20.0 * 0.3**0.5
    found = force("damped_backlash", s, {"s_m": s_m, "c_m": c_m, "g": g})
    expected = solved(s, s_m, c_m, g, Y)
    error = np.abs(found - expected)[s.t > 0.3] / np.ptp(expected)
    assert np.sqrt(np.mean(error**2)) < 0.005
    assert np.quantile(error, 0.8) < 1e-3


def test_without_damping_it_is_an_elastic_one_and_with_much_none() -> None:
    s = sine(1.5, STROKE, 2.0, 500.0, duty=0.3)
    elastic, plain = force("mount_compliance", s, {"s_m": 2e-5}), Model().force(s, PLAIN)
    least = force("damped_backlash", s, {"g": 0.0, "s_m": 2e-5, "c_m": 1e-3})
    most = force("damped_backlash", s, {"g": 1e-6, "s_m": 1e-6, "c_m": 1e8})
    assert least == pytest.approx(elastic, abs=1e-4 * np.ptp(elastic))
    moving = np.abs(s.xdot) > 1e-3
    assert most[moving] == pytest.approx(plain[moving], abs=1e-3 * np.ptp(plain))


def test_the_force_stands_on_a_step_while_the_play_is_crossed() -> None:
    """The piston rests there: the rod's speed alone makes the force, c_m xdot."""
    s = sine(1.5, STROKE, 2.0, 2000.0, duty=0.3)
    found = force("damped_backlash", s, {"g": 5e-4, "s_m": 1e-7, "c_m": 200.0})
    turn = int(np.argmax(s.x))
    crossing = (s.x[turn] - s.x > 1e-4) & (s.x[turn] - s.x < 4e-4) & (s.t > s.t[turn])
    crossing &= s.t < s.t[turn] + 0.1
    assert crossing.sum() > 20
    assert found[crossing] == pytest.approx(200.0 * s.xdot[crossing], rel=1e-6)
