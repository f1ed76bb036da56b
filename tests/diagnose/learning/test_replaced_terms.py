"""A law corrects a term of the model; one that takes its place is none."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rig import TRUTH, campaign, noisy

from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.learning.replaced_terms import takes_the_place_of_a_term
from erdctl.diagnose.problem import prepare
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
