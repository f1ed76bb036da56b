"""A friction that builds up over travel is looked for over what travel leaves of the direction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rig import TRUTH, campaign, noisy

from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.learning.law_screen import LawScreen
from erdctl.diagnose.learning.laws import laws
from erdctl.diagnose.problem import prepare
from erdctl.model.learned.law import LearnedEffect

FRICTION, TRAVEL = 8.0, 0.004  # N, m: of the size of the strokes


def test_it_promises_most_where_a_friction_builds_up_over_travel() -> None:
    log = campaign(100.0, 4.0)
    assert log.force is not None
    force = log.force.copy()
    for a, b in zip(log.starts[:-1], log.starts[1:], strict=True):
        z = np.sign(log.xdot[a])
        for i in range(a, b):
            moved = log.x[i] - log.x[max(i - 1, a)]
            z = np.sign(moved) + (z - np.sign(moved)) * np.exp(-abs(moved) / TRAVEL)
            force[i] += FRICTION * z
    problem = prepare(noisy(replace(log, force=force), seed=6))
    screen = LawScreen(problem, fit_hypothesis(problem, (), [TRUTH], 20))
    found = [c for c in (screen.candidate(law.effect) for law in laws(problem)) if c is not None]
    best = max(found, key=lambda c: c.gain)
    assert isinstance(best.effect, LearnedEffect)
    assert best.effect.law.curve.coordinate == "unsettled_way"
