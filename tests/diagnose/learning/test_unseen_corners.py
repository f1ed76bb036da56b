"""A law says nothing large where no sample lies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.learning.unseen_corners import goes_beyond_what_was_seen
from erdctl.diagnose.problem import prepare
from erdctl.model.composed import Model
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.learned.surface import Surface


@pytest.fixture(scope="module")
def paper() -> Hypothesis:
    return fit_hypothesis(prepare(noisy(campaign(100.0, 4.0), seed=8)), (), [TRUTH], 20)


def over(paper: Hypothesis, first: str, second: str) -> LearnedEffect:
    r = paper.problem.recording
    z, y = (np.linspace(c.min(), c.max(), 4) for c in (getattr(r, first), getattr(r, second)))
    surface = Surface(first, tuple(z.tolist()), across=Curve(second, tuple(y.tolist())))
    return Law(LawSlot.FORCE, surface).effect


def with_values(paper: Hypothesis, effect: LearnedEffect, values: list[float]) -> Hypothesis:
    sizes = {effect.key(q.symbol): v for q, v in zip(effect.quantities, values, strict=True)}
    model = Model((*paper.effects, effect))
    fitted = replace(paper.fitted, model=model, values={**paper.values, **sizes})
    return replace(paper, fitted=fitted)


def test_a_corner_that_no_motion_reaches_is_beyond() -> None:
    """Deflection and speed of a sine lie on an ellipse, and its corners hold no sample."""
    r = campaign(100.0, 4.0).select([0])
    one = fit_hypothesis(prepare(noisy(r, seed=8)), (), [TRUTH], 20)
    effect = over(one, "x", "xdot")
    calm = np.ones((4, 4))
    assert not goes_beyond_what_was_seen(with_values(one, effect, calm.ravel().tolist()))
    calm[0, 0] = 40.0
    assert goes_beyond_what_was_seen(with_values(one, effect, calm.ravel().tolist()))


def test_a_plane_that_is_filled_may_be_large_anywhere(paper: Hypothesis) -> None:
    effect = over(paper, "x", "duty")
    found = fit_hypothesis(paper.problem, (effect,), [TRUTH], 20)
    assert not goes_beyond_what_was_seen(found)


def test_a_curve_through_two_values_of_nearly_one_level_is_beyond(paper: Hypothesis) -> None:
    """The log has the levels 0, 0.1, 0.2, 0.3 and 0.45: what is far off at 0.25 no sample shows."""
    near = Law(LawSlot.FORCE, Curve("duty", (0.0, 0.2, 0.3, 0.45))).effect
    assert not goes_beyond_what_was_seen(with_values(paper, near, [0.0, 5.0, -5.0, 0.0]))
    off = Law(LawSlot.FORCE, Curve("duty", (0.0, 0.2, 0.25, 0.3, 0.45))).effect
    assert goes_beyond_what_was_seen(with_values(paper, off, [0.0, 1.0, 20.0, 1.0, 0.0]))


def test_the_piston_goes_no_farther_than_the_rod(paper: Hypothesis) -> None:
    """Beside a noisy velocity column a deflection 40 times as large was learned (1492006 of
    `velocity_noise`): with a fortieth of the stiffness, and a velocity of the deflection alone.
    It took the place of the name."""
    knots = tuple(np.linspace(paper.problem.block.signals.x.min(), 0.02, 3).tolist())
    bent = Law(LawSlot.DEFLECTION, Curve("x", knots)).effect
    size = float(np.ptp(paper.problem.block.signals.x))
    assert not goes_beyond_what_was_seen(with_values(paper, bent, [-0.1 * size, 0.0, 0.1 * size]))
    assert goes_beyond_what_was_seen(with_values(paper, bent, [-20.0 * size, 0.0, 20.0 * size]))
