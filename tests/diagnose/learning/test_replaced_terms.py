"""A law corrects a term of the model, or a name; it does not take the place of either."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.learning.replaced_terms import (
    said_again,
    still_act,
    takes_the_place_of_a_term,
)
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.model.composed import Model
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot


@pytest.fixture(scope="module")
def paper() -> Hypothesis:
    return fit_hypothesis(prepare(noisy(campaign(100.0, 4.0), seed=8)), (), [TRUTH], 20)


def left(found: Hypothesis, part: float, *names: str) -> Hypothesis:
    """The same with a part of some parameters."""
    values = {**found.values, **{n: part * found.values[n] for n in names}}
    return replace(found, fitted=replace(found.fitted, values=values))


@pytest.mark.parametrize(
    "names", [("compression.sigma", "release.sigma"), ("compression.c_vis",), ("release.k_nom",)]
)
def test_of_a_term_that_is_left_hundredths_the_place_is_taken(
    paper: Hypothesis, names: tuple[str, ...]
) -> None:
    assert takes_the_place_of_a_term(paper, left(paper, 0.02, *names))
    assert not takes_the_place_of_a_term(paper, left(paper, 0.5, *names))
    # Nor is there a place to take of what was next to nothing before.
    nothing = left(paper, 1e-3, *names)
    assert not takes_the_place_of_a_term(nothing, left(nothing, 0.02, *names))


def test_a_factor_of_the_yield_force_corrects_it(paper: Hypothesis) -> None:
    duties = (0.0, 0.1, 0.2, float(paper.problem.recording.duty.max()))
    effect = Law(LawSlot.YIELD, Curve("duty", duties)).effect
    factor = fit_hypothesis(paper.problem, (effect,), [TRUTH], 30)
    assert not takes_the_place_of_a_term(paper, factor)


def test_what_does_the_same_as_a_name_does_not_take_its_place() -> None:
    """A factor over the travel since a turn is a yield force that rebuilds, and no friction."""
    clean, rebuilds, rubs = (
        campaign(100.0, 4.0),
        get("preyield_elasticity"),
        get("coulomb_friction"),
    )
    force = Model((rebuilds,)).force(Signals.of(clean), {**TRUTH, rebuilds.key("x_d"): 1e-3})
    problem = prepare(noisy(replace(clean, force=force), seed=8))
    effect = Law(LawSlot.YIELD, Curve("unsettled_way", (0.0, 0.25, 0.5, 1.0))).effect
    law = fit_hypothesis(problem, (effect,), [{**TRUTH, effect.key("tau"): 1e-3}], 40)
    named = fit_hypothesis(problem, (rebuilds,), [{**TRUTH, rebuilds.key("x_d"): 1e-3}], 20)
    assert said_again(named, law) == (rebuilds,)
    assert not said_again(law, law)  # which lacks nothing
    both = fit_hypothesis(problem, (rebuilds, effect), [{**law.values, **named.values}], 5)
    assert not said_again(named, both)
    gone = left(both, 0.0, rebuilds.key("x_d"))
    assert still_act((rebuilds,), named, left(named, 0.5, rebuilds.key("x_d")))
    assert not still_act((rebuilds,), named, gone)
    other = fit_hypothesis(problem, (rubs,), [TRUTH], 20)
    assert not said_again(other, law)
