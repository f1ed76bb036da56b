"""Maxwell element: by hand, and against an ODE solver in continuous time."""

from __future__ import annotations

import numpy as np
import pytest
from made import force, signals, sine
from scipy.integrate import solve_ivp


def test_check_value() -> None:
    """A step of the speed: time constant c s = 10 ms."""
    xdot = np.concatenate([[0.0], np.full(4000, 0.1)])
    s = signals(xdot, step=1e-5)
    found = force("fluid_compressibility", s, {"s_f": 1e-4}, k_nom=0.0, c_vis=100.0, sigma=0.0)
    assert found[1000] == pytest.approx(10 * (1 - np.exp(-1)), rel=1e-3)


@pytest.mark.parametrize("s_f", [1e-6, 2e-5, 2e-4])
def test_force_equals_an_ode_solver(s_f: float) -> None:
    """dF/dt = (xdot - v) / s; v = 0 where |F| < Y, else (F -+ Y) / c; the gas in parallel."""
    k, c, Y = 200.0, 70.0, 20.0 * 0.3**0.5
    frequency, amplitude = 1.5, 0.01
    w = 2 * np.pi * frequency
    s = sine(frequency, amplitude, 2.0, 1000.0, duty=0.3)

    def slope(t: float, y: list[float]) -> list[float]:
        v = (y[0] - min(max(y[0], -Y), Y)) / c
        return [(amplitude * w * np.cos(w * t) - v) / s_f]

    solution = solve_ivp(
        slope, (0.0, s.t[-1]), [c * amplitude * w + Y], method="LSODA", t_eval=s.t,
        rtol=1e-9, atol=1e-9, max_step=1e-3,
    )  # fmt: skip
    found = force("fluid_compressibility", s, {"s_f": s_f})
    error = found - (solution.y[0] + k * s.x)
    assert np.sqrt(np.mean(error**2)) < 1.5e-3 * np.ptp(found)


def test_the_friction_of_the_seal_is_not_behind_the_fluid() -> None:
    s = sine(1.5, 0.01, 2.0, 1000.0, duty=0.3)
    stiff = force("fluid_compressibility", s, {"s_f": 1e-9}, sigma=0.0)
    soft = force("fluid_compressibility", s, {"s_f": 10 / 200}, sigma=0.0)
    assert np.ptp(soft - 200.0 * s.x) < 0.3 * np.ptp(stiff - 200.0 * s.x)
