"""What only tells records apart has no name, and no law of it is learned or carries over."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import literature_dampers
import numpy as np
import pytest
import trajectories
from rig import noisy, recording

from erdctl.core.recording import Array, Recording, concatenate
from erdctl.diagnose.carry_over import left_out_exactly
from erdctl.diagnose.comparison import compare_alike
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.levels_of_records import beyond_levels
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.course_of_records import course
from erdctl.diagnose.told import as_told
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start
from erdctl.io.logs import read_logs
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect

STROKES = np.array([0.004, 0.007, 0.009, 0.012, 0.015, 0.018])  # m, one of each record
ZEROS = np.array([2.0, -1.5, 0.5, -2.0, 1.0, 0.0])  # N, in no order of the strokes


def swept(stroke: Array, count: int = 1) -> Recording:
    t = np.arange(500) / 100.0
    random, out = np.random.default_rng(5), []
    for i, amplitude in enumerate(np.repeat(stroke, count)):
        tones = trajectories.sine(0.6 + 0.3 * (i % 4), float(amplitude), 0.4 * i)
        duty = trajectories.random_hold(random, t, (0.0, 0.1, 0.2, 0.3))
        out.append(recording(t, tones.x(t), tones.velocity(t), duty, f"{i}", tones.velocity_at))
    return concatenate(out)


def plus(r: Recording, force: Array) -> Problem:
    assert r.force is not None
    return prepare(noisy(replace(r, force=r.force + force), seed=9))


def names(r: Recording, force: Array, *candidates: str) -> list[str]:
    log = noisy(replace(r, force=force), seed=21)
    found = diagnose(log, [get(n) for n in candidates], limits=False, learning=False)
    return [f.effect.name for f in found.findings]


def test_records_whose_gains_differ_have_no_fade() -> None:
    r = swept(STROKES)
    assert r.force is not None
    gains = 1.0 + 0.06 * np.random.default_rng(1).standard_normal(6)
    assert names(r, r.force * np.repeat(gains, np.diff(r.starts)), "thermal_fade") == []


@pytest.mark.parametrize("scatter", [0.0, 0.06])
def test_what_only_tells_records_apart_is_not_said_to_be_noise_alone(scatter: float) -> None:
    """A yield force that the largest stroke so far had weakened left five times the noise, and the
    verdict was `adequate`, with not a word of that."""
    r = swept(STROKES)
    assert r.force is not None
    gains = 1.0 + scatter * np.random.default_rng(1).standard_normal(6)
    log = noisy(replace(r, force=r.force * np.repeat(gains, np.diff(r.starts))), seed=21)
    found = diagnose(log, [], limits=False, learning=False)
    assert (found.verdict is Verdict.ADEQUATE) == (scatter == 0.0)
    words = remaining_text(found)
    assert ("% of its square is a gain and a zero of each record's own" in words) == (scatter > 0.0)
    assert "in the order of the records" not in words


@pytest.mark.few(1)
@pytest.mark.parametrize("change", [0.08, -0.06])
def test_a_force_that_drifts_over_the_records_is_said_to(change: float) -> None:
    """Of 24 records whose force rises by 8 % from the first to the last 0.2 N were "predicted from
    motion and duty", and no more was said: a gain of each took a third of all that was left, and
    nine tenths of the misfit. Of these 12 what is left was noise, 0.386 N for 0.3."""
    r = swept(np.tile(STROKES, 2))
    assert r.force is not None
    gains = np.linspace(1.0, 1.0 + change, len(r.names))
    log = noisy(replace(r, force=r.force * np.repeat(gains, np.diff(r.starts))), seed=21)
    found = diagnose(log, [], limits=False, learning=False)
    way = "rises" if change > 0.0 else "falls"
    told = re.search(rf"{way} in the order of the records, by ([0-9.]+) %", remaining_text(found))
    assert told is not None
    assert float(told[1]) == pytest.approx(100.0 * abs(change), rel=0.25)


def test_of_a_force_that_was_cut_nothing_of_the_kind_is_said() -> None:
    """It is `unexplained` for what lay beyond the limit, and what is left is noise."""
    r = swept(np.tile(STROKES, 2))
    log = noisy(r, seed=21)
    assert log.force is not None
    found = diagnose(
        replace(log, force=np.minimum(log.force, 0.8 * log.force.max())), [], limits=False
    )
    assert found.rig.cut
    assert "each record's own" not in remaining_text(found)


def test_gains_that_follow_what_the_test_set_are_no_course() -> None:
    """A law of the duty that a model lacks goes with the order in which duties were tested."""
    g = np.random.default_rng(5)
    duty = np.repeat([0.0, 0.1, 0.2, 0.3, 0.4], 3)
    gains = 1.0 + 0.2 * duty + 0.002 * g.standard_normal(15)
    assert course(gains, duty[:, None]) is None
    assert course(gains, g.permutation(duty)[:, None]) is not None


def test_a_drift_as_small_as_that_of_any_load_cell_is_no_course() -> None:
    order, scatter = np.arange(12), 1e-4 * np.array([1, -1, 0, 1, -1, 1, 0, -1, 1, -1, 0, 1])
    test = (order % 4)[:, None].astype(float)
    assert course(1.0 + 0.01 * order / 11 + scatter, test) is None
    assert course(1.0 + 0.04 * order / 11 + scatter, test) is not None


def test_few_records_have_no_course() -> None:
    order = np.arange(6)
    test = np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 2.0], [2.0, 1.0, 1.0]] * 2)
    assert course(1.0 + 0.02 * order, test) is None


def test_chance_makes_no_course() -> None:
    g = np.random.default_rng(6)
    said = [
        course(1 + 0.03 * g.standard_normal(12), g.standard_normal((12, 3))) for _ in range(2000)
    ]
    assert sum(s is not None for s in said) <= 8


@pytest.mark.parametrize("records", [2, 6])
def test_a_zero_that_all_records_share_has_its_name(records: int) -> None:
    r = swept(STROKES[:records])
    assert r.force is not None
    assert names(r, r.force - 0.5, "force_offset", "thermal_fade") == ["force_offset"]


def law(coordinate: str, knots: Array) -> LearnedEffect:
    return Law(LawSlot.FORCE, Curve(coordinate, tuple(knots.tolist()))).effect


def fit(problem: Problem, *effects: Effect) -> Hypothesis:
    return fit_hypothesis(problem, effects, [fresh_start(0.05, 0.4)])


@pytest.fixture(scope="module")
def scattered() -> tuple[Problem, Hypothesis, Hypothesis]:
    """Records with zeros of their own, and a law of the largest deflection that tells them."""
    r = swept(STROKES)
    problem = plus(r, np.repeat(ZEROS, np.diff(r.starts)))
    return problem, fit(problem), fit(problem, law("largest_x", STROKES))


def test_what_tells_records_apart_is_better_on_what_is_left_out_and_no_law(
    scattered: tuple[Problem, Hypothesis, Hypothesis],
) -> None:
    problem, base, labels = scattered
    assert compare_alike(problem, base, labels).significant
    assert not beyond_levels(problem, base, labels)


def test_what_acts_within_records_is_a_law() -> None:
    r = swept(STROKES)
    problem = plus(r, 3.0 * np.sin(np.pi * r.x / 0.018) ** 2)
    curve = law("abs_x", np.linspace(0.0, 0.018, 6))
    assert beyond_levels(problem, fit(problem), fit(problem, curve))


def test_what_the_levels_of_many_records_follow_is_a_law() -> None:
    """A softening with the largest stroke, which two records of each stroke have alike."""
    r = swept(np.linspace(0.004, 0.018, 10), 2)
    largest = np.concatenate([np.maximum.accumulate(np.abs(r.x[s])) for s in r.slices])
    problem = plus(r, 400.0 * largest)
    curve = law("largest_x", np.linspace(0.004, 0.018, 4))
    assert beyond_levels(problem, fit(problem), fit(problem, curve))


def test_a_record_that_is_left_out_is_predicted_by_what_the_others_tell(
    scattered: tuple[Problem, Hypothesis, Hypothesis],
) -> None:
    problem, base, labels = scattered
    starts = problem.block.signals.starts
    each = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    before, after = (
        float(np.mean(left_out_exactly(problem, each, h) ** 2)) for h in (base, labels)
    )
    assert after > 0.9 * before  # a half of it with the value that the record itself had told


def test_a_curve_stays_at_its_end_value_beyond_what_is_told() -> None:
    problem = prepare(noisy(swept(STROKES), seed=3))
    s = problem.block.signals
    effect = law("largest_x", STROKES)
    values = dict(fit(problem).values) | {effect.key(f"f_{k + 1}"): float(k) for k in range(6)}
    whole = np.ones(len(s))
    rest = np.where(np.arange(len(s)) < s.starts[4], whole, 0.0)  # the four shortest strokes
    told, own = as_told(Model((effect,)), values, s, rest, whole)
    (curve,) = (e.law.curve for e in told.effects if isinstance(e, LearnedEffect))
    assert curve.knots == tuple(STROKES[:4].tolist())
    assert [own[effect.key(f"f_{k + 1}")] for k in range(4)] == [0.0, 1.0, 2.0, 3.0]
    beyond = np.asarray(told.force(s, own) - Model().force(s, own))[s.starts[5] + 300 :]
    assert beyond == pytest.approx(3.0)
    same, _ = as_told(Model((effect,)), values, s, whole, whole)
    assert same.effects == (effect,)


def test_levels_of_a_record_with_few_samples_of_weight_speak_against_nothing() -> None:
    """A gain and a zero from a moment of a record miss the rest of it: what no model has to pay."""
    r = swept(STROKES)
    ripple = np.where(np.arange(len(r)) < r.starts[1], 3.0 * np.sin(40.0 * r.t), 0.0)
    problem = plus(r, np.repeat(ZEROS, np.diff(r.starts)) + 2.0 * np.sign(r.xdot) + ripple)
    weight = problem.block.weight.copy()
    fastest = 40 + int(np.argmax(np.abs(r.xdot[40:300])))
    weight[: r.starts[1]] = 0.0
    weight[fastest - 12 : fastest + 13] = 1.0
    problem = replace(problem, block=problem.block._replace(weight=weight))
    paper, rubbing = fit(problem), fit(problem, get("coulomb_friction"))
    assert compare_alike(problem, paper, rubbing).significant
    assert beyond_levels(problem, paper, rubbing)


@pytest.mark.long
def test_a_lag_under_a_held_duty_is_no_parameter_that_takes_of_levels(tmp_path: Path) -> None:
    """Dahl's damper in eight records, each with one duty of three: 43 % of the mean square, down
    to the noise, was held for chance: the lag of the viscosity counted, which no held duty shows.
    """
    file = tmp_path / "dahl.parquet"
    literature_dampers.log("dahl", 50, random=False).to_parquet(file)
    problem = prepare(read_logs([str(file)], need_force=True, report=lambda line: None).recording)
    paper, stretches = fresh_start(0.05, 0.4), {"preyield_elasticity.x_d": 2e-4}
    steady = fit_hypothesis(problem, (get("preyield_elasticity"),), [{**paper, **stretches}])
    growing = fit_hypothesis(
        problem, (get("preyield_elasticity"), get("field_viscosity")),
        [{**steady.values, "field_viscosity.r": 0.6, "field_viscosity.m": 2.0,
          "field_viscosity.T_v": 0.02}],
    )  # fmt: skip
    assert compare_alike(problem, steady, growing).significant
    assert beyond_levels(problem, steady, growing)
