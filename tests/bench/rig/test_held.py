"""A deflection or a force that is read at a slower rate than the log, and what is none."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from places import FIXTURES
from rig_errors import held

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.rig import look
from erdctl.bench.rig.holding import hold
from erdctl.core.recording import DERIVED, Array, Recording
from erdctl.io.logs import read_logs

T = np.arange(8000) / 1000.0
SINE = 0.02 * np.sin(2 * pi * T)  # [m]
TRIANGLE = 0.0437 * np.abs((T / 1.037 + 0.25) % 1.0 - 0.5)


@pytest.fixture(scope="module")
def good() -> Recording:
    path = str(FIXTURES / "healthy_campaign.parquet")
    return read_logs([path], need_force=True, report=lambda line: None).recording


def derived(r: Recording) -> Recording:
    xdot, note = derive_xdot(r.t, r.x, r.starts)
    return replace(r, xdot=xdot, xdot_note=note)


def off(found: Array, true: Array) -> float:
    return float(np.std(found - true) / np.std(true))


@pytest.mark.parametrize("motion", [SINE, TRIANGLE])
@pytest.mark.parametrize("over", [2.0, 3.0, 5.0, 10.0, 2.5, 7.3])
@pytest.mark.parametrize("digit", [0.0, 1e-5])
def test_the_rate_of_what_is_held(motion: Array, over: float, digit: float) -> None:
    x = np.round(motion / digit) * digit if digit else motion
    assert hold(held(x, over)) == pytest.approx(over, rel=0.02)


@pytest.mark.parametrize("late", [0.05, 0.3])
def test_a_bus_that_is_now_and_then_a_sample_late(late: float) -> None:
    """10 samples, some of them 11 and the next ones 9."""
    random = np.random.default_rng(4)
    read = np.arange(0, len(T), 10)
    read += random.random(len(read)) < late
    at = read[np.maximum(np.searchsorted(read, np.arange(len(T)), side="right") - 1, 0)]
    assert hold(SINE[at]) == pytest.approx(10.0, rel=0.05)


@pytest.mark.parametrize("digits", [20, 50, 100, 400, 2000])
@pytest.mark.parametrize("noise", [0.0, 0.2, 0.5, 1.0])
def test_a_coarse_digit_is_no_hold(digits: int, noise: float) -> None:
    """Of a sine, of a triangle with a step for every few samples, and of a motion with rests."""
    random = np.random.default_rng(digits)
    rests = np.clip(SINE, -0.01, 0.015)
    for motion in (SINE, TRIANGLE, rests):
        digit = float(np.ptp(motion)) / digits
        x = motion + noise * digit * random.standard_normal(len(motion))
        assert hold(np.round(x / digit) * digit) == 1.0


def test_a_deflection_that_is_held_is_taken_as_it_goes_on(good: Recording) -> None:
    """A slow bus was told as a velocity channel with noise and a late force channel."""
    assert look(good).faults == ()
    r = derived(replace(good, x=held(good.x, 5.0, good.starts)))
    rig = look(r)
    (fault,) = rig.faults
    assert (fault.code, fault.record, fault.samples) == ("x_held", None, None)
    assert "held over 5 samples: it is read at 100 Hz in a log of 500 Hz, in all" in fault.text
    usable = rig.usable()
    assert usable.xdot_note.startswith(DERIVED)
    assert off(r.xdot, good.xdot) > 0.05
    assert off(usable.xdot, good.xdot) < 0.005
    assert off(usable.x, good.x) < 1e-3
    assert rig.accept(["x_held"]).usable() is r


def test_a_measured_velocity_stays_unless_it_is_held_too(good: Recording) -> None:
    r = replace(good, x=held(good.x, 5.0, good.starts))
    rig = look(r)
    assert [f.code for f in rig.faults] == ["x_held"]
    usable = rig.usable()
    np.testing.assert_array_equal(usable.xdot, good.xdot)
    assert usable.xdot_note == "measured"
    assert off(usable.x, good.x) < 1e-3
    both = look(replace(r, xdot=held(good.xdot, 5.0, good.starts)))
    assert [f.code for f in both.faults] == ["x_held"]
    assert off(both.usable().xdot, good.xdot) < 0.005
    assert both.usable().xdot_note.startswith(DERIVED)


@pytest.mark.parametrize("over", [3.0, 5.0, 10.0])
def test_a_corner_between_two_samples_is_no_loss(good: Recording, over: float) -> None:
    """The curve goes round it, where a measured velocity does not: "samples were lost"."""
    part, x, xdot = good.slices[7], good.x.copy(), good.xdot.copy()
    turns = (good.t[part] / 1.037 + 0.25) % 1.0 - 0.5
    x[part] = 0.0437 * np.abs(turns)
    xdot[part] = 0.0437 / 1.037 * np.sign(turns)
    r = replace(good, x=held(x, over, good.starts), xdot=xdot)
    assert not {"x_jumps", "x_spikes"} & {f.code for f in look(r).faults}


def test_a_force_that_is_held_counts_once(good: Recording) -> None:
    assert good.force is not None
    rig = look(replace(good, force=held(good.force, 4.0, good.starts)))
    (fault,) = rig.faults
    assert (fault.code, fault.record) == ("force_held", None)
    excluded = rig.usable().excluded
    assert excluded is not None
    first = np.concatenate([np.arange(p.start, p.stop, 4) for p in good.slices])
    np.testing.assert_array_equal(np.flatnonzero(~excluded), first)


def test_the_records_in_which_it_is_held_are_said(good: Recording) -> None:
    """The others, and a rest and a stop at a limit in it, are as they were."""
    x = good.x.copy()
    part = good.slices[7]
    x[part] = held(x[part], 5.0)
    (fault,) = look(replace(good, x=x)).faults
    assert (fault.code, fault.record) == ("x_held", 7)
    usable = look(replace(good, x=x)).usable()
    inside = np.zeros(len(good), dtype=bool)
    inside[part] = True
    np.testing.assert_array_equal(usable.x[~inside], good.x[~inside])
    x, other = x.copy(), good.slices[9]
    x[other] = held(x[other], 10.0)
    (fault,) = look(replace(good, x=x)).faults
    assert fault.record is None
    assert "held over 5 to 10 samples: it is read at 50 to 100 Hz" in fault.text
    assert fault.text.endswith(f"in the records '{good.names[7]}', '{good.names[9]}'")


def test_a_record_that_moves_faster_than_it_is_read_is_left_out(good: Recording) -> None:
    """Of a road up to 25 Hz that is read at 50 Hz; a measured velocity does tell it."""
    random, x, xdot = np.random.default_rng(6), good.x.copy(), good.xdot.copy()
    part = good.slices[7]
    t = good.t[part]
    x[part] = xdot[part] = 0.0
    for f in np.arange(8.0, 25.0, 0.7):
        omega, phase = 2.0 * pi * f, random.uniform(0.0, 2.0 * pi)
        x[part] += 2e-4 * np.sin(omega * t + phase)
        xdot[part] += 2e-4 * omega * np.cos(omega * t + phase)
    r = replace(good, x=held(x, 10.0, good.starts), xdot=xdot)
    assert not any(f.blocks for f in look(r).faults)
    rig = look(derived(r))
    assert [f.record for f in rig.faults if f.code == "x_held"] == [None, 7]
    assert [f.record for f in rig.faults if f.blocks] == [7]
    assert good.names[7] not in rig.usable().names
