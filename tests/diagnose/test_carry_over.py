"""An effect is kept only if it carries over to kinds of motion that the fit has not seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from rig import noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose import carry_over, thresholds
from erdctl.diagnose.carry_over import (
    carries_over_as_well,
    left_out_exactly,
    to_every_kind,
    to_other_motions,
)
from erdctl.diagnose.executor import executor
from erdctl.diagnose.forward_step import Exploration, Explored
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.kinds_of_excitation import kinds_of_motion
from erdctl.diagnose.problem import Problem, prepare
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot

MOTIONS = ((0.7, 0.02), (1.9, 0.01), (3.1, 0.006), (1.2, 0.014))
STEPS = (0.0, 0.1, 0.2, 0.3)
ONE_KIND = (4.0, -1.0, -1.0, -1.0)  # N, constant in the records of each motion


def log() -> Recording:
    """Friction everywhere, and a constant force that each kind of motion has of its own."""
    random, out = np.random.default_rng(4), []
    for i in range(len(MOTIONS)):
        for k in range(3):
            one = moved(i, k, random if k else 0.0)
            assert one.force is not None
            out.append(replace(one, force=one.force + 1.5 * np.sign(one.xdot) + ONE_KIND[i]))
    return noisy(concatenate(out), seed=6)


def moved(i: int, k: int, control: np.random.Generator | float, late: int = 0) -> Recording:
    """One record of a motion, its control held or stepping at random, felt some samples late."""
    t = np.arange(500) / 100.0
    tones = trajectories.sine(*MOTIONS[i], 0.3 * i)
    duty = np.full(len(t), control) if isinstance(control, float) else (
        trajectories.random_hold(control, t, STEPS)
    )  # fmt: skip
    felt = np.concatenate([np.full(late, duty[0]), duty[: len(t) - late]])
    one = recording(t, tones.x(t), tones.velocity(t), felt, f"{i}-{k}", tones.velocity_at)
    return replace(one, duty=duty)


@pytest.fixture(scope="module")
def problem() -> Problem:
    return prepare(log())


def fit(problem: Problem, *names: str) -> Hypothesis:
    return fit_hypothesis(problem, [get(n) for n in names], [fresh_start(0.05, 0.4)])


def test_what_one_kind_of_motion_has_alone_is_dropped(problem: Problem) -> None:
    best = fit(problem, "coulomb_friction", "gas_preload")
    base = fit(problem)
    with executor((problem,), 1, lambda stage, what: None) as here:
        x = Exploration(problem, base, Explored([base, best]), here)
        left = to_other_motions(x, best)
    assert [e.name for e in left.effects] == ["coulomb_friction"]


def test_nor_does_it_come_back_in_the_place_of_another(problem: Problem) -> None:
    best, rival = fit(problem, "coulomb_friction"), fit(problem, "coulomb_friction", "gas_preload")
    with executor((problem,), 1, lambda stage, what: None) as here:
        x = Exploration(problem, fit(problem), Explored([best, rival]), here)
        assert not carries_over_as_well(x, rival, best)
        assert carries_over_as_well(x, best, rival)
        assert carries_over_as_well(x, best, best)


@pytest.mark.parametrize(("elsewhere", "kept"), [(0.97, True), (0.7, False)])
def test_much_is_not_given_for_a_little_elsewhere(
    problem: Problem, monkeypatch: pytest.MonkeyPatch, elsewhere: float, kept: bool
) -> None:
    """Of a real damper with two motions what took half of the error went for 3 % at the other."""
    base, best = fit(problem), fit(problem, "coulomb_friction")
    monkeypatch.setattr(thresholds, "DEAR", 1.05)
    assert base.score > thresholds.DEAR * best.score
    monkeypatch.setattr(carry_over, "_error", lambda few, kinds, h: 1.0 if h.effects else elsewhere)
    with executor((problem,), 1, lambda stage, what: None) as here:
        x = Exploration(problem, base, Explored([base, best]), here)
        assert bool(to_other_motions(x, best).effects) == kept


def test_each_kind_is_predicted_by_a_fit_to_the_others_alone(problem: Problem) -> None:
    kinds = kinds_of_motion(problem.recording)
    assert kinds is not None
    found = left_out_exactly(problem, kinds, fit(problem, "coulomb_friction"))
    first = kinds[problem.recording.starts[:-1]]
    rest = problem.of([r for r in range(len(first)) if first[r] != first[0]])
    apart = fit(rest, "coulomb_friction")
    own = problem.of([r for r in range(len(first)) if first[r] == first[0]])
    force = apart.model.force(own.block.signals, apart.values)
    assert found[kinds == first[0]] == pytest.approx(own.block.force - force, abs=0.02)


def test_what_diverges_without_a_kind_of_motion_predicts_nothing(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def diverged(rest: Problem, *_: object) -> np.ndarray:
        return np.full(len(rest.block.force), np.nan)

    kinds = kinds_of_motion(problem.recording)
    assert kinds is not None
    monkeypatch.setattr(carry_over, "fitted_from", diverged)
    assert left_out_exactly(problem, kinds, fit(problem)) == pytest.approx(problem.block.force)


def test_what_one_kind_of_motion_alone_can_tell_is_not_held_against_it() -> None:
    """The duty steps at one motion only: a dead time is told there, and by nothing else."""
    random = np.random.default_rng(11)
    out = [
        moved(i, k, random if i == 1 else STEPS[(i + k) % 4], late=15)
        for i in range(len(MOTIONS)) for k in (0, 1)
    ]  # fmt: skip
    problem = prepare(noisy(concatenate(out), seed=7))
    base = fit_hypothesis(problem, [], [fresh_start(0.05, 0.4)])
    best = fit_hypothesis(problem, [get("input_delay")], [{**base.values, "input_delay.tau": 0.15}])
    kinds = kinds_of_motion(problem.recording)
    assert kinds is not None
    before, after = (float(np.mean(left_out_exactly(problem, kinds, h) ** 2)) for h in (base, best))
    assert after < 0.5 * before
    with executor((problem,), 1, lambda stage, what: None) as here:
        x = Exploration(problem, base, Explored([base, best]), here)
        assert [e.name for e in to_other_motions(x, best).effects] == ["input_delay"]


@pytest.mark.parametrize(
    ("slopes", "kept"),
    [((300.0,) * 4, True), ((15.0,) * 4, False), ((-900.0, 300.0, 300.0, 300.0), False)],
)
def test_a_law_must_be_likely_to_gain_at_another_motion(
    slopes: tuple[float, ...], kept: bool
) -> None:
    """It is not where it gains a few per cent everywhere, or fails at some for what others gain."""
    out = []
    for i in range(len(MOTIONS)):
        for k in range(3):
            one = moved(i, k, 0.0)
            assert one.force is not None
            drag = slopes[i] * np.abs(one.x) * np.sign(one.xdot)
            out.append(replace(one, force=one.force + drag))
    problem = prepare(noisy(concatenate(out), seed=8))
    law = Law(LawSlot.FRICTION, Curve("abs_x", (0.0, 0.02), "line")).effect
    start = fresh_start(0.04, 0.5)
    base = fit_hypothesis(problem, (), [start], 20)
    best = fit_hypothesis(problem, (law,), [{**start, **law.off}], 20)
    with executor((problem,), 1, lambda stage, what: None) as running:
        x = Exploration(problem, base, Explored([base, best]), running)
        assert (to_every_kind(x, best) is best) == kept


def test_records_each_of_their_own_kind_are_of_three() -> None:
    records = [moved(i, 0, 0.0) for i in range(4)]
    own = concatenate(records)
    assert kinds_of_motion(own) is None
    kinds = kinds_of_motion(own, coarse=True)
    assert kinds is not None
    assert len(set(kinds.tolist())) == 3


@pytest.mark.parametrize(("levels", "held"), [((0.3,), True), ((0.1, 0.3), False)])
def test_what_the_rest_tells_only_beside_another_is_held_with_it(
    levels: tuple[float, ...], held: bool
) -> None:
    """One level of duty fixes sigma v^beta and neither: beta stays, and sigma is fitted."""
    random = np.random.default_rng(12)
    out = [
        moved(i, k, random if i == 1 else levels[k % len(levels)])
        for i in range(len(MOTIONS)) for k in (0, 1)
    ]  # fmt: skip
    problem = prepare(noisy(concatenate(out), seed=9))
    kinds = kinds_of_motion(problem.recording)
    assert kinds is not None
    steps = int(kinds[problem.recording.starts[2]])
    alone = set(carry_over._told_by(problem, kinds, fit(problem)).alone(steps))
    betas, sigmas = ({f"{d}.{s}" for d in ("compression", "release")} for s in ("beta", "sigma"))
    assert (betas <= alone) == held
    assert not alone & sigmas
