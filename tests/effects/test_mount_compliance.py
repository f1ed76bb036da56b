"""Mount in series: static, and against an ODE solver in continuous time."""

from __future__ import annotations

import numpy as np
import pytest
from made import PLAIN, force, signals, sine
from scipy.integrate import solve_ivp

from erdctl.effects import get
from erdctl.model.composed import Model


def test_check_value() -> None:
    s = signals(np.zeros(50), x=np.full(50, 0.01))
    found = force("mount_compliance", s, {"s_m": 1e-4}, k_nom=1000.0)
    assert found == pytest.approx(10 / 1.1)


@pytest.mark.parametrize("s_m", [1e-6, 2e-5, 2e-4])
def test_force_equals_an_ode_solver(s_m: float) -> None:
    """dF/dt = (xdot - v) / s; v from F - k (x - s F) = c v + Y sign(v), v = 0 where Y holds."""
    k, c, Y = 200.0, 70.0, 20.0 * 0.3**0.5
    frequency, amplitude, rate = 1.5, 0.01, 1000.0
    w = 2 * np.pi * frequency
    s = sine(frequency, amplitude, 2.0, rate, duty=0.3)

    def slope(t: float, y: list[float]) -> list[float]:
        rest = y[0] - k * (amplitude * np.sin(w * t) - s_m * y[0])
        v = (rest - min(max(rest, -Y), Y)) / c
        return [(amplitude * w * np.cos(w * t) - v) / s_m]

    start = (c * amplitude * w + Y) / (1 + k * s_m)
    solution = solve_ivp(
        slope, (0.0, s.t[-1]), [start], method="LSODA", t_eval=s.t, rtol=1e-9, atol=1e-9,
        max_step=1e-3,
    )  # fmt: skip
    found = force("mount_compliance", s, {"s_m": s_m})
    error = found - solution.y[0]
    assert np.sqrt(np.mean(error**2)) < 1.5e-3 * np.ptp(found)


def test_a_stiff_mount_is_none() -> None:
    s = sine(1.5, 0.01, 2.0, 500.0, duty=0.3)
    off, stiff = (force("mount_compliance", s, {"s_m": v}) for v in (0.0, 1e-12))
    moving = np.abs(s.xdot) > 1e-3
    assert stiff[moving] == pytest.approx(off[moving], abs=5e-3 * np.ptp(off))


@pytest.mark.few(5)
@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("duty", [0.0, 0.3])
@pytest.mark.parametrize("s_m", [1e-8, 1e-6, 1e-4])
def test_play_in_its_joint_equals_an_ode_solver(s_m: float, duty: float, rate: float) -> None:
    """de/dt = xdot - v, F = e / s beyond -g/2..g/2. Without a field a stiff mount is stretched by
    less than the rod moves in a sample, and half of the force was lost all along the stroke."""
    k, c, Y, g = 200.0, 70.0, 20.0 * duty**0.5, 2e-3
    w, amplitude = 2 * np.pi * 1.5, 0.01
    s = sine(1.5, amplitude, 2.0, rate, duty=duty)

    def force_at(e: float) -> float:
        return (max(e - g / 2, 0.0) + min(e + g / 2, 0.0)) / s_m

    def slope(t: float, y: list[float]) -> list[float]:
        rest = force_at(y[0]) - k * (amplitude * np.sin(w * t) - y[0])
        return [amplitude * w * np.cos(w * t) - (rest - min(max(rest, -Y), Y)) / c]

    start = s_m * (c * amplitude * w + Y) + g / 2
    solution = solve_ivp(
        slope, (0.0, s.t[-1]), [start], method="Radau", t_eval=s.t, rtol=1e-8, atol=1e-11,
        max_step=2e-3,
    )  # fmt: skip
    expected = np.array([force_at(e) for e in solution.y[0]])
    model = Model((get("backlash"), get("mount_compliance")))
    found = model.force(s, PLAIN | {"backlash.g": g, "mount_compliance.s_m": s_m})
    error = np.abs(found - expected)
    settled = s.t > 0.2
    assert np.sqrt(np.mean(error[settled] ** 2)) < 0.02 * np.ptp(expected)
    assert np.quantile(error[settled], 0.8) < 0.01 * np.ptp(expected)


def test_a_rod_that_turns_at_a_sample_has_a_leg_of_no_length() -> None:
    xdot = np.array([0.05, 0.03, -1e-20, -0.03, -0.05, -1e-20, 0.05])
    model = Model((get("backlash"), get("mount_compliance")))
    s = signals(xdot, x=np.cumsum(xdot) * 1e-3, step=1e-3)
    found = model.force(s, PLAIN | {"backlash.g": 2e-5, "mount_compliance.s_m": 1e-6})
    assert np.isfinite(found).all()
