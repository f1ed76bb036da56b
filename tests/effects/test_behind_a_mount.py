"""What acts behind a mount knows the piston's speed and travel, and stretches the mount."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from made import PLAIN, signals, sine
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.recording import Array
from erdctl.effects import catalogue, get
from erdctl.model.composed import Model

K, C, DUTY = 200.0, 70.0, 0.3
Y = 20.0 * DUTY**0.5
W, STROKE, GAP = 2 * np.pi * 1.5, 0.01, 2e-3
SIGN = 1e-5  # m/s, over which a sign is rounded for the ODE solver

# Own values, and what an ODE solver needs of it: signed yield force by v, x_p and a state; slope of
# that state by v and it.
Law = Callable[[float, float, float], float]
LAWS: dict[str, tuple[dict[str, float], Law, Callable[[float, float], float]]] = {
    "yield_hysteresis": (
        {"v_y": 0.02, "kappa": 4.0},
        lambda v, x, z: Y * np.tanh((v + 4.0 * x) / 0.02),
        lambda v, z: 0.0,
    ),
    "preyield_field_dependence": (
        {"v_y": 0.04, "q": 0.7},
        lambda v, x, z: Y * np.tanh(v / (0.04 * DUTY**0.7)),
        lambda v, z: 0.0,
    ),
    "signed_yield_lag": (
        {"T_s": 0.03},
        lambda v, x, z: z,
        lambda v, z: (Y * np.tanh(v / SIGN) - z) / 0.03,
    ),
    "preyield_elasticity": (
        {"x_d": 1e-3},
        lambda v, x, z: z,
        lambda v, z: (Y * v - z * abs(v)) / 1e-3,
    ),
}


@pytest.mark.parametrize("rate", [250.0, 1000.0])
@pytest.mark.parametrize("s_m", [1e-6, 2e-5, 2e-4])
@pytest.mark.parametrize("name", LAWS)
def test_sign_laws_equal_an_ode_solver(name: str, s_m: float, rate: float) -> None:
    """de/dt = xdot - v, with v from e / s = k x_p + c v + F_y. No model held these behind a mount,
    and a damper with both was told to have one of them."""
    own, law, slope = LAWS[name]
    s = sine(1.5, STROKE, 2.0, rate, duty=DUTY)

    def speed(t: float, e: float, z: float) -> float:
        x = STROKE * np.sin(W * t) - e

        def beyond(v: float) -> float:
            return K * x + C * v + law(v, x, z) - e / s_m

        return float(brentq(beyond, -10.0, 10.0, xtol=1e-12))

    def moved(t: float, y: Array) -> list[float]:
        v = speed(t, *y)
        return [STROKE * W * np.cos(W * t) - v, slope(v, y[1])]

    start = s_m * (C * STROKE * W + law(STROKE * W, 0.0, Y)) / (1 + K * s_m)
    solution = solve_ivp(
        moved, (0.0, s.t[-1]), [start, Y], method="LSODA", t_eval=s.t, rtol=1e-7, atol=1e-10,
        max_step=2e-3,
    )  # fmt: skip
    model = Model((get("mount_compliance"), get(name)))
    values = PLAIN | {f"{name}.{symbol}": v for symbol, v in own.items()}
    found = model.force(s, values | {"mount_compliance.s_m": s_m})
    settled = s.t > 0.1
    error = (found - solution.y[0] / s_m)[settled]
    assert np.sqrt(np.mean(error**2)) < 5.0 / rate * np.ptp(found)


@pytest.mark.parametrize("name", LAWS)
def test_behind_a_stiff_mount_they_are_those_of_the_rod(name: str) -> None:
    own = {f"{name}.{symbol}": v for symbol, v in LAWS[name][0].items()}
    s = sine(1.5, STROKE, 2.0, 500.0, duty=DUTY)
    rigid = Model((get(name),)).force(s, PLAIN | own)
    model = Model((get("mount_compliance"), get(name)))
    found = model.force(s, PLAIN | own | {"mount_compliance.s_m": 1e-10})
    assert found == pytest.approx(rigid, abs=5e-3 * np.ptp(rigid))


@pytest.mark.parametrize("steps", [0.3, 1.0, 2.0, 5.0, 20.0])
def test_a_piston_that_lags_moves_on_as_the_rod_turns(steps: float) -> None:
    """Viscous alone, K (x - e) + C v = e / s, in closed form. By the rod's own ratio of speeds in a
    step it was given up to four times its travel there: 0.2, 0.34 and 1.1 % of the range at one,
    two and twenty steps of lag, and in sparse logs `time_skew` had the name."""
    rate = 200.0
    s_m = steps / rate / C
    s = sine(1.5, STROKE, 3.0, rate, duty=0.0)
    found = Model((get("mount_compliance"),)).force(s, PLAIN | {"mount_compliance.s_m": s_m})
    stretch = STROKE * (1j * W + K / C) / (1j * W + (1.0 / s_m + K) / C)
    true = np.imag(stretch * np.exp(1j * W * s.t)) / s_m
    error = (found - true)[s.t > 0.8]
    assert np.sqrt(np.mean(error**2)) < 7e-4 * np.ptp(true)


@pytest.mark.parametrize(("begin", "rest"), [(-0.008, -0.004), (0.003, 0.008), (0.01, 0.002)])
def test_a_rod_at_rest_keeps_its_force(begin: float, rest: float) -> None:
    """A gas that is stiffer in compression could let the piston go either way: rounding decided, in
    a jump of the force by a quarter, up to 0.5 s after the rod had stopped."""
    t = np.arange(1000) / 500.0
    way = 0.5 * (rest - begin)
    x = np.where(t < 0.5, begin + way * (1.0 - np.cos(2 * np.pi * t)), rest)
    xdot = np.where(t < 0.5, way * 2 * np.pi * np.sin(2 * np.pi * t), 0.0)
    values = PLAIN | {"compression.k_nom": 263.0, "release.k_nom": 170.0}
    found = Model((get("mount_compliance"),)).force(
        signals(xdot, x=x, t=t, duty=0.0), values | {"mount_compliance.s_m": 1e-5}
    )
    still = found[t > 0.55]
    assert np.ptp(still) < 1e-4 * np.abs(still).max()


@pytest.mark.parametrize("preload", [3.0, 8.0, 30.0])
def test_a_preload_takes_up_the_play_of_a_joint(preload: float) -> None:
    """A mount carries what the gas presses. Added to the force of a play that it did not know of, a
    preload of 5.2 kN behind one of 4 mm left 2.3 kN of a damper's force where 1.5 kN are noise."""
    s, s_m = sine(1.5, STROKE, 2.0, 1000.0, duty=DUTY), 2e-5

    def force_at(e: float) -> float:
        return (max(e - GAP / 2, 0.0) + min(e + GAP / 2, 0.0)) / s_m

    def moved(t: float, y: Array) -> list[float]:
        rest = force_at(y[0]) - K * (STROKE * np.sin(W * t) - y[0]) - preload
        return [STROKE * W * np.cos(W * t) - (rest - min(max(rest, -Y), Y)) / C]

    start = s_m * (C * STROKE * W + Y + preload) + GAP / 2
    solution = solve_ivp(
        moved, (0.0, s.t[-1]), [start], method="Radau", t_eval=s.t, rtol=1e-8, atol=1e-11,
        max_step=2e-3,
    )  # fmt: skip
    expected = np.array([force_at(e) for e in solution.y[0]])
    model = Model((get("backlash"), get("mount_compliance"), get("gas_preload")))
    values = {"backlash.g": GAP, "mount_compliance.s_m": s_m, "gas_preload.F_0": preload}
    error = np.abs(model.force(s, PLAIN | values) - expected)[s.t > 0.1]
    assert np.sqrt(np.mean(error**2)) < 0.01 * np.ptp(expected)


@pytest.mark.parametrize("gap", [0.0, GAP])
@pytest.mark.parametrize("x_d", [1e-4, 2e-3])
def test_a_seal_that_bends_goes_with_the_piston(x_d: float, gap: float) -> None:
    """dz/dt = (v - z |v|) / x_d: while the play is crossed it stays as it was."""
    s, s_m, F_c = sine(1.5, STROKE, 2.0, 1000.0), 2e-5, 8.0

    def force_at(e: float) -> float:
        return (max(e - gap / 2, 0.0) + min(e + gap / 2, 0.0)) / s_m

    def moved(t: float, y: Array) -> list[float]:
        e, z = y
        v = (force_at(e) - K * (STROKE * np.sin(W * t) - e) - F_c * z) / C
        return [STROKE * W * np.cos(W * t) - v, (v - z * abs(v)) / x_d]

    start = s_m * (C * STROKE * W + F_c) + gap / 2
    solution = solve_ivp(
        moved, (0.0, s.t[-1]), [start, 1.0], method="Radau", t_eval=s.t, rtol=1e-8, atol=1e-11,
        max_step=2e-3,
    )  # fmt: skip
    expected = np.array([force_at(e) for e in solution.y[0]])
    model = Model((get("backlash"), get("mount_compliance"), get("presliding_friction")))
    values = {"backlash.g": gap or 1e-12, "mount_compliance.s_m": s_m}
    values |= {"presliding_friction.F_c": F_c, "presliding_friction.x_d": x_d}
    found = model.force(s, PLAIN | values)
    settled = s.t > 0.7
    assert np.sqrt(np.mean((found - expected)[settled] ** 2)) < 0.01 * np.ptp(expected)
    parts = model.parts(s, PLAIN | values)
    assert sum(parts.values()) == pytest.approx(found)
    assert np.abs(parts["yield"][1:]).max() < 1e-3  # no field: what the tables of laws leave


@pytest.mark.few(3)
@pytest.mark.parametrize("gap", [0.0, GAP])
@pytest.mark.parametrize(("s_m", "m"), [(2e-5, 0.3), (2e-4, 1.0), (2e-4, 4.0)])
def test_a_mass_goes_with_the_piston(s_m: float, m: float, gap: float) -> None:
    """m dv/dt = F - k x_p - c v - F_ER sign(v): behind a mount the piston is not accelerated as the
    rod is, least of all where it turns, sticks or crosses a play."""
    s, soft = sine(1.5, STROKE, 2.0, 1000.0, duty=DUTY), 2e-4

    def force_at(e: float) -> float:
        return (max(e - gap / 2, 0.0) + min(e + gap / 2, 0.0)) / s_m

    def moved(t: float, y: Array) -> list[float]:
        e, v = y
        borne = K * (STROKE * np.sin(W * t) - e) + C * v + Y * np.tanh(v / soft)
        return [STROKE * W * np.cos(W * t) - v, (force_at(e) - borne) / m]

    start = s_m * (C * STROKE * W + Y) / (1 + K * s_m) + gap / 2
    solution = solve_ivp(
        moved, (0.0, s.t[-1]), [start, STROKE * W], method="Radau", t_eval=s.t, rtol=1e-7,
        atol=1e-10, max_step=2e-3,
    )  # fmt: skip
    expected = np.array([force_at(e) for e in solution.y[0]])
    model = Model((get("backlash"), get("mount_compliance"), get("fluid_inertia")))
    values = {"backlash.g": gap or 1e-12, "mount_compliance.s_m": s_m, "fluid_inertia.m": m}
    found = model.force(s, PLAIN | values)
    settled = (s.t > 0.1) & (s.t < s.t[-1] - 0.05)
    assert np.sqrt(np.mean((found - expected)[settled] ** 2)) < 0.01 * np.ptp(expected)
    assert sum(model.parts(s, PLAIN | values).values()) == pytest.approx(found)


def test_an_error_of_the_channel_stretches_no_mount() -> None:
    s = sine(1.5, STROKE, 2.0, 1000.0, duty=DUTY)
    base = PLAIN | {"backlash.g": GAP, "mount_compliance.s_m": 2e-5}
    joint = get("backlash"), get("mount_compliance")
    alone = Model(joint).force(s, base)
    found = Model((*joint, get("force_offset"))).force(s, base | {"force_offset.F_z": 7.0})
    assert found == pytest.approx(alone + 7.0, abs=1e-12)


@pytest.mark.parametrize("preload", [3.0, 30.0])
def test_a_rod_that_rests_is_held_by_what_rubs(preload: float) -> None:
    """The yield force holds a preload; only what it cannot hold presses on the mount."""
    s, s_m = signals(np.zeros(50), x=np.zeros(50), duty=DUTY), 2e-5
    model = Model((get("mount_compliance"), get("gas_preload")))
    found = model.force(s, PLAIN | {"mount_compliance.s_m": s_m, "gas_preload.F_0": preload})
    assert found == pytest.approx(max(preload - Y, 0.0) / (1 + K * s_m))


RIGID = [e for e in catalogue() if e.name not in {"backlash", *get("mount_compliance").equivalents}]


@pytest.mark.few(3)
@pytest.mark.parametrize("seed", range(40))
def test_whatever_acts_a_stiff_mount_is_none_and_a_soft_one_drives_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mount, s = get("mount_compliance"), sine(1.5, STROKE, 2.0, 1000.0, duty=DUTY)
    others = [e for e in RIGID if e is not mount]
    chosen = tuple(others[i] for i in rng.choice(len(others), size=3, replace=False))
    values = dict(PLAIN)
    for e in chosen:
        for q in e.quantities:
            values[e.key(q.symbol)] = float(np.clip(q.start * rng.uniform(0.3, 3.0), q.low, q.high))
    try:
        rigid = Model(chosen).force(s, values)
        found = [
            Model((*chosen, mount)).force(s, values | {"mount_compliance.s_m": s_m})
            for s_m in (1e-11, 10 ** rng.uniform(-6.0, -3.5))
        ]
    except IncompatibleEffects:
        pytest.skip("no model has these together")
    assert np.sqrt(np.mean((found[0] - rigid) ** 2)) < 0.01 * np.ptp(rigid)
    assert np.abs(found[1]).max() < 3.0 * np.abs(rigid).max()
