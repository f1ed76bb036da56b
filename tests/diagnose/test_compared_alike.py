"""Two hypotheses are held against each other as fitted to the same samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.comparison import compare, compare_alike
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis, weighed_as
from erdctl.diagnose.problem import Problem, prepare
from erdctl.estimate.starts import fresh_start

BAD = slice(300, 320)  # samples of one reversal that miss by 40 N


@pytest.fixture(scope="module")
def problem() -> Problem:
    log = noisy(campaign(rate=50.0), seed=3)
    assert log.force is not None
    force = log.force.copy()
    force[BAD] += 40.0
    return prepare(replace(log, force=force))


def fitted(problem: Problem) -> Hypothesis:
    return fit_hypothesis(problem, (), [fresh_start(0.05, 0.4)])


def spared(problem: Problem) -> Problem:
    weight = problem.block.weight.copy()
    weight[BAD] = 0.0
    return replace(problem, block=problem.block._replace(weight=weight))


def test_one_step_is_the_fit_without_these_samples(problem: Problem) -> None:
    part = spared(problem)
    again, true = weighed_as(fitted(problem), part.block.weight), fitted(part)
    use = part.block.weight > 0
    missed = [np.std(h.cross_validated[use]) for h in (fitted(problem), again, true)]
    assert missed[0] > 1.01 * missed[2]
    assert missed[1] == pytest.approx(missed[2], rel=1e-3)


def test_what_is_only_spared_samples_gains_nothing(problem: Problem) -> None:
    whole, part = fitted(problem), fitted(spared(problem))
    assert compare(problem, whole, part).gain > 0.02
    assert abs(compare_alike(problem, whole, part).gain) < 0.002
