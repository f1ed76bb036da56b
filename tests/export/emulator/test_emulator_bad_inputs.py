"""Inputs that no one should give: a defined output, and a status that says so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from emulators import COMPILERS, Compiled, Emulated
from places import FIXTURES

from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters

pytestmark = pytest.mark.skipif(not COMPILERS, reason="no C compiler")

TABLE_2 = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
OK, INPUT, STEP, DUTY, HOT, FACTOR, PARAMETER, STUCK = 0, 1, 2, 4, 8, 16, 32, 64
DT, X, XDOT, V, TEMPERATURE, OIL, ELECTRICAL, DEFORMATION = range(8)
NO_NUMBERS = (np.nan, np.inf, -np.inf)
DRIVER_LAYOUT = [0.001, 0.005, 0.1, 0.3, 25.0, 1.0, 1.0, 1.0]


@pytest.fixture(scope="module")
def emulator(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    return Compiled.of(write_emulator(TABLE_2, prefix="fr"), tmp_path_factory.mktemp("bad"))


def driven(n: int) -> Any:
    """(n, 8) rows of a 3 Hz motion at 1 kHz with an oil leakage."""
    t = 0.001 * np.arange(n)
    rows = np.tile(DRIVER_LAYOUT, (n, 1))
    rows[:, X], rows[:, XDOT] = 0.008 * np.sin(18.85 * t), 0.15 * np.cos(18.85 * t)
    rows[:, OIL] = 0.7
    return rows


def run(emulator: Compiled, rows: Any, **limits: float) -> Emulated:
    out = emulator.run(emulator.state(**limits), rows)
    assert np.isfinite(out.duty).all()
    assert (out.duty >= 0.0).all()
    assert (out.duty <= 0.45).all()
    return out


@pytest.mark.parametrize("bad", [*NO_NUMBERS, 1e7, -1e7])
@pytest.mark.parametrize("column", [X, XDOT, V])
def test_one_bad_sample_is_held(emulator: Compiled, column: int, bad: float) -> None:
    rows = driven(100)
    rows[50, column] = bad
    out = run(emulator, rows)
    assert out.duty[50] == out.duty[49] > 0.0
    assert out.status[50] == INPUT
    assert out.limited[50]
    assert not out.status[51:].any()
    # It takes up again where it would have been.
    good = run(emulator, driven(100))
    assert np.abs(out.duty[60:] - good.duty[60:]).max() < 0.02


@pytest.mark.parametrize("column", [X, XDOT, V])
def test_bad_for_long_goes_to_zero(emulator: Compiled, column: int) -> None:
    rows = driven(100)
    rows[50:, column] = np.nan
    out = run(emulator, rows)
    assert out.duty[50] == out.duty[49]
    assert not out.duty[51:].any()
    assert (out.status[50:] == INPUT).all()
    held = run(emulator, rows, update_period=0.01).duty
    assert held[50] > 0.0
    assert (held[50:59] == held[50]).all(), "for one update period"
    assert not held[60:].any()
    slewed = run(emulator, rows, slew=20.0).duty
    assert np.diff(slewed[50:]).min() > -0.0201, "as fast as the slew limit lets it"
    assert not slewed[90:].any()


def test_bad_from_the_first_sample(emulator: Compiled) -> None:
    rows = driven(50)
    rows[:10, XDOT] = np.nan
    out = run(emulator, rows, slew=5.0)
    assert not out.duty[:10].any()
    assert (np.diff(out.duty) <= 5.0 * 0.001 * (1 + 1e-9)).all(), "from the 0 that it gave out"
    assert out.duty[-1] > 0.05


@pytest.mark.parametrize("dt", [0.0, -0.001, 1e-12, 1e7, *NO_NUMBERS])
def test_step_without_time_changes_nothing(emulator: Compiled, dt: float) -> None:
    rows = driven(60)
    bad = np.insert(rows, 30, rows[30], axis=0)
    bad[30, DT], bad[30, X : V + 1] = dt, (0.5, -3.0, 0.1)  # and whatever else it brings
    out, good = run(emulator, bad), run(emulator, rows)
    assert out.status[30] == STEP
    assert np.array_equal(np.delete(out.duty, 30), good.duty)
    assert out.duty[30] == out.duty[29]


@pytest.mark.parametrize("dt", [0.0, -0.001, np.nan])
def test_a_dead_clock_closes(emulator: Compiled, dt: float) -> None:
    rows = driven(60)
    rows[30:50, DT] = dt
    out = run(emulator, rows, slew=1.0)
    assert (out.duty[30:38] == out.duty[29]).all()
    assert not out.duty[38:50].any()
    assert (out.status[30:50] == STEP).all()
    assert out.limited[38:50].all()
    assert not out.status[50:].any()
    assert (np.diff(out.duty[49:]) <= 0.001 * (1 + 1e-9)).all()


def test_the_first_step_is_of_no_weight(emulator: Compiled) -> None:
    for dt in (*NO_NUMBERS, 0.0, -1.0, 5.0):
        rows = driven(60)
        rows[0, DT] = dt
        out = run(emulator, rows)
        assert not out.status.any()
        assert np.array_equal(out.duty, run(emulator, driven(60)).duty)


@pytest.mark.parametrize(("duty", "taken"), [(1.5, 0.45), (-0.2, 0.0), (1.0, 0.45)])
def test_duty_outside_its_range(emulator: Compiled, duty: float, taken: float) -> None:
    rows = driven(20)
    rows[:, OIL], rows[:, V] = 1.0, duty
    out = run(emulator, rows)
    assert (out.duty == taken).all()
    assert (out.status == (OK if duty == 1.0 else DUTY)).all()
    assert out.limited.all() == (taken == 0.45)


@pytest.mark.parametrize("column", [OIL, ELECTRICAL, DEFORMATION])
def test_factors(emulator: Compiled, column: int) -> None:
    rows = driven(60)
    rows[:, OIL] = 1.0
    rows[20:, column] = 0.6
    good = run(emulator, rows)
    assert not good.status.any()
    rows[40:50, column] = np.nan
    out = run(emulator, rows)
    assert (out.status[40:50] == FACTOR).all()
    assert np.array_equal(out.duty, good.duty), "the one before holds"
    rows[40:50, column] = -3.0
    low = run(emulator, rows)
    rows[40:50, column] = 0.0
    assert np.array_equal(low.duty, run(emulator, rows).duty)
    rows[:, column] = 7.0
    high = run(emulator, rows)
    assert (high.status == FACTOR).all()
    assert (high.duty == 0.3).all()


def test_a_sensor_that_stands_is_told(emulator: Compiled) -> None:
    for column in (X, XDOT):
        rows = driven(1000)
        rows[300:, column] = rows[300, column]
        out = run(emulator, rows)
        assert not out.status[:310].any()
        assert (out.status[300:] & STUCK).any()
    assert not run(emulator, driven(1000)).status.any()


def test_a_damper_at_rest_is_not_stuck(emulator: Compiled) -> None:
    rows = np.tile(DRIVER_LAYOUT, (5000, 1))
    rows[:, XDOT] = 0.0
    assert not run(emulator, rows).status.any()
    even = np.tile(DRIVER_LAYOUT, (500, 1))  # a stroke at constant speed
    even[:, X] = 0.1 * 0.001 * np.arange(500)
    assert not run(emulator, even).status.any()


@pytest.mark.parametrize("bad", [*NO_NUMBERS, -1.0])
def test_parameters_that_cannot_be_used(emulator: Compiled, bad: float) -> None:
    for name in emulator.names:
        if name == "temperature_max" and bad == -1.0:
            continue
        out = run(emulator, driven(20), **{name: bad})
        assert not out.duty.any(), name
        assert (out.status & (PARAMETER | HOT)).all(), name
        assert out.limited.all()


def test_every_kind_of_nonsense_at_once(emulator: Compiled) -> None:
    rng = np.random.default_rng(8)
    odd = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, 1e6, -1e6, 5e-324, 1e308, -1e308, 1.0, 0.3])
    rows = rng.choice(odd, (200_000, 8))
    out = run(emulator, rows)
    assert (out.status != OK).mean() > 0.9


def test_state_is_plain_data(emulator: Compiled) -> None:
    """A copy half-way goes on to the same end, bit for bit."""
    state, rows = emulator.state(slew=10.0, update_period=0.004), driven(500)
    emulator.run(state, rows[:250])
    kept = state.copy()
    first = emulator.run(state, rows[250:]).duty
    assert np.array_equal(emulator.run(kept, rows[250:]).duty, first)


def test_exported_faults_alone_count(tmp_path: Any) -> None:
    from erdctl.model.faults import FaultKind

    block = write_emulator(TABLE_2, prefix="some", faults=[FaultKind.ELECTRICAL])
    some = Compiled.of(block, tmp_path)
    out = run(some, driven(50))
    assert (out.duty == 0.3).all()
    rows = driven(50)
    rows[:, ELECTRICAL] = 0.5
    assert (run(some, rows).duty < 0.3).all()
