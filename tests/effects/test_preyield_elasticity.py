"""A yield force that rebuilds over a distance: by hand, and against an ODE solver."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made import act, force, signals, sine
from scipy.integrate import solve_ivp


def test_check_value() -> None:
    """0.1 mm after a reversal: 10 - 20 exp(-1)."""
    # Turns half-way between samples 49 and 50; 0.01 mm a step, and a quarter of it on either side.
    xdot = np.where(np.arange(100) < 50, -0.01, 0.01)
    s = signals(xdot, step=1e-3)
    found = act("preyield_elasticity", 10.0 * np.sign(xdot), s, {"x_d": 1e-4})
    travelled = 0.0025e-3 + 0.01e-3 * np.arange(50)
    assert found[50:] == pytest.approx(10 - 20 * np.exp(-travelled / 1e-4), abs=1e-9)
    assert np.interp(1e-4, travelled, found[50:]) == pytest.approx(10 - 20 * np.exp(-1), abs=0.02)


@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("x_d", [3e-4, 2e-3])
def test_force_equals_an_ode_solver(rate: float, x_d: float) -> None:
    """x_d dF/dt = |xdot| (+-Y - F), restarted at every reversal."""
    frequency, amplitude, Y = 1.5, 0.01, 20.0 * 0.3**0.5
    s = sine(frequency, amplitude, 2.0, rate, duty=0.3)
    found = force("preyield_elasticity", s, {"x_d": x_d}, k_nom=0.0, c_vis=0.0)
    w = 2 * np.pi * frequency
    turns = (np.arange(6) * 2 + 1) / (4 * frequency)
    F, way, expected = Y, 1.0, [Y]
    for a, b in pairwise([0.0, *turns, s.t[-1]]):
        inside = s.t[(s.t > a) & (s.t <= b)]
        if b > a:
            solution = solve_ivp(
                lambda t, y, way=way: abs(amplitude * w * np.cos(w * t)) * (way * Y - y) / x_d,
                (a, b), [F], t_eval=np.union1d(inside, [b]), rtol=1e-9, atol=1e-11, max_step=1e-3,
            )  # fmt: skip
            expected += solution.y[0, : len(inside)].tolist()
            F = float(solution.y[0, -1])
        way = -way
    assert found == pytest.approx(np.array(expected), abs=4e-3 * np.ptp(found))


def test_the_loop_does_not_depend_on_frequency() -> None:
    slow, fast = (sine(f, 0.01, 4.0 / f, 1000.0 * f, duty=0.3) for f in (0.5, 2.0))
    a, b = (
        force("preyield_elasticity", s, {"x_d": 1e-3}, k_nom=0.0, c_vis=0.0) for s in (slow, fast)
    )
    assert a == pytest.approx(b, abs=1e-9)
