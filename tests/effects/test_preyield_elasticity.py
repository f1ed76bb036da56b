"""A yield force that rebuilds over a distance: by hand, and against an ODE solver."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made import act, force, signals, sine
from scipy.integrate import solve_ivp

from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.model.composed import Model


def test_check_value() -> None:
    """0.1 mm after a reversal: 1 - 2 exp(-1)."""
    # Turns half-way between samples 49 and 50; 0.01 mm a step, and a quarter of it on either side.
    xdot = np.where(np.arange(100) < 50, -0.01, 0.01)
    s = signals(xdot, step=1e-3)
    found = act("preyield_elasticity", np.sign(xdot), s, {"x_d": 1e-4})
    travelled = 0.0025e-3 + 0.01e-3 * np.arange(50)
    assert found[50:] == pytest.approx(1 - 2 * np.exp(-travelled / 1e-4), abs=1e-10)
    assert np.interp(1e-4, travelled, found[50:]) == pytest.approx(1 - 2 * np.exp(-1), abs=0.002)


@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("x_d", [3e-4, 2e-3])
def test_force_equals_an_ode_solver(rate: float, x_d: float) -> None:
    """x_d dF/dt = |xdot| (+-Y - F), restarted at every reversal."""
    frequency, amplitude, Y = 1.5, 0.01, 20.0 * 0.3**0.5
    s = sine(frequency, amplitude, 2.0, rate, duty=0.3)
    found = force("preyield_elasticity", s, {"x_d": x_d}, k_nom=0.0, c_vis=0.0)
    w = 2 * np.pi * frequency
    turns = (np.arange(6) * 2 + 1) / (4 * frequency)
    F, way, expected = found[0], 1.0, [found[0]]
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


def stepped() -> Signals:
    """One tone under a duty that steps at all phases of it, also to nothing and back."""
    t = np.arange(3000) / 1000.0
    w = 2 * np.pi * 1.5
    duty = np.array([0.1, 0.6, 0.0, 0.3, 0.9, 0.2])[(t / 0.23).astype(int) % 6]
    return signals(0.01 * w * np.cos(w * t), x=0.01 * np.sin(w * t), t=t, duty=duty)


APART = {  # both directions, which differ
    "compression.k_nom": 0.0, "release.k_nom": 0.0, "compression.c_vis": 60.0,
    "release.c_vis": 80.0, "compression.sigma": 24.0, "release.sigma": 18.0,
    "compression.T_d": 0.02, "release.T_d": 0.03, "compression.beta": 0.6, "release.beta": 0.6,
}  # fmt: skip


@pytest.mark.parametrize("s_m", [0.0, pytest.param(2e-5, marks=pytest.mark.long)])
def test_a_step_of_the_control_acts_on_what_is_stretched(s_m: float) -> None:
    """F_y = F_ER z, as in Spencer's and in Dahl's damper, where the control multiplies z. The
    force was to build up over x_d again after each step of the control: up to 14 N of 22 N off,
    and T_d came out as 0 to make up for it."""
    s, x_d = stepped(), 2e-3
    w, n = 2 * np.pi * 1.5, len(s)

    def slope(t: float, y: np.ndarray) -> list[float]:
        F, z, e = y
        v = rod = 0.01 * w * np.cos(w * t)
        if s_m > 0.0:  # e / s = c v_p + F_y
            rest = e / s_m - F * z
            v = rest / (60.0 if rest > 0.0 else 80.0)
        u = s.duty[min(int(t * 1000 + 1e-6), n - 1)] ** 0.6
        lag = (24.0 * u - F) / 0.02 if v > 0.0 else (18.0 * u - F) / 0.03
        return [lag, (np.sign(v) - z) * abs(v) / x_d, rod - v]

    start = [24.0 * 0.1**0.6, 1.0, s_m * (24.0 * 0.1**0.6 + 60.0 * 0.01 * w)]
    F, z, e = solve_ivp(
        slope, (0.0, s.t[-1]), start, t_eval=s.t, max_step=2e-4, rtol=1e-6,
        method="RK23" if s_m == 0.0 else "LSODA",
    ).y  # fmt: skip
    by_hand = e / s_m if s_m > 0.0 else F * z + s.xdot * np.where(s.xdot > 0.0, 60.0, 80.0)
    names = ("preyield_elasticity", "mount_compliance") if s_m > 0.0 else ("preyield_elasticity",)
    values = APART | {"preyield_elasticity.x_d": x_d, "mount_compliance.s_m": s_m}
    found = Model(tuple(get(name) for name in names)).force(s, values)
    error = (found - by_hand)[500:]
    assert np.sqrt(np.mean(error**2)) < 4e-3 * np.ptp(by_hand)


@pytest.mark.parametrize("s_m", [0.0, 2e-6])
@pytest.mark.parametrize("first", [0, 31, 60, 77])
def test_a_record_begins_as_if_its_motion_had_gone_on_before(first: int, s_m: float) -> None:
    """Of a long sine the part from the sample `first` of its third cycle on, and that alone. It
    began with z steady: of a damper with 5 mm of travel the second after was off by a fifth of the
    force, and a threshold of the field was named that took the yield force away there."""
    long = sine(1.0, 0.01, 6.0, 100.0, duty=0.3)
    a = 200 + first
    alone = signals(long.xdot[a:], x=long.x[a:], step=0.01, duty=long.duty[a:])
    model = Model((get("preyield_elasticity"), get("mount_compliance")))
    values = APART | {"preyield_elasticity.x_d": 0.02, "mount_compliance.s_m": s_m}
    values["release.sigma"] = values["compression.sigma"]  # so that F_ER is steady
    whole, cut = (model.force(s, values) for s in (long, alone))
    close = 0.03 * np.ptp(whole)
    assert cut == pytest.approx(whole[a:], abs=close)
    blind = model.past_alone().force(alone, values)  # as `simulate` and C, which see no future
    assert np.abs(blind[:20] - whole[a : a + 20]).max() > 3.0 * close
