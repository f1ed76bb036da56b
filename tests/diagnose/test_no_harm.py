"""What does not help on data that the fit has not seen is dropped, whatever else is good."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.progress import Progress
from erdctl.diagnose.backward_step import as_good_as_explored, eliminate
from erdctl.diagnose.carry_over import to_other_records
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.executor import executor
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.forward_step import Exploration, Explored, key_of
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis, over_records, slopes
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.record_effects import RecordEffects
from erdctl.effects import get
from erdctl.estimate.covariance import Fit
from erdctl.estimate.starts import fresh_start

START = fresh_start(0.05, 0.4)


@pytest.fixture(scope="module")
def problem() -> Problem:
    """Friction, and nothing else."""
    r = noisy(campaign(100.0), seed=11)
    assert r.force is not None
    return prepare(replace(r, force=r.force + 2.0 * np.sign(r.xdot)))


def fit(problem: Problem, *names: str) -> Hypothesis:
    return fit_hypothesis(problem, [get(n) for n in names], [START])


def exploration(problem: Problem, *hypotheses: Hypothesis) -> Exploration:
    with executor((problem,), 1, lambda stage, what: None) as here:
        return Exploration(problem, hypotheses[0], Explored(hypotheses), here)


def test_a_useless_effect_goes_and_a_useful_one_stays(problem: Problem) -> None:
    base, best = fit(problem), fit(problem, "coulomb_friction", "quadratic_damping")
    left = eliminate(exploration(problem, base, best), best)
    assert [e.name for e in left.effects] == ["coulomb_friction"]


def test_a_harmful_effect_goes_though_another_hypothesis_is_better(problem: Problem) -> None:
    """That other one used to keep it: without it, the rest misses that one as well."""
    base, friction = fit(problem), fit(problem, "coulomb_friction")
    worse = fit(problem, "gas_preload")
    noise = np.random.default_rng(1).standard_normal(len(base.residual))
    worse = replace(worse, cross_validated=base.cross_validated + 0.2 * noise)
    x = exploration(problem, base, friction, worse)
    assert compare(problem, base, worse).gain < 0.0
    assert eliminate(x, worse).effects == ()


def test_what_carries_over_to_other_records_stays(problem: Problem) -> None:
    base, friction = fit(problem), fit(problem, "coulomb_friction")
    x = exploration(problem, base, friction)
    assert to_other_records(x, friction) is friction
    assert len(np.unique(over_records(friction).problem.group)) == len(problem.recording.names)


def test_one_step_that_goes_astray_takes_nothing_away(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fits anew decide: a void's law is far from straight, and its step was twice the force."""
    base, friction = fit(problem), fit(problem, "coulomb_friction")

    def astray(h: Hypothesis) -> Hypothesis:
        return replace(h, cross_validated=(3.0 if h.effects else 1.0) * h.cross_validated)

    module = sys.modules[to_other_records.__module__]
    monkeypatch.setattr(module, "over_records", astray)
    assert to_other_records(exploration(problem, base, friction), friction) is friction
    monkeypatch.setattr(module, "_error", lambda problem, parts, h, says: float(bool(h.effects)))
    assert to_other_records(exploration(problem, base, friction), friction).effects == ()


def test_a_lag_that_is_over_within_a_sample_is_not_moved(problem: Problem) -> None:
    """The one sample behind a turn that sees it would make leaving out its group a leap."""
    base = fit(problem)
    short = {**base.values, "compression.T_d": 1.01e-5}
    instant = replace(base, fitted=replace(base.fitted, values=short))
    assert "compression.T_d" in base.free
    assert "compression.T_d" not in instant.free
    assert len(slopes(instant)) == len(slopes(base)) - 1
    last, _ = fit_errors(problem, instant)
    assert last.values["compression.T_d"] == short["compression.T_d"]


def test_what_is_left_of_a_replacement_must_do_as_well(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two steps down, each of them not significant, may be so together."""
    base, friction, preload = fit(problem), fit(problem, "coulomb_friction"), fit(problem)
    other = fit(problem, "gas_preload")
    same = replace(other.fitted, residual=friction.residual)
    other = replace(other, fitted=same, cross_validated=0.999 * friction.cross_validated)
    x = exploration(problem, base, friction, other)
    assert as_good_as_explored(x, friction) is other
    module = sys.modules[as_good_as_explored.__module__]
    monkeypatch.setattr(module, "eliminate", lambda x, h: preload)
    assert as_good_as_explored(x, friction) is friction


def test_a_richer_form_must_earn_its_name(problem: Problem) -> None:
    simple, rich = fit(problem, "coulomb_friction"), fit(problem, "stribeck_friction")
    assert is_preferred(problem, simple, rich)
    assert not is_preferred(problem, rich, simple)


@pytest.mark.long
def test_an_effect_of_which_nothing_is_left_between_samples_is_no_finding(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What it took was that the log's steps are long for what happens in them."""
    r = noisy(campaign(100.0, 6.0), seed=12)
    assert r.force is not None
    log = replace(r, force=r.force + 2.0 * np.sign(r.xdot) + 40.0 * r.xdot * np.abs(r.xdot))
    catalogue = [get("coulomb_friction"), get("quadratic_damping")]
    assert {f.effect.name for f in diagnose(log, catalogue, limits=False).findings} == {
        "coulomb_friction", "quadratic_damping",
    }  # fmt: skip
    module = sys.modules[diagnose.__module__]

    def none_left(
        problem: Problem, h: Hypothesis, progress: Progress, threads: int
    ) -> tuple[Fit, RecordEffects | None]:
        last, effects = fit_errors(problem, h, progress, threads)
        off = get("quadratic_damping").off if "quadratic_damping" in key_of(h.effects) else {}
        return replace(last, values={**last.values, **off}), effects

    monkeypatch.setattr(module, "fit_errors", none_left)
    found = diagnose(log, catalogue, limits=False)
    assert [f.effect.name for f in found.findings] == ["coulomb_friction"]
    assert found.corrected.overall.nrmse > 0.0


def test_a_stiffness_that_is_not_there_has_an_upper_bound(problem: Problem) -> None:
    """At its bound of 0, with a start of 0, nothing said how far to look: it looked for ever."""
    less = problem.block.force - 300.0 * problem.block.signals.x
    block = problem.block._replace(force=less)
    h = fit(replace(problem, block=block), "coulomb_friction")
    gone = [n for n in ("compression.k_nom", "release.k_nom") if h.values[n] == 0.0]
    assert gone
    last, _ = fit_errors(h.problem, h)
    for name in gone:
        low, high = last.intervals[name]
        assert low == 0.0
        assert 0.0 < high < 100.0
