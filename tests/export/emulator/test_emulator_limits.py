"""Whatever goes in, what comes out keeps the limits, as a checker of the times and values sees it.

`erdctl.mimic.check` shares no code with the emulator. A step without a usable dt is no moment: it
must not change anything.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from emulators import COMPILERS, Compiled, Emulated
from places import FIXTURES

from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters
from erdctl.mimic.check import breaches
from erdctl.model.amplifier import Amplifier

pytestmark = pytest.mark.skipif(not COMPILERS, reason="no C compiler")

RUNS = 1000
SAMPLES = 400
TABLE_2 = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
BAD = (np.nan, np.inf, -np.inf, 1e30, -1e30, 0.0, -1.0)
INPUT, STEP, HOT, FACTOR = 1, 2, 8, 16


@pytest.fixture(scope="module")
def emulator(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    return Compiled.of(write_emulator(TABLE_2, prefix="rr"), tmp_path_factory.mktemp("limits"))


@dataclass(frozen=True)
class Run:
    """One random run: limits, rows of inputs, and the time of each row."""

    amplifier: Amplifier
    hottest: float
    inputs: Any
    t: Any

    @classmethod
    def of(cls, seed: int) -> Run:
        rng = np.random.default_rng(seed)
        n = SAMPLES
        even = rng.choice([1e-4, 1e-3, 2e-3, 5e-3, 0.05])
        dt = np.full(n, even) if rng.random() < 0.6 else rng.uniform(0.1, 3.0, n) * even
        amplifier = Amplifier(
            duty_max=float(rng.choice([0.45, 1.0, rng.uniform(0.05, 1.0)])),
            resolution=float(rng.choice([0.0, 0.01, 0.001, 1 / 64, rng.uniform(1e-4, 0.04)])),
            slew=float(rng.choice([np.inf, 1.0, 50.0, rng.uniform(0.05, 20.0)])),
            update_rate=[None, 200.0, 1.0 / (3 * even), float(rng.uniform(5.0, 500.0))][
                rng.integers(4)
            ],
        )
        t = np.cumsum(dt) - dt[0]
        x, xdot = _motion(rng, t, even)
        duty = _duty(rng, n)
        temperature = 40.0 + np.cumsum(rng.normal(0.0, rng.choice([0.0, 2.0]), n))
        factors = np.ones((n, 3))
        for k in range(3):
            if rng.random() < 0.7:
                a, b = np.sort(rng.integers(0, n, 2))
                factors[a:b, k] = rng.random() if rng.random() < 0.7 else rng.random(b - a)
        inputs = np.column_stack([dt, x, xdot, duty, temperature, factors])
        if rng.random() < 0.5:
            for column in range(5):
                if column:  # not so many bad steps that nobody knows the time
                    inputs[rng.random(n) < 0.02, column] = rng.choice(BAD)
                else:
                    at = rng.choice(n // 8, 3, replace=False) * 8 + 4
                    inputs[at, 0] = rng.choice([0.0, -1.0, np.nan, np.inf])
        passed = np.where(np.isfinite(inputs[:, 0]) & (inputs[:, 0] > 0.0), inputs[:, 0], 0.0)
        passed[0] = 0.0
        return cls(amplifier, float(rng.uniform(35.0, 60.0)), inputs, np.cumsum(passed))

    def emulated(self, emulator: Compiled) -> Emulated:
        limits = EmulatorLimits(amplifier=self.amplifier)
        state = emulator.state(
            duty_max=self.amplifier.duty_max, resolution=self.amplifier.resolution,
            slew=limits.slew, update_period=limits.update_period, temperature_max=self.hottest,
        )  # fmt: skip
        return emulator.run(state, self.inputs)


def _motion(rng: np.random.Generator, t: Any, even: float) -> tuple[Any, Any]:
    if rng.random() < 0.2:  # no motion of this world
        return rng.normal(0.0, 0.05, len(t)), rng.normal(0.0, 1.0, len(t))
    w = rng.uniform(1.0, 0.5 / even, 3)
    a = rng.uniform(0.0, 0.3, 3)
    phase = t[:, None] * w + rng.uniform(0.0, 6.3, 3)
    return np.sin(phase) @ (a / w), np.cos(phase) @ a


def _duty(rng: np.random.Generator, n: int) -> Any:
    kind = rng.integers(4)
    if kind == 0:
        return np.full(n, rng.random())
    if kind == 1:
        return rng.random(n)
    if kind == 2:
        return np.repeat(rng.random(n // 20 + 1), 20)[:n]
    return 0.3 + 0.3 * np.sin(np.arange(n) / rng.uniform(2.0, 50.0))


def broken(emulator: Compiled, seed: int) -> tuple[list[Any], int]:
    """What a run breaks, and how often its output changes."""
    run = Run.of(seed)
    out = run.emulated(emulator)
    assert np.isfinite(out.duty).all()
    stood = np.diff(run.t, prepend=-1.0) <= 0.0
    assert np.array_equal(out.duty[stood], out.duty[np.flatnonzero(stood) - 1])
    duty, t = out.duty[~stood], run.t[~stood]
    found = breaches(duty, t, np.array([0, len(t)]), run.amplifier)
    return [b.limit for b in found], np.count_nonzero(np.diff(duty))


def test_limits_are_never_broken(emulator: Compiled) -> None:
    changed = 0
    for seed in range(RUNS):
        found, changes = broken(emulator, seed)
        assert not found, f"seed {seed}: {found}"
        changed += changes
    assert changed > 50 * RUNS


@pytest.mark.parametrize(
    ("right", "wrong", "limit"),
    [
        ("inside = clamped(wanted, K(0.0), top)", "inside = wanted", "duty"),
        ("? of_steps(FLOOR(p->duty_max", "? of_steps(CEIL(p->duty_max", "highest duty"),
        ("inside / p->resolution), p->res", "inside / p->resolution), K(1.01) * p->res", "resol"),
        (
            "s->p.update_period * (K(1.0) -",
            "s->p.update_period * (K(0.9) -",
            "time between updates",
        ),
        ("reach = slew *", "reach = K(1.1) * slew *", "slew"),
        ("<= slew * s->since_change", "<= K(2.0) * slew * s->since_change", "slew"),
    ],
)
def test_a_broken_emulator_would_be_seen(
    right: str, wrong: str, limit: str, tmp_path: Path
) -> None:
    block = write_emulator(TABLE_2, prefix="broken")
    assert block.source.count(right) == 1
    bad = Compiled.of(replace(block, source=block.source.replace(right, wrong)), tmp_path)
    assert any(limit in b for seed in range(100) for b in broken(bad, seed)[0])


def test_heat_closes_the_output_as_fast_as_the_limits_let_it(emulator: Compiled) -> None:
    closed = 0
    for seed in range(RUNS):
        run = Run.of(seed)
        out = run.emulated(emulator)
        hot = ~(run.inputs[:, 4] <= run.hottest)
        assert (out.status[hot] & HOT).all(), seed
        shut = (out.status & HOT) != 0
        falls = np.diff(out.duty)[shut[1:]]
        assert (falls <= 0.0).all(), seed
        if np.isinf(run.amplifier.slew) and run.amplifier.update_rate is None:
            stood = np.diff(run.t, prepend=-1.0) <= 0.0
            assert not out.duty[shut & ~stood].any(), seed
            closed += np.count_nonzero(shut)
    assert closed > RUNS


def test_heat_opens_again_below_the_hysteresis(emulator: Compiled) -> None:
    temperature = np.array([59.0, 60.0, 60.1, 58.0, 55.1, 55.0, 59.9, np.nan, 57.0, 54.0, -np.inf])
    inputs = np.tile([0.001, 0.0, 0.1, 0.3, 0.0, 1.0, 1.0, 1.0], (len(temperature), 1))
    inputs[:, 4] = temperature
    out = emulator.run(emulator.state(), inputs)
    opened = [1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0]
    assert out.duty.tolist() == [0.3 * o for o in opened]
    assert (((out.status & HOT) == 0) == np.array(opened, dtype=bool)).all()
    assert (out.limited == (out.duty == 0.0)).all()


@pytest.mark.parametrize("seed", range(20))
def test_a_float_keeps_them_too(seed: int, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Within what a float can hold: a duty of 0.3 is 1e-8 beside it, and so is a time."""
    single = _single(tmp_path_factory)
    run = Run.of(seed)
    out = run.emulated(single)
    assert np.isfinite(out.duty).all()
    assert (out.duty >= 0.0).all()
    assert (out.duty <= run.amplifier.duty_max * (1 + 1e-6)).all()
    if np.isfinite(run.amplifier.slew) and run.amplifier.update_rate is None:
        size, dt = np.abs(np.diff(out.duty)), np.diff(run.t)
        step = run.amplifier.resolution
        allowed = np.maximum(run.amplifier.slew * dt, step)
        assert (size <= allowed * (1 + 1e-4) + 1e-6)[dt > 0].all()


_SINGLE: list[Compiled] = []


def _single(factory: pytest.TempPathFactory) -> Compiled:
    if not _SINGLE:
        block = write_emulator(TABLE_2, prefix="single")
        _SINGLE.append(Compiled.of(block, factory.mktemp("float"), options=("-DERDCTL_FLOAT",)))
    return _SINGLE[0]
