"""What a log can show: the same answer from inspect, identify and diagnose, with numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import trajectories
from rig import campaign, noisy, recording

from erdctl.bench import identifiability as coverage
from erdctl.bench.drive import drives
from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import REQUIREMENTS, Bench, Check
from erdctl.bench.inspection import inspect
from erdctl.bench.waveforms import Triangle
from erdctl.core.recording import Array, Recording, concatenate
from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import catalogue
from erdctl.estimate.identify import identify
from erdctl.model.effect import Requirement, Stage

RATE = 100.0
CATALOGUE = catalogue()
NEED = {Requirement.LEVELS, Requirement.STEPS}
FIELD = {e.name for e in CATALOGUE if e.stage is Stage.FIELD or NEED & {*e.requires}}


def clock(seconds: float) -> Array:
    return np.arange(round(seconds * RATE)) / RATE


def sine(frequency: float, amplitude: float, seconds: float, duty: float | Array) -> Recording:
    t = clock(seconds)
    tones = trajectories.sine(frequency, amplitude, 0.3)
    levels = np.broadcast_to(np.asarray(duty, dtype=float), t.shape).copy()
    name = f"{frequency}"
    return recording(t, tones.x(t), tones.velocity(t), levels, name, tones.velocity_at)


def constant_duty() -> Recording:
    return concatenate([sine(f, 0.01, 8.0, 0.2) for f in (0.7, 2.1)])


def slow() -> Recording:
    """Quasi-static, of several frequencies and levels, duty steps and all."""
    t = clock(40.0)
    levels = trajectories.steps(t, (0.0, 0.1, 0.2, 0.3), 2.3)
    return concatenate([sine(f, 0.02, 40.0, levels) for f in (0.05, 0.1)])


def single_speed() -> Recording:
    t = clock(20.0)
    x, xdot = Triangle(speed=0.04, amp=0.01)(t, 20.0)
    return recording(t, x, xdot, trajectories.steps(t, (0.1, 0.2, 0.3), 0.7))


def no_reversal() -> Recording:
    """One long stroke in compression while the duty steps."""
    t = clock(12.0)
    xdot = 0.004 + 0.002 * np.sin(2 * np.pi * 0.8 * t)
    x = 0.004 * t - 0.002 / (2 * np.pi * 0.8) * np.cos(2 * np.pi * 0.8 * t) - 0.025
    return recording(t, x, xdot, trajectories.steps(t, (0.1, 0.2, 0.3), 0.7))


def full_campaign() -> Recording:
    return campaign(100.0, 6.0)


LOGS: dict[str, Callable[[], Recording]] = {
    "constant duty": constant_duty,
    "slow": slow,
    "single speed": single_speed,
    "no reversal": no_reversal,
    "full campaign": full_campaign,
}


def lacking(r: Recording) -> tuple[set[str], set[str]]:
    found = inspect(r, CATALOGUE)
    return tuple(  # type: ignore[return-value]  # two sets
        {c.name for c in covers if c.lack is not None}
        for covers in (found.parameters, found.effects)
    )


@pytest.mark.few(3)
@pytest.mark.parametrize("name", LOGS)
def test_inspect_identify_and_diagnose_agree(name: str) -> None:
    r = noisy(LOGS[name](), seed=3)
    parameters, unseen = lacking(r)
    estimates = identify(r).joint
    assert {n for n, e in estimates.items() if not e.identified} == parameters
    # Every effect that cannot be seen is offered to the diagnosis, and one that can.
    seen = next(e for e in CATALOGUE if e.name not in unseen and e.columns is not None)
    offered = [e for e in CATALOGUE if e.name in unseen] + [seen]
    found = diagnose(r, offered, most=1, limits=False, learning=False)
    assert set(found.untestable) == unseen


def test_a_constant_duty_shows_no_lag_no_law_and_no_field_effect() -> None:
    parameters, unseen = lacking(constant_duty())
    assert parameters == {f"{d}.{s}" for d in ("compression", "release")
                          for s in ("T_d", "sigma", "beta")}  # fmt: skip
    assert unseen == FIELD


def test_a_slow_log_says_what_inertia_needs() -> None:
    parameters, unseen = lacking(slow())
    assert parameters == set()
    assert unseen == {"fluid_inertia"}
    (cover,) = (c for c in inspect(slow(), CATALOGUE).effects if c.name == "fluid_inertia")
    (check,) = cover.checks
    # Of 0.02 m at 0.05 and at 0.1 Hz, a spring takes up all but this.
    a, b = (0.02 * (2 * np.pi * f) ** 2 for f in (0.05, 0.1))
    assert check.found == pytest.approx((b - a) / 2 / np.sqrt(2), rel=0.05)
    assert check.needed == 0.01
    assert check.unit == "m/s^2"
    assert "sweep" in check.drive


def test_one_direction_only() -> None:
    parameters, unseen = lacking(no_reversal())
    assert parameters == {f"release.{s}" for s in coverage.PARAMETERS}
    reversing = {e.name for e in CATALOGUE if Requirement.REVERSALS in e.requires}
    assert reversing <= unseen


def test_a_full_campaign_shows_everything() -> None:
    assert lacking(full_campaign()) == (set(), set())


def test_noise_of_the_velocity_is_no_acceleration() -> None:
    r = sine(0.5, 0.02, 20.0, 0.0)
    rng = np.random.default_rng(1)
    spoiled = replace(r, xdot=r.xdot + 2e-3 * rng.standard_normal(len(r)))
    assert Survey.of(r).acceleration == 0.0
    assert Survey.of(spoiled).acceleration == 0.0


def test_levels_that_noise_spreads_are_told_apart_by_ratio() -> None:
    duty = np.repeat([0.0, 0.1, 0.104, 0.2], 100)
    assert Survey.of(sine(1.0, 0.01, 4.0, duty)).levels == 2


def test_every_requirement_has_its_measure() -> None:
    assert set(REQUIREMENTS) == set(Requirement)
    assert all(r in REQUIREMENTS for e in CATALOGUE for r in e.requires)


def unmet(r: Recording) -> list[Check]:
    survey = Survey.of(r)
    covers = [*coverage.parameters(survey), *coverage.effects(survey, CATALOGUE)]
    return [c for cover in covers for c in cover.checks if not c.met]


@pytest.mark.parametrize("name", LOGS)
def test_the_drive_that_is_named_shows_it(name: str) -> None:
    """Recorded in addition to the log, the drives leave nothing of what was missing."""
    r = LOGS[name]()
    specs = list(dict.fromkeys(c.drive for c in unmet(r)))
    if not specs:
        return
    driven = drives(specs)
    missing = {c.what for c in unmet(driven)}
    assert not missing & {c.what for c in unmet(r)}


@pytest.mark.parametrize("name", LOGS)
def test_drives_stay_within_what_the_bench_has_shown(name: str) -> None:
    r = LOGS[name]()
    bench = Bench.of(Survey.of(r))
    for spec in {c.drive for c in unmet(r)}:
        driven = drives([spec])
        assert np.ptp(driven.x) <= 2.02 * bench.stroke
        assert np.abs(driven.xdot).max() <= 1.02 * bench.speed


def test_a_log_that_shows_nothing_is_surveyed() -> None:
    still = replace(sine(1.0, 0.01, 4.0, 0.0), x=np.zeros(400), xdot=np.zeros(400))
    parameters, unseen = lacking(still)
    assert len(parameters) == 10
    assert {"backlash", "fluid_inertia", "field_threshold", "gas_polytropic"} <= unseen


def test_what_is_said_of_a_direction_is_true_of_the_log() -> None:
    """A control that follows the motion gives a field in compression alone; the log has one."""
    r = sine(1.0, 0.01, 8.0, 0.0)
    r = replace(r, duty=np.where(r.xdot > 0, 0.3, 0.0))
    covers = {c.name: c for c in coverage.parameters(Survey.of(r))}
    lack = covers["release.sigma"].lack
    assert lack is not None
    assert "in this direction" in lack.reason
    assert {c.what for c in covers["release.sigma"].checks} == {
        "samples that move this way", "samples that move this way with a duty above zero",
        "highest over lowest duty above zero while it moves this way",
    }  # fmt: skip
    held = covers["compression.sigma"].lack
    assert held is not None
    assert "one duty level above zero in this direction" in held.reason


def test_levels_are_counted_as_is_said() -> None:
    """30 and 31 % are two levels of the log, and one of those 5 % apart."""
    r = concatenate([sine(1.0, 0.01, 4.0, duty) for duty in (0.30, 0.31)])
    found = REQUIREMENTS[Requirement.LEVELS].check(Survey.of(r), Bench.of(Survey.of(r)))
    assert str(found) == "duty levels above zero, 5 % apart: 1, at least 3 needed"
