"""Lag of the signed yield force: by hand, and against an ODE solver."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made import act, force, signals, sine
from scipy.integrate import solve_ivp


def test_check_value() -> None:
    """20 ms after a reversal: 10 - 20 exp(-1)."""
    xdot = np.where(np.arange(100) < 50, -0.1, 0.1)  # turns half-way between samples 49 and 50
    s = signals(xdot, step=1e-3)
    found = act("signed_yield_lag", 10.0 * np.sign(xdot), s, {"T_s": 0.02})
    left = np.sqrt((10 - found[69]) * (10 - found[70]))  # at 19.5 and 20.5 ms
    assert 10 - left == pytest.approx(10 - 20 * np.exp(-1), abs=1e-9)


@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("T_s", [0.005, 0.03, 0.5])
def test_force_equals_an_ode_solver(rate: float, T_s: float) -> None:
    """T_s dF/dt + F = +-Y, restarted at every reversal."""
    frequency, Y = 1.5, 20.0 * 0.3**0.5
    s = sine(frequency, 0.01, 2.0, rate, duty=0.3)
    found = force("signed_yield_lag", s, {"T_s": T_s}, k_nom=0.0, c_vis=0.0)
    turns = (np.arange(6) * 2 + 1) / (4 * frequency)
    F, way, expected = Y, 1.0, [Y]
    for a, b in pairwise([0.0, *turns, s.t[-1]]):
        inside = s.t[(s.t > a) & (s.t <= b)]
        if b > a:
            solution = solve_ivp(
                lambda _, y, way=way: (way * Y - y) / T_s, (a, b), [F],
                t_eval=np.union1d(inside, [b]), rtol=1e-10, atol=1e-12, max_step=T_s,
            )  # fmt: skip
            expected += solution.y[0, : len(inside)].tolist()
            F = float(solution.y[0, -1])
        way = -way
    assert found == pytest.approx(np.array(expected), abs=2e-3 * np.ptp(found))


def test_uneven_sampling_agrees_with_even() -> None:
    fine = sine(1.0, 0.01, 2.0, 1000.0, duty=0.3)
    picks = np.unique(np.random.default_rng(2).choice(2000, 1500))
    coarse = signals(fine.xdot[picks], x=fine.x[picks], t=fine.t[picks], duty=0.3)
    all_, some = (force("signed_yield_lag", s, {"T_s": 0.02}) for s in (fine, coarse))
    later = fine.t[picks] - fine.t[picks][0] > 0.1
    assert some[later] == pytest.approx(all_[picks][later], abs=0.02 * np.ptp(all_))
