"""A record whose deflection has a gain of its own, or whose damper was mounted the other way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from measure_motion import CODES, with_gains
from steady_sines import steady_sines

from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Array, Recording

LEVELS, MOTIONS = (0.0, 0.1, 0.2), ((0.2, 0.03), (1.5, 0.01), (4.0, 0.004))  # [1]; [Hz], [m]
AT = 4  # of the nine records the second of the second level


def sines() -> Recording:
    """Three levels by three motions, with other forces in release than in compression."""

    def force(x: Array, v: Array, u: Array) -> Array:
        up = v > 0
        spring, damping = np.where(up, 170.0, 250.0) * x, np.where(up, 50.0, 30.0) * v
        return np.asarray(spring + damping + np.where(up, 20.0, -35.0) * u**0.5)

    return steady_sines(LEVELS, MOTIONS, force, noise=0.05)


def said(r: Recording) -> list[RigFault]:
    return [f for f in look(r).faults if f.code in CODES]


@pytest.mark.parametrize("gain", [0.1, 0.4, 1.2, 2.5])
def test_a_deflection_of_another_gain(gain: float) -> None:
    """Of 2.5 times in one of 24 records nothing was said but that the misfit lies in it."""
    assert said(sines()) == []
    (fault,) = said(with_gains(sines(), AT, gain, 1.0))
    assert (fault.code, fault.record, fault.blocks) == ("record_deflection", AT, True)
    told = float(fault.text.split("velocity are ")[1].split(" times")[0])
    assert told == pytest.approx(gain, rel=0.03)


def test_a_damper_that_was_mounted_the_other_way() -> None:
    (fault,) = said(with_gains(sines(), AT, -1.0, -1.0))
    assert (fault.code, fault.record, fault.blocks) == ("record_turned", AT, True)


@pytest.mark.parametrize("gain", [1.1, 0.91])
def test_what_a_transducer_is_off_by_is_none(gain: float) -> None:
    assert said(with_gains(sines(), AT, gain, 1.0)) == []


def test_what_a_gain_leaves_is_none() -> None:
    """Behind a motion that is 2.5 times too large, a force that has lost its shape."""
    r = with_gains(sines(), AT, 2.5, 1.0)
    force, part = np.array(r.force), r.slices[AT]
    assert r.force is not None
    force[part] += 5.0 * np.sin(2 * np.pi * 11.0 * r.t[part])
    assert said(replace(r, force=force)) == []


@pytest.mark.parametrize("apart", [0.0, 0.004])
@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_a_damper_that_is_nearly_alike_both_ways_is_not_turned(apart: float, noise: float) -> None:
    """Simulated, without noise: what rounding leaves said so of a third of all records."""

    def force(x: Array, v: Array, u: Array) -> Array:
        both = 170.0 * x + 50.0 * v + 20.0 * u**0.5 * np.sign(v)
        return np.asarray(np.where(v > 0, 1.0, 1.0 + apart) * both)

    r = steady_sines(LEVELS, MOTIONS, force, noise)
    assert said(r) == []
    assert said(with_gains(r, AT, -1.0, -1.0)) == []


def test_two_of_them() -> None:
    r = with_gains(with_gains(sines(), AT, 3.0, 1.0), 6, 0.3, 1.0)
    assert {f.record for f in said(r)} == {AT, 6}


def test_what_changes_in_the_damper_is_none() -> None:
    """A warm fluid has another viscosity, a damper that has lost gas another spring; not both."""
    r = sines()
    up = r.xdot > 0
    stiffer, thicker = 2.0 * np.where(up, 170.0, 250.0) * r.x, np.where(up, 50.0, 30.0) * r.xdot
    # In the slow record the spring is most of what goes with the motion, in the fast one little.
    for k in (AT - 1, AT, AT + 1):
        for more in (stiffer, thicker):
            force = np.array(r.force)
            force[r.slices[k]] += more[r.slices[k]]
            assert said(replace(r, force=force)) == []


def test_a_gain_of_the_force_is_none() -> None:
    assert said(with_gains(sines(), AT, 1.0, 2.0)) == []


def test_another_yield_force_beside_it_is_none() -> None:
    """Of a motion twice as large behind a duty that is twice as high nobody knows what is wrong."""
    r = sines()
    force = np.array(r.force)
    force[r.slices[AT]] *= 2.0
    force[r.slices[AT]] += 3.0 * np.sign(r.xdot[r.slices[AT]])
    assert said(replace(r, force=force)) == []


def test_without_a_force_that_stays_as_it_is_nothing_tells() -> None:
    """At no duty and without friction twice the motion is half of the force's gain."""
    assert said(with_gains(sines(), 1, 2.0, 1.0)) == []
