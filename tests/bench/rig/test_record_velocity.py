"""One record whose measured velocity is not that of its deflection, and what is none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import quarter_car
from places import FIXTURES

from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Recording
from erdctl.io.logs import read_logs

AT = 7


def read(path: Path) -> Recording:
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


@pytest.fixture(scope="module")
def good() -> Recording:
    return read(FIXTURES / "healthy_campaign.parquet")


def spoiled(r: Recording, gain: float = 1.0, late: int = 0) -> Recording:
    """xdot of a record times a gain, and so many samples later."""
    xdot, part = r.xdot.copy(), r.slices[AT]
    xdot[part] = gain * np.roll(xdot[part], late)
    return replace(r, xdot=xdot)


def faults(r: Recording) -> list[RigFault]:
    return [f for f in look(r).faults if f.record is not None]


@pytest.mark.parametrize("gain", [0.8, 1.2])
def test_its_gain(good: Recording, gain: float) -> None:
    """Nothing was said of it, and the diagnosis looked for physics."""
    assert faults(good) == []
    (fault,) = faults(spoiled(good, gain))
    assert (fault.code, fault.record, fault.blocks) == ("record_velocity", AT, True)
    assert f"its xdot is {gain:.3g} times the derivative of its x" in fault.text


def test_what_channels_differ_by_is_none(good: Recording) -> None:
    """However little the other records scatter."""
    assert faults(spoiled(good, 1.07)) == []


@pytest.mark.parametrize("late", [-8, 8])
def test_its_lag(good: Recording, late: int) -> None:
    """It was a force that is early, and the clocks of both channels to be looked at."""
    (fault,) = faults(spoiled(good, late=late))
    assert (fault.code, fault.record, fault.blocks) == ("record_velocity", AT, True)
    assert ("later" if late > 0 else "earlier") in fault.text
    assert "16" in fault.text  # ms, at 500 Hz


@pytest.mark.long
def test_a_record_that_hardly_moves_has_none(tmp_path: Path) -> None:
    """A velocity that is noise for the most part goes with no deflection."""
    table = quarter_car.log(102, 100, velocity=3e-3, seconds=6.0)
    table.to_parquet(tmp_path / "car.parquet")
    assert faults(read(tmp_path / "car.parquet")) == []


def test_where_all_are_alike_it_is_the_channel(good: Recording) -> None:
    """And fits take the derivative of x, of a record that is otherwise as well."""
    wrong = spoiled(good, 1.2)
    (fault,) = look(replace(wrong, xdot=1.2 * wrong.xdot)).faults
    assert (fault.code, fault.record) == ("velocity_gain", None)
