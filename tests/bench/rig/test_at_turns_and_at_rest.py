"""What no damper does at a turn, and what friction holds at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy
from scipy.signal import lfilter

from erdctl.bench.rig import look
from erdctl.core.recording import Recording


def log(seed: int) -> Recording:
    return noisy(campaign(200.0, 6.0), seed, 0.3)


@pytest.mark.parametrize("after", [0, 1, 3])
def test_a_spike_at_a_turn_is_none_of_the_turn(after: int) -> None:
    """Ten times what the force spans; it stayed, beside an `adequate` verdict and 412 N of peak."""
    r = log(61)
    own = r.slices[-1]
    turn = own.start + int(np.flatnonzero(np.diff(np.sign(r.xdot[own])))[2]) + 1
    force = r.force.copy()
    force[turn + after] += 10.0 * np.ptp(force[own])
    faults = look(replace(r, force=force)).faults
    assert [(f.code, f.record) for f in faults] == [("force_spikes", len(r.names) - 1)]


def friction(seed: int) -> Recording:
    """Six records of the paper's damper with 4 N of friction; the rod of the fourth is at rest."""
    random, rate, seconds = np.random.default_rng(seed), 200.0, 4.0
    t = np.arange(round(rate * seconds)) / rate
    parts = []
    for number in range(6):
        w, a = 2.0 * np.pi * (1.0, 2.3, 0.6)[number % 3], (0.010, 0.006, 0.014)[number % 3]
        phase, duty = random.uniform(0.0, 6.0), 0.1 * ((t.astype(int) + number) % 4)
        x = a * np.sin(w * t + phase) + 0.3 * a * np.sin(1.7 * w * t + 2.0 * phase)
        xdot = a * w * np.cos(w * t + phase) + 0.51 * a * w * np.cos(1.7 * w * t + 2.0 * phase)
        force = np.where(xdot > 0, 263.0, 170.0) * x + 66.0 * xdot
        late = np.exp(-1.0 / (0.043 * rate))
        yields = lfilter([0.0, 1.0 - late], [1.0, -late], np.where(xdot > 0, 128.0, 170.0) * duty)
        force += (4.0 + yields) * np.sign(xdot)
        if number == 3:
            x, xdot, force = 0.0 * x + 0.002, 0.0 * x, np.full(len(t), 0.6)
        force = force + 0.3 * random.normal(size=len(t))
        parts.append((t, x, xdot, duty, force))
    t, x, xdot, duty, force = (np.concatenate(c) for c in zip(*parts, strict=True))
    starts = np.arange(7) * round(rate * seconds)
    return Recording(
        t=t, x=x, xdot=xdot, duty=duty, force=force, starts=starts,
        names=tuple(f"r{k}" for k in range(6)),
    )  # fmt: skip


@pytest.mark.parametrize("seed", [65, 72])
def test_a_record_at_rest_has_no_zero_of_its_own(seed: int) -> None:
    """What friction holds there was a zero of 9.6 N beside others (in 2 of 40 such logs)."""
    assert look(friction(seed)).lines() == []


def test_records_that_are_all_at_rest_are_not_held_against_each_other() -> None:
    r = friction(65)
    still = np.zeros(len(r))
    force = np.repeat([0.6, -3.0, 2.0, 4.0, 0.1, -0.5], np.diff(r.starts))
    force = force + 0.3 * np.random.default_rng(65).normal(size=len(r))
    codes = {f.code for f in look(replace(r, x=still, xdot=still, force=force)).faults}
    assert not codes & {"record_offset", "record_gain", "record_lag"}


def test_a_gap_of_seconds_is_said_in_s() -> None:
    """It was "the longest of 1205 ms"."""
    r = log(61)
    t = r.t.copy()
    own = r.slices[0]
    t[own.start + 500 : own.stop] += 1.2
    (fault,) = [f for f in look(replace(r, t=t)).faults if f.code == "samples_missing"]
    assert "the longest of 1.205 s at t =" in fault.text
