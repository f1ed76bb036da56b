"""A record with another duty than is logged for it, and what looks like one and is none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from places import FIXTURES
from steady_sines import steady_sines

from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Array, Recording
from erdctl.io.logs import read_logs

LEVELS, MOTIONS = (0.0, 0.1, 0.2, 0.3), ((0.6, 0.02), (1.5, 0.01), (4.0, 0.004))  # [1]; [Hz], [m]
AT = 7  # of the twelve records the second of the third level


def sines(
    force: Callable[[Array, Array], Array], duty: float = 0.2, spread: float = 0.0
) -> Recording:
    """Four levels by three motions; another duty is logged for record AT than it has.

    force : of velocity and duty, beside spring, viscous and yield force [N]
    """

    def all_of(x: Array, v: Array, u: Array) -> Array:
        return 170.0 * x + 50.0 * v + 20.0 * u**0.5 * np.sign(v) + force(v, u)

    r = steady_sines(LEVELS, MOTIONS, all_of, noise=0.2, spread=spread)
    logged = r.duty.copy()
    logged[r.slices[AT]] = duty
    return replace(r, duty=logged)


def none(v: Array, duty: Array) -> Array:
    return np.zeros_like(v)


def said(r: Recording) -> list[RigFault]:
    return [f for f in look(r).faults if f.code == "record_duty"]


@pytest.mark.parametrize("logged", [0.0, 0.1])
@pytest.mark.parametrize("spread", [0.0, 0.01])
def test_a_wrong_label_is_found(logged: float, spread: float) -> None:
    assert said(sines(none, spread=spread)) == []
    (fault,) = said(sines(none, logged, spread))
    assert fault.record == AT
    assert fault.blocks
    assert f"at 20 % duty, and {100 * logged:.3g} % is logged" in fault.text


def test_a_lower_duty_is_left_to_the_diagnosis() -> None:
    """As little voltage as an electrical fault leaves."""
    assert said(sines(none, 0.3)) == []


def test_swapped_labels() -> None:
    """The one that is logged too low is found, beside the other."""
    r = sines(none, 0.1)
    duty = r.duty.copy()
    duty[800 * 4 : 800 * 5] = 0.2
    assert [f.record for f in said(replace(r, duty=duty))] == [AT]


def test_more_friction_in_the_slow_records_is_none() -> None:
    def stribeck(v: Array, duty: Array) -> Array:
        return 4.0 * np.exp(-((v / 0.02) ** 2)) * np.sign(v)

    assert said(sines(stribeck)) == []


def raised(to: float, way: float = 0.0) -> Callable[[Array, Array], Array]:
    """Record AT alone has the yield force of another level; way : in one direction, twice."""

    def force(v: Array, duty: Array) -> Array:
        of_at = 0.085 < np.abs(v).max() < 0.097 and duty[0] == 0.2
        more = 20.0 * (to**0.5 - 0.2**0.5) * of_at
        return more * np.sign(v) * (2.0 * (v * way > 0.0) if way else 1.0)

    return force


def test_a_level_that_nothing_else_has_is_none() -> None:
    """A law of the field may be what is missing there, or another one."""
    assert said(sines(none, 0.05)) == []
    assert said(sines(none, 0.1).select([k for k in range(12) if k == AT or k // 3 != 1])) == []


def test_a_level_that_is_between_those_of_others_is_none() -> None:
    assert said(sines(raised(0.25), 0.0)) == []
    few = [9, 10, 0, 1, 2, AT, 11]  # two levels, of which neither is near
    assert said(sines(raised(0.16), 0.0).select(few)) == []


def test_a_motion_that_nothing_else_has_is_none() -> None:
    """A law of the speed may be what is missing there."""
    r = sines(raised(0.3))
    assert [f.record for f in said(r)] == [AT]
    assert said(r.select([k for k in range(12) if k == AT or k % 3 == 0])) == []


def test_more_in_one_direction_is_none() -> None:
    assert said(sines(raised(0.3, 1.0))) == []
    assert said(sines(raised(0.3, -1.0))) == []


def test_a_control_that_steps_has_no_label() -> None:
    r = sines(none)
    duty = r.duty.copy()
    duty[800 * AT : 800 * AT + 500] = 0.1
    assert said(replace(r, duty=duty)) == []


def test_the_first_records_before_a_fault_of_the_supply_are_none() -> None:
    """Healthy ones, with a part of the field in all behind them, are told by the diagnosis."""
    r = sines(none)
    assert r.force is not None
    yielding = 20.0 * r.duty**0.5 * np.sign(r.xdot)
    late = np.arange(len(r)) >= 800 * 8
    assert said(replace(r, force=r.force - 0.4 * late * yielding)) == []
    early = np.arange(len(r)) >= 800 * 4
    assert said(replace(r, force=r.force - 0.4 * early * yielding)) == []


def test_a_gain_of_one_record_is_no_label() -> None:
    """Where most of a force is its yield force, a higher level leaves as little as others do."""
    path = str(FIXTURES / "healthy_campaign.parquet")
    good = read_logs([path], need_force=True, report=lambda line: None).recording
    assert good.force is not None
    force = good.force.copy()
    force[good.slices[AT]] *= 1.1
    assert said(replace(good, force=force)) == []
