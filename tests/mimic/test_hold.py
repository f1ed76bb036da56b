"""The amplifier as a causal hold: the given duty where it can, the limits always."""

from __future__ import annotations

import numpy as np
import pytest
from places import FIXTURES
from replayed import faults_of
from rig import recording

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.io.parameters import parse_parameters
from erdctl.mimic import follow, mimic
from erdctl.mimic.hold import CausalHold
from erdctl.mimic.levels import DutyLevels
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import parse_fault

PARAMETERS = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")


def moving(t: Array, duty: Array | float) -> Recording:
    x, xdot = 0.01 * np.sin(9 * t), 0.09 * np.cos(9 * t)
    return recording(t, x, xdot, np.zeros(len(t)) + duty)


def declared(amplifier: Amplifier) -> dict:
    def of(value: float | None) -> dict | None:
        return None if value is None or np.isinf(value) else {"value": value}

    a = amplifier
    return {
        "duty_max": a.duty_max, "resolution": a.resolution, "slew": of(a.slew),
        "update_rate": of(a.update_rate),
    }  # fmt: skip


def test_updates_that_do_not_align_with_samples() -> None:
    """Samples every 3 ms and 200 Hz: 6 ms from one update to the next, at twice 3 ms of slew."""
    t = np.arange(300) * 0.003
    amplifier = Amplifier(slew=1.0, update_rate=200.0)
    found = mimic(PARAMETERS, moving(t, 0.3), [parse_fault("oil=0.5")], amplifier)
    for duty in (found.duty, found.duty_paper):
        at = np.flatnonzero(np.diff(duty)) + 1
        assert np.diff(t[at]).min() > 0.005
        assert np.abs(np.diff(duty)).max() <= 0.006 + 1e-9
        assert faults_of(t.tolist(), duty.tolist(), declared(amplifier)) == []


def test_a_rest_is_no_licence_to_leap() -> None:
    """A fault after 1 s of rest sets in with the slew of one update, not with that of a second."""
    t = np.arange(400) * 0.005
    found = mimic(PARAMETERS, moving(t, 0.3), [parse_fault("electrical=0@1")], Amplifier(slew=1.0))
    assert np.abs(np.diff(found.duty)).max() <= 0.005 + 1e-9


def test_given_steps_between_updates_go_out_when_they_are_due() -> None:
    """What keeps the update rate is not put off to a raster."""
    t = np.arange(100) * 0.003
    given = np.where(np.arange(100) % 21 < 10, 0.1, 0.3)
    out = follow(given, Signals.of(moving(t, given)), Amplifier(update_rate=50.0))
    assert np.array_equal(out, given)


def test_after_a_fault_the_phase_of_the_given_duty_is_met_again() -> None:
    """Steps as fast as the amplifier can, and a fault in between: at most one step is late."""
    t = np.arange(400) * 0.005
    given = np.where(np.arange(400) // 4 % 2 == 0, 0.1, 0.3)
    amplifier = Amplifier(update_rate=50.0)
    for end in np.arange(1.0, 1.03, 0.005):
        fault = parse_fault(f"oil=0.5@0.503:{end:.9g}")
        found = mimic(PARAMETERS, moving(t, given), [fault], amplifier)
        away = np.flatnonzero(found.duty != given)
        assert t[away].min() >= 0.503
        assert t[away].max() <= end + 0.04
        assert faults_of(t.tolist(), found.duty.tolist(), declared(amplifier)) == []


def test_a_fault_that_changed_nothing_holds_nothing_up() -> None:
    """The given duty steps right after a fault for which no duty had to change."""
    t = np.arange(100) * 0.001
    given = np.where(t < 0.05, 0.3, 0.301)
    rest = recording(t, np.zeros(100), np.zeros(100), given)
    found = mimic(PARAMETERS, rest, [parse_fault("oil=0.999999@0.04:0.048")],
                  Amplifier(update_rate=50.0, resolution=0.001))  # fmt: skip
    assert np.array_equal(found.duty, given)


@pytest.mark.parametrize("kind", ["oil", "electrical", "deformation"])
def test_a_fault_that_needs_no_change_makes_none(kind: str) -> None:
    t = np.arange(300) * 0.005
    still = recording(t, np.zeros(300), np.zeros(300), np.zeros(300))
    found = mimic(PARAMETERS, still, [parse_fault(f"{kind}=0.5")], Amplifier())
    assert (found.duty == 0.0).all()
    same = mimic(PARAMETERS, moving(t, 0.3), [parse_fault(f"{kind}=0.999999")],
                 Amplifier(resolution=0.1))  # fmt: skip
    assert (same.duty == 0.3).all()


def test_healthy_stretches_of_section_6_4_are_as_given() -> None:
    from test_mimic import SEQUENCE, schedule

    r = schedule()
    for amplifier in (
        Amplifier(),
        Amplifier(update_rate=200.0),
        Amplifier(slew=5.0),
        Amplifier(slew=1.0, update_rate=150.0),
        Amplifier(resolution=0.005, slew=20.0, update_rate=100.0),
    ):
        found = mimic(PARAMETERS, r, [parse_fault(f) for f in SEQUENCE], amplifier)
        healthy = r.t < 15.0
        assert healthy.sum() > 2900
        for duty in (found.duty, found.duty_paper):
            assert (duty[healthy] == 0.3).all()


def test_a_given_ramp_at_the_slew_limit_goes_out_on_a_late_clock() -> None:
    """Times of 1e6 s are rounded by 1e-10 s, which is no reason to be late."""
    t = 1e6 + np.arange(200) * 0.005
    for given in (0.1 + 0.001 * np.arange(200), np.round(0.1 + 0.001 * np.arange(200), 3)):
        amplifier = Amplifier(slew=0.2, resolution=0.001, update_rate=200.0)
        assert np.array_equal(follow(given, Signals.of(moving(t, given)), amplifier), given)


def test_levels_are_the_decimals_that_people_write() -> None:
    levels = DutyLevels.of(Amplifier(resolution=0.1), np.zeros(1))
    assert levels.nearest(np.array([0.29, 0.7])).tolist() == [0.3, 0.4]
    assert levels.top == 0.4
    assert DutyLevels.of(Amplifier(resolution=0.05), np.zeros(1)).top == 0.45


def test_one_level_and_many_are_found_alike() -> None:
    random = np.random.default_rng(0)
    for step in (0.0, 0.001, 0.02, 1 / 3, 1 / 1024, 0.013):
        levels = DutyLevels.of(Amplifier(resolution=step, duty_max=0.4), np.zeros(1))
        wanted = random.uniform(-0.1, 1.1, 500)
        assert levels.nearest(wanted).tolist() == [levels.one(float(w)) for w in wanted]


def test_a_sequence_that_was_carried_out_is_carried_out_again() -> None:
    random = np.random.default_rng(1)
    t = np.cumsum(random.uniform(0.001, 0.009, 500))
    acting = random.random(500) > 0.2
    amplifier = Amplifier(slew=3.0, update_rate=170.0, resolution=0.003)
    hold = CausalHold.of(Signals.of(moving(t, 0.3)), amplifier, acting)
    once = hold.follow(random.uniform(0, 0.5, 500))
    assert np.array_equal(hold.follow(once)[acting], once[acting])
