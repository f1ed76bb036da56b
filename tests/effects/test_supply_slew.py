"""Rate limit of the amplifier: by hand, and with the lag against an ODE solver."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals
from scipy.integrate import solve_ivp

from erdctl.model.recurrences import rate_limited


def test_check_value() -> None:
    s = signals(np.ones(4), duty=[0.0, 0.3, 0.3, 0.3])
    assert act("supply_slew", s, {"T_full": 0.05}) == pytest.approx([0, 0.1, 0.275, 0.3])


def test_recurrence_check_value() -> None:
    s = signals(np.ones(5), step=1.0)
    found = rate_limited(np.array([0, 1, 1, 1, 1.0]), s.step, s.starts, 0.4)
    assert found == pytest.approx([0, 0.2, 0.6, 0.95, 1])


def test_limits_downward_and_starts_anew_with_each_record() -> None:
    s = signals(np.ones(5), duty=[0.4, 0.0, 0.0, 0.5, 0.5], starts=[0, 3, 5])
    found = act("supply_slew", s, {"T_full": 0.05})
    assert found == pytest.approx([0.4, 0.3, 0.2, 0.5, 0.5])


@pytest.mark.parametrize("rate", [200.0, 1000.0])
def test_yield_force_equals_an_ode_solver(rate: float) -> None:
    T_full, T_d, sigma, beta = 0.2, 0.04, 20.0, 0.5
    t = np.arange(round(2.0 * rate)) / rate
    duty = np.array([0.1, 0.4, 0.2, 0.3])[np.floor(t / 0.5 + 1e-9).astype(int)]
    s = signals(np.full(len(t), 0.1), t=t, duty=duty)
    found = force("supply_slew", s, {"T_full": T_full}, k_nom=0.0, c_vis=0.0)
    y, expected = [0.1, sigma * 0.1**beta], [sigma * 0.1**beta]
    for target in (0.1, 0.4, 0.2, 0.3):
        here = len(expected) - 1
        end = min(here + round(0.5 * rate), len(t) - 1)
        reached = abs(target - y[0]) * T_full
        edges = [t[here], min(t[here] + reached, t[end]), t[end]]
        for a, b, speed in zip(
            edges, edges[1:], (np.sign(target - y[0]) / T_full, 0.0), strict=False
        ):
            inside = t[(t > a + 1e-12) & (t <= b + 1e-12)]
            if b <= a:
                continue
            solution = solve_ivp(
                lambda _, z, speed=speed: [speed, (sigma * z[0] ** beta - z[1]) / T_d],
                (a, b), y, t_eval=np.union1d(inside, [b]), rtol=1e-10, atol=1e-12, max_step=1e-2,
            )  # fmt: skip
            expected += solution.y[1, : len(inside)].tolist()
            y = solution.y[:, -1].tolist()
        y[0] = target
    error = found - np.array(expected)
    assert np.abs(error).max() < 2e-3 * np.ptp(found)
