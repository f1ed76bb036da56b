"""Dyno curves, misfit and yield points against forces with known answers."""

from __future__ import annotations

import json

import numpy as np
import oracle
import pytest
from places import FIXTURES
from rig import campaign, recording

from erdctl.bench.drive import drives
from erdctl.bench.dyno import averaged, peak_force, slow_test
from erdctl.core.errors import InputProblem
from erdctl.io.parameters import parse_parameters
from erdctl.score.misfit import along, edges_of, misfit_map
from erdctl.score.yield_points import yield_points


def test_peak_force_of_a_viscous_damper() -> None:
    drive = drives(["sine:freq=1,amp=0.0159155,duration=5", "sine:freq=2,amp=0.004,duration=5"])
    found = peak_force(drive, 100.0 * drive.xdot)
    fast = found.velocity[np.abs(found.velocity) > 0.09]
    assert np.abs(fast) == pytest.approx(0.1, rel=1e-3)
    # The mean over the highest 3 % of the speed is 1 % below the peak.
    assert found.force / found.velocity == pytest.approx(np.full(len(found.force), 99.0), rel=0.006)
    v, force = found.line(0)
    assert v == pytest.approx([-0.1, -0.0502655, 0.0502655, 0.1], rel=0.01)
    assert force == pytest.approx(99.0 * v, rel=0.006)


def test_peak_force_leaves_out_strokes_with_a_duty_step() -> None:
    drive = drives(["sine:freq=1,duration=6,duty=0.1|0.3,hold=3.1"])
    found = peak_force(drive, drive.xdot)
    steps = 3.1
    reversals = 0.25 + 0.5 * np.arange(11)
    clear = [a > 0.0 and not (a < steps < a + 0.5 or steps < a < steps + 0.3) for a in reversals]
    assert len(found.force) == sum(clear)
    assert set(found.levels[found.code]) == {0.1, 0.3}


def test_steady_strokes_make_the_line() -> None:
    """A wandering record adds dots, and does not bend the line of the steady one."""
    steady = drives(["sine:freq=1,amp=0.0159155,duration=5"])
    both = drives(["sine:freq=1,amp=0.0159155,duration=5", "noise:rms=0.004,f_max=2,duration=20"])
    force = 100.0 * both.xdot + np.where(np.arange(len(both)) < len(steady), 0.0, 50.0)
    found = peak_force(both, force)
    assert len(found.force) > 2 * found.steady.sum() > 0
    v, line = peak_force(steady, 100.0 * steady.xdot).line(0)
    known = found.line(0)
    assert set(np.round(v, 3)) <= set(np.round(known[0], 3))
    at = [int(np.abs(known[0] - a).argmin()) for a in v]
    assert known[1][at] == pytest.approx(line)


def test_averaged_curve_is_the_law() -> None:
    drive = drives(["sine:freq=1,amp=0.0159155,duration=20,duty=0.2"])
    loop = 5.0 * np.sign(np.gradient(drive.xdot))  # opening and closing branch 10 N apart
    found = averaged(drive, 100.0 * drive.xdot + loop)
    inner = np.abs(found.velocity) < 0.09
    assert found.levels.tolist() == [0.2]
    assert found.force[0][inner] == pytest.approx(100.0 * found.velocity[inner], abs=0.35)
    assert found.spread[0][inner] == pytest.approx(np.full(inner.sum(), 5.0), rel=0.02)


def test_slow_test_check_value() -> None:
    drive = drives(["triangle:speed=0.001,amp=0.01,duration=80,fs=50"])
    found = slow_test(drive, 200.0 * drive.x + 3.0 * np.sign(drive.xdot))
    assert found.gas == pytest.approx(200.0 * found.x, abs=0.15)  # a bin is 0.67 mm wide
    assert found.drag == pytest.approx(np.full(len(found.x), 3.0), abs=0.15)


def test_a_fast_test_shows_no_drag() -> None:
    drive = drives(["triangle:speed=0.05"])
    with pytest.raises(InputProblem, match="record a slow test"):
        slow_test(drive, drive.x)
    driven = drives(["triangle:speed=0.001,duty=0.3"])
    with pytest.raises(InputProblem, match="without field"):
        slow_test(driven, driven.x)


def test_misfit_map_finds_the_cell() -> None:
    drive = drives(["sine:freq=1,duration=9,duty=0.1|0.3,hold=1"])
    missed = (drive.duty == 0.3) & (drive.xdot > 0.03)
    found = misfit_map(drive, np.where(missed, 4.0, 1.0), bins=8)
    middle = 0.5 * (found.edges[1:] + found.edges[:-1])
    assert found.levels.tolist() == [0.1, 0.3]
    assert found.count.sum() == len(drive)
    assert found.rms[0] == pytest.approx(np.ones(8))
    assert found.rms[1][middle > 0.035] == pytest.approx(4.0)
    assert found.rms[1][middle < 0.02] == pytest.approx(1.0)


def test_two_samples_make_no_map() -> None:
    drive = drives(["sine:fs=10,duration=0.2"])
    with pytest.raises(InputProblem, match="too few for a map of the misfit: 2 samples"):
        misfit_map(drive, drive.x)


def test_along_a_variable() -> None:
    values = np.array([0.0, 0.1, 0.1, 0.1, 0.1, 1.0, np.inf, -3.0])
    edges = np.array([0.0, 0.5, 1.0])
    residual = np.array([3.0, 1, 1, 1, 1, 9, 9, 9])
    found = along(values, residual, edges)
    assert found[0] == pytest.approx(np.sqrt(13 / 5))
    assert np.isnan(found[1])  # one sample says nothing
    assert edges_of(np.array([1.0, np.inf, 3.0]), 2).tolist() == [1.0, 2.0, 3.0]
    assert len(edges_of(np.full(4, 2.0))) == 2


def test_yield_points_are_the_law() -> None:
    parameters = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
    up, down = yield_points(campaign(), parameters)
    for points, branch in ((up, oracle.TABLE_2.compression), (down, oracle.TABLE_2.release)):
        law = branch.sigma * points.duty**branch.beta
        # After a reversal the shared state still comes from the other direction's value.
        other = oracle.TABLE_2.release if points is up else oracle.TABLE_2.compression
        gap = np.abs(other.sigma * points.duty**other.beta - law)
        assert np.all(np.abs(points.force - law) <= gap + 1e-6)
        assert np.all(np.abs(points.force - law) < 0.5 * gap + 1e-2)


def test_yield_points_take_the_effects_away() -> None:
    document = json.loads((FIXTURES / "table_2.json").read_text())
    plain = parse_parameters(json.dumps(document).encode(), "p")
    document["effects"] = [{"effect": "gas_preload", "parameters": {"F_0": 7.0}}]
    rubbing = parse_parameters(json.dumps(document).encode(), "p")
    t = np.arange(3000) / 500
    w = 2 * np.pi
    clean = recording(t, 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t), np.full_like(t, 0.2))
    assert clean.force is not None
    raised = clean.take(slice(None), clean.starts, clean.names)
    object.__setattr__(raised, "force", clean.force + 7.0)
    expected = yield_points(clean, plain)
    for a, b in zip(yield_points(raised, rubbing), expected, strict=True):
        assert a.force == pytest.approx(b.force)
