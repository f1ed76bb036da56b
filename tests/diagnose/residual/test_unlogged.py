"""Strokes whose force motion and duty do not tell: something acts that is not logged.

The logs are of an own generator: sines at constant duties, as the paper's protocol has them.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from places import SHARED
from rig import real

from erdctl.bench.rig import look
from erdctl.core.recording import Array, Recording, concatenate
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.unlogged import unlogged, without
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start
from erdctl.io.logs import read_logs

RATE, SECONDS = 200.0, 12.0
FEW = tuple(get(n) for n in ("quadratic_damping", "coulomb_friction", "gas_preload"))


def record(
    random: np.random.Generator, hz: float, duty: float, *, sag: Array | float = 0.0,
    warm: float = 0.0, quadratic: float = 0.0, noise: float = 0.3, memory: float = 0.0,
) -> Recording:  # fmt: skip
    """A record of one sine [N, m, s], of whose yield force a part `sag` (n,) is missing.

    warm : part of the whole force that is lost, evenly, by its end
    memory : of the noise, from sample to sample [1]
    """
    t = np.arange(round(SECONDS * RATE)) / RATE
    w = 2.0 * np.pi * hz
    x, v = 0.02 * np.sin(w * t), 0.02 * w * np.cos(w * t)
    force = 60.0 * duty**0.4 * (1.0 - sag) * np.sign(v) + 90.0 * v + 150.0 * x
    force = (force + quadratic * v * np.abs(v)) * (1.0 - warm * t / t[-1])
    white, made = random.normal(size=len(t)), np.zeros(len(t))
    for i in range(1, len(t)):
        made[i] = memory * made[i - 1] + np.sqrt(1.0 - memory**2) * white[i]
    ends = np.array([0, len(t)], dtype=np.intp)
    named = (f"{hz}Hz-{100 * duty:.0f}",)
    return Recording(t, x, v, np.full(len(t), duty), ends, named, force=force + noise * made)


def log(
    seed: int, *, between: tuple[float, float] | None = None, part: float = 0.0, **more: float
) -> Recording:
    """Six records, in the third of which a part of the yield force is missing between two times."""
    random = np.random.default_rng(seed)
    t = np.arange(round(SECONDS * RATE)) / RATE
    out = []
    for i, (hz, duty) in enumerate([(1, 0.1), (2, 0.1), (1, 0.2), (2, 0.2), (1, 0.3), (2, 0.3)]):
        inside = between is not None and i == 2
        sag = part * ((t >= between[0]) & (t < between[1])) if inside and between else 0.0
        out.append(record(random, hz, duty, sag=sag, **more))
    return concatenate(out)


def fitted(recording: Recording) -> Hypothesis:
    return fit_hypothesis(prepare(recording), (), [fresh_start(0.05, 0.4)])


@pytest.mark.parametrize("part", [0.12, 0.3, -0.2])
@pytest.mark.parametrize("begin", [4.25, 4.4, 4.6])
def test_a_supply_that_sagged_for_a_while_is_found_with_its_time_and_its_size(
    part: float, begin: float
) -> None:
    """Also where that begins and ends within strokes."""
    made = log(1, between=(begin, begin + 3.0), part=part)
    found = unlogged(fitted(made))
    assert {(u.record, u.compression) for u in found} == {(2, True), (2, False)}
    assert min(u.begin for u in found) == pytest.approx(begin, abs=0.5)
    assert max(u.end for u in found) == pytest.approx(begin + 3.0, abs=0.5)
    yielding, viscous = 60.0 * 0.2**0.4, 90.0 * 0.02 * 2.0 * np.pi
    for u in found:
        assert 3 <= u.count <= 5
        # The middle of the way, where it is at full speed.
        assert u.part[1] == pytest.approx(-part * yielding / (yielding + viscous), rel=0.2)
        assert np.abs(u.change).max() == pytest.approx(abs(part) * yielding, rel=0.3)


@pytest.mark.parametrize("memory", [0.0, 0.9, 0.99, 0.999])
@pytest.mark.parametrize("seed", range(4))
def test_noise_of_any_memory_is_none(seed: int, memory: float) -> None:
    assert unlogged(fitted(log(seed, noise=1.0, memory=memory))) == ()


@pytest.mark.parametrize("warm", [0.03, 0.1, 0.3])
def test_a_damper_that_warms_is_no_setting_that_was_turned(warm: float) -> None:
    assert unlogged(fitted(log(2, warm=warm))) == ()


def test_neither_is_a_law_of_the_speed_that_the_model_lacks() -> None:
    assert unlogged(fitted(log(3, quadratic=400.0))) == ()


@pytest.mark.long
def test_what_they_have_is_left_out_and_said() -> None:
    made = log(4, between=(4.25, 7.25), part=0.3, quadratic=400.0)
    found = diagnose(made, FEW, limits=False)
    assert found.verdict is Verdict.UNEXPLAINED
    assert [f.effect.name for f in found.findings] == ["quadratic_damping"]
    assert found.fit.values["quadratic_damping.c_2"] == pytest.approx(400.0, rel=0.05)
    assert {made.names[u.record] for u in found.apart} == {"1Hz-20"}
    assert found.noise_rms == pytest.approx(0.3, rel=0.1)
    said = remaining_text(found)
    assert "something acts which is not logged" in said
    assert "in record '1Hz-20', from 4.2" in said
    assert found.mismatch[0].low == pytest.approx(4.25, abs=0.05)
    excluded = without(made, found.apart).excluded
    assert excluded is not None
    assert excluded.sum() == sum(len(u.rows) for u in found.apart)


def ride(seed: int, between: tuple[float, float] | None, part: float) -> Recording:
    """Random motions under duties that step at random, in one of which yield force is missing."""
    random = np.random.default_rng(seed)
    t = np.arange(round(30.0 * RATE)) / RATE
    out = []
    for i in range(4):
        f, w = random.uniform(0.4, 3.0, 12), random.uniform(0.0, 2.0 * np.pi, 12)
        a = 0.01 / np.sqrt(12.0) / f
        phase = 2.0 * np.pi * np.outer(t, f) + w
        x, v = np.sin(phase) @ a, np.cos(phase) @ (2.0 * np.pi * f * a)
        duty = np.repeat(random.choice([0.05, 0.1, 0.2, 0.3], 60), len(t) // 60)
        sag = part * ((t >= between[0]) & (t < between[1])) if between and i == 1 else 0.0
        force = 60.0 * duty**0.4 * (1.0 - sag) * np.sign(v) + 90.0 * v + 150.0 * x
        force += random.normal(0.0, 0.5, len(t))
        ends = np.array([0, len(t)], dtype=np.intp)
        out.append(Recording(t, x, v, duty, ends, (f"ride {i}",), force=force))
    return concatenate(out)


@pytest.mark.parametrize("seed", range(3))
def test_it_is_found_in_a_random_motion(seed: int) -> None:
    """There no strokes are alike; those that lack a part lie among the others in their motion."""
    assert unlogged(fitted(ride(seed, None, 0.0))) == ()
    (u,) = unlogged(fitted(ride(seed, (8.0, 16.0), 0.25)))
    assert (u.record, u.compression) == (1, None)
    assert u.begin == pytest.approx(8.0, abs=1.0)
    assert u.end == pytest.approx(16.0, abs=1.0)
    assert -0.25 < u.part.mean() < -0.12
    assert u.returns
    assert u.rows.tolist() == list(range(u.rows[0], u.rows[-1] + 1))  # and what is short in it


@pytest.mark.filterwarnings("error")
def test_strokes_without_any_noise_are_apart() -> None:
    """Of a record that is the same again and again, to the last digit, but for some strokes."""
    t = np.arange(2400) / 200.0
    v = np.where(np.arange(2400) // 50 % 2, -0.1, 0.1)
    x = 0.02 * (np.abs(np.arange(2400) % 100 / 100.0 - 0.5) - 0.25)
    made = Recording(
        t, x, v, np.full(2400, 0.2), np.array([0, 2400]), ("r",), force=30.0 * np.sign(v)
    )
    lacking = 6.0 * ((t > 4.0) & (t < 8.0)) * np.sign(v)
    best = SimpleNamespace(
        problem=prepare(made), values={}, residual=-lacking,
        model=SimpleNamespace(force=lambda s, values: made.force),
    )  # fmt: skip
    found = unlogged(cast("Hypothesis", best))
    assert {u.count for u in found} == {8}
    assert all(u.part == pytest.approx(-0.2, abs=0.01) for u in found)


def test_strokes_of_a_sample_are_passed_over() -> None:
    """Of a velocity that flickers about rest in a log without motion enough."""
    made = log(7)
    v = made.xdot.copy()
    still = made.t > 6.0
    v[still] = np.where(np.arange(len(v)) % 2, 0.1, -0.1)[still]
    x = np.where(still, 0.0, made.x)
    assert unlogged(fitted(replace(made, x=x, xdot=v))) == ()


def test_neither_is_a_law_of_the_speed_in_a_random_motion_that_grows() -> None:
    """The force of fast strokes differs from the model's: these come at the end, and alone."""
    made = ride(5, None, 0.0)
    assert made.force is not None
    grown = np.where(made.t > 15.0, 3.0, 1.0)
    force = made.force + (grown - 1.0) * (150.0 * made.x + 90.0 * made.xdot)
    x, v = grown * made.x, grown * made.xdot
    jump = np.abs(np.diff(grown, prepend=1.0)) > 0.0
    held = replace(made, x=x, xdot=v, force=force + 150.0 * v * np.abs(v), excluded=jump)
    assert unlogged(fitted(held)) == ()


@pytest.mark.long
def test_a_fault_that_comes_and_goes_is_none_that_stays() -> None:
    """Which some effect of the catalogue would be, from its onset on."""
    made = log(6, between=(4.25, 8.25), part=0.4)
    run = partial(diagnose, candidates=(get("electrical_fault"), get("oil_leakage")), limits=False)
    found = with_a_fault_once(run, made)
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.findings == ()
    assert found.once is None
    assert {u.compression for u in found.apart} == {True, False}


@pytest.mark.long
def test_nor_does_one_from_the_beginning_of_a_record() -> None:
    """That may be one of its beginning on, to a search for faults, which then is none."""
    made = log(8, between=(0.0, 4.25), part=0.4)
    run = partial(diagnose, candidates=(get("electrical_fault"), get("oil_leakage")), limits=False)
    found = with_a_fault_once(run, made)
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.once is None
    assert {made.names[u.record] for u in found.apart} == {"1Hz-20"}


@pytest.mark.real_data
def test_a_setting_that_nobody_recorded() -> None:
    """Of a friction damper an actuator turned the setting for three strokes of each record, one
    way; with that its chatter as it slides is not taken for bursts of the rig.
    """
    path = str(real("friction_semiactive.parquet", SHARED))
    made = read_logs([path], need_force=True, report=lambda line: None).recording
    assert look(made).faults == ()
    effects = tuple(get(n) for n in ("coulomb_friction", "mount_compliance", "backlash"))
    start = fresh_start(0.05, 0.4) | {
        "coulomb_friction.F_c": 13e3, "mount_compliance.s_m": 1.8e-7, "backlash.g": 2.6e-3,
    }  # fmt: skip
    best = fit_hypothesis(prepare(made), effects, [start])
    found = {(made.names[u.record], u.compression): u for u in unlogged(best)}
    assert set(found) == {
        ("harmonic0.03ea1backward", False), ("harmonic0.03ea1forward", True),
        ("step0.03ea1backward", False), ("step0.03ea1forward", True),
    }  # fmt: skip
    for u in found.values():
        assert (u.count, u.others) == (3, 2)
        assert 3.5 < u.begin < 4.6
        assert 8.2 < u.end < 9.6
