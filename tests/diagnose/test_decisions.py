"""What is named, and what is not: few places, a hum, few duties and few motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from rig import campaign, noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose.conditions import few_conditions, one_condition, one_motion, slow_far_out
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.model.effect import Effect

NOISE = 0.3
STEPS = (0.0, 0.1, 0.2, 0.3, 0.45)


def few(*names: str) -> list[Effect]:
    return [get(name) for name in names]


def plus(r: Recording, force: np.ndarray) -> Recording:
    assert r.force is not None
    return replace(r, force=r.force + force)


def sine(frequency: float, amplitude: float, duty: float | None, name: str) -> Recording:
    t = np.arange(1200) / 200.0
    motion = trajectories.sine(frequency, amplitude, 0.4)
    held = np.full(len(t), duty or 0.0)
    if duty is None:
        held = trajectories.random_hold(np.random.default_rng(len(name)), t, STEPS)
    return recording(t, motion.x(t), motion.velocity(t), held, name, motion.velocity_at)


def test_a_stop_that_one_record_of_seven_reaches() -> None:
    """1.5 times the noise in that record, 0.6 times in all: too few places for log ratios."""
    motions = ((0.7, 12.0, 0.0), (1.9, 8.0, 0.2), (3.1, 5.0, 0.3), (0.7, 20.0, 0.0),
               (1.3, 10.0, None), (2.5, 6.0, 0.3), (0.9, 12.0, None))  # fmt: skip
    r = concatenate([sine(f, 1e-3 * a, d, f"r{i}") for i, (f, a, d) in enumerate(motions)])
    touched = np.maximum(r.x - 0.017, 0.0)
    own = touched[r.slices[3]]
    stiffness = 1.5 * NOISE / np.sqrt(np.mean(own**2))
    log = noisy(plus(r, stiffness * touched), seed=1, rms=NOISE)
    names = ("end_stop", "coulomb_friction", "quadratic_damping", "gas_preload", "gas_polytropic")
    found = diagnose(log, few(*names), limits=False)
    assert found.verdict is Verdict.EXPLAINED
    assert [f.effect.name for f in found.findings] == ["end_stop"]
    assert found.selection.best.values["end_stop.k_c"] == pytest.approx(stiffness, rel=0.2)
    assert found.findings[0].gain.t_stretches < 3.5


@pytest.mark.few(1)
@pytest.mark.parametrize("line", [50.0, 60.0])
def test_hum_is_a_line_of_the_force_channel(line: float) -> None:
    r = noisy(campaign(), seed=3, rms=NOISE)
    hum = 2.6 * NOISE * np.sqrt(2.0) * np.sin(2 * np.pi * line * r.t + 1.0)
    found = diagnose(plus(r, hum), few("coulomb_friction", "preyield_viscosity"), limits=False)
    assert found.findings == ()
    assert found.verdict is Verdict.ADEQUATE
    assert f"a line of {line:.0f} Hz in the force channel" in remaining_text(found)
    assert found.lack_of_fit.hum is not None
    assert found.lack_of_fit.hum.share == pytest.approx(2.6**2 / (1 + 2.6**2), abs=0.05)


def test_no_hum_no_word() -> None:
    found = diagnose(
        noisy(campaign(), seed=8, correlation=0.9), few("coulomb_friction"), limits=False
    )
    assert "line of" not in remaining_text(found)
    assert found.lack_of_fit.hum is None


def test_one_duty_and_one_speed_cannot_tell() -> None:
    r = concatenate([sine(0.8, 0.015, 0.0, f"r{i}") for i in range(2)])
    log = noisy(plus(r, 1.5 * np.sign(r.xdot)), seed=2, rms=NOISE)
    found = diagnose(log, few("coulomb_friction", "gas_preload", "preyield_viscosity"))
    assert one_condition(log)
    assert found.verdict is Verdict.UNEXPLAINED
    document = to_json(found)
    assert document["cannot_tell"]
    # No number within which the truth may not be: values are what a simulation uses, and no more.
    assert not [n for n, e in parameters(found).estimates.items() if e.identified]
    assert "backlash" not in document["limits"]  # only what was looked for
    assert "--drive sweep:" in remaining_text(found)


def test_what_is_more_than_one_condition() -> None:
    slow, fast, field = (sine(f, 0.015, d, "r") for f, d in ((0.8, 0.0), (1.6, 0.0), (0.8, 0.3)))
    assert one_condition(concatenate([slow, slow]))
    assert not one_condition(concatenate([slow, fast]))
    assert not one_condition(concatenate([slow, field]))
    assert not one_condition(sine(0.8, 0.015, None, "steps"))


def test_two_duties_and_two_motions_tell_one_effect_and_not_two() -> None:
    motions = ((0.8, 0.015, 0.0), (0.8, 0.015, 0.3), (2.4, 0.008, 0.0), (2.4, 0.008, 0.3))
    r = concatenate([sine(f, a, d, f"r{i}") for i, (f, a, d) in enumerate(motions)])
    catalogue = few("coulomb_friction", "gas_preload", "preyield_viscosity")
    single = noisy(plus(r, 1.5 * np.sign(r.xdot)), seed=2, rms=NOISE)
    one = diagnose(single, catalogue, limits=False)
    assert one.verdict is Verdict.EXPLAINED
    assert [f.effect.name for f in one.findings] == ["coulomb_friction"]

    both = noisy(plus(r, 1.5 * np.sign(r.xdot) + 2.0), seed=2, rms=NOISE)
    found = diagnose(both, catalogue, limits=False)
    assert {f.effect.name for f in found.findings} == {"coulomb_friction", "gas_preload"}
    assert found.verdict is Verdict.UNEXPLAINED
    assert to_json(found)["cannot_tell"]
    assert not [n for n, e in parameters(found).estimates.items() if e.identified]
    said = remaining_text(found)
    assert "two duties and two kinds of motion at most" in said
    assert "--drive sweep:" in said


@pytest.mark.long
def test_of_one_motion_it_is_said_that_nothing_tests_another() -> None:
    levels = (0.0, 0.15, 0.3, 0.45)
    r = concatenate([sine(0.8, 0.015, d, f"r{i}") for i, d in enumerate(levels)])
    catalogue, said = (
        few("coulomb_friction", "gas_preload"),
        "nothing here tests the corrected model",
    )
    found = diagnose(noisy(plus(r, 1.5 * np.sign(r.xdot)), seed=2, rms=NOISE), catalogue)
    assert [f.effect.name for f in found.findings] == ["coulomb_friction"]
    assert said in remaining_text(found)
    nothing = diagnose(noisy(r, seed=2, rms=NOISE), catalogue)
    assert not nothing.findings
    assert said not in remaining_text(nothing)


@pytest.mark.long
def test_one_motion_does_not_tell_damping_by_place_beside_another_law() -> None:
    levels = (0.0, 0.15, 0.3, 0.45)
    r = concatenate([sine(0.8, 0.015, d, f"r{i}") for i, d in enumerate(levels)])
    catalogue = few("coulomb_friction", "gas_preload", "position_dependent_damping")
    by_place = 3000.0 * r.x * r.xdot
    one = diagnose(noisy(plus(r, by_place), seed=2, rms=NOISE), catalogue, limits=False)
    assert one.verdict is Verdict.EXPLAINED
    both = noisy(plus(r, by_place + 1.5 * np.sign(r.xdot)), seed=2, rms=NOISE)
    found = diagnose(both, catalogue, limits=False)
    names = {f.effect.name for f in found.findings}
    assert names == {"coulomb_friction", "position_dependent_damping"}
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.cannot_tell == "one kind of motion, all strokes alike"
    assert "--drive sweep:" in remaining_text(found)


def test_what_is_more_than_one_motion() -> None:
    slow, fast, wide = (sine(f, x, 0.0, "r") for f, x in ((0.8, 0.015), (1.6, 0.015), (0.8, 0.03)))
    high = sine(0.8, 0.015, 0.3, "r")
    assert one_motion(concatenate([slow, high, high]))
    assert not one_motion(concatenate([slow, fast]))
    assert not one_motion(concatenate([slow, wide]))


@pytest.mark.long
def test_large_deflections_at_low_speeds_alone_are_told() -> None:
    """And which drive has both, at the highest speed of the log."""
    slow, fast = (sine(f, x, 0.0, f"{f}") for f, x in ((0.2, 0.025), (3.0, 0.005)))
    away, there, anywhere = slow_far_out(concatenate([slow, fast])) or (0.0, 0.0, 0.0)
    assert away == pytest.approx(0.0125, rel=0.02)
    assert there == pytest.approx(0.866 * 2 * np.pi * 0.2 * 0.025, rel=0.03)
    assert anywhere == pytest.approx(2 * np.pi * 3.0 * 0.005, rel=0.03)
    both = sine(0.6, 0.025, 0.0, "both")
    assert slow_far_out(concatenate([slow, fast, both])) is None
    assert slow_far_out(slow) is None
    levels = [
        sine(f, x, d, f"{f} {d}") for f, x in ((0.2, 0.025), (3.0, 0.005)) for d in (0.0, 0.3)
    ]
    r = concatenate(levels)
    catalogue = few("coulomb_friction", "gas_preload")
    found = diagnose(noisy(plus(r, 1.5 * np.sign(r.xdot)), seed=3, rms=NOISE), catalogue)
    said = remaining_text(found)
    assert "beyond 12.5 mm from the middle of the stroke the log has speeds up to 27" in said
    assert "record --drive sine:freq=0.6,amp=0.025" in said
    nothing = diagnose(noisy(r, seed=3, rms=NOISE), catalogue)
    assert "nothing here tests" not in remaining_text(nothing)


def test_what_is_more_than_few_conditions() -> None:
    a, b, c = (sine(f, x, 0.0, "r") for f, x in ((0.8, 0.015), (1.6, 0.015), (1.6, 0.005)))
    on, high = (sine(0.8, 0.015, d, "r") for d in (0.3, 0.45))
    assert few_conditions(concatenate([a, b, on]))
    assert not few_conditions(concatenate([a, b, c]))
    assert not few_conditions(concatenate([a, on, high]))
    assert not few_conditions(sine(0.8, 0.015, None, "steps"))
