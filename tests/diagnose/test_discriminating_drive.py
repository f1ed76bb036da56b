"""A drive is advised where two hypotheses differ on it by what can be measured."""

from __future__ import annotations

from dataclasses import replace

from rig import TRUTH, campaign, noisy

from erdctl.diagnose.discriminating_drive import discriminating_drive
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get


def test_no_drive_is_advised_on_which_both_are_the_same() -> None:
    """A preload, and a stop as soft that holds all of the stroke, were to be told apart by a drive
    "where they differ by 1.26e-07 N rms"."""
    r = noisy(campaign(100.0, 8.0), seed=1)
    assert r.force is not None
    problem = prepare(replace(r, force=r.force + 8.0))
    preload = get("gas_preload")
    key = preload.key("F_0")
    best = fit_hypothesis(problem, [preload], [TRUTH | {key: 8.0}])
    same, other = (
        replace(best, fitted=replace(best.fitted, values=best.values | {key: best.values[key] + d}))
        for d in (1e-6, 1.0)
    )
    assert discriminating_drive(problem, best, [("end_stop", same)]) is None
    told = discriminating_drive(problem, best, [("end_stop", other)])
    assert told is not None
    assert round(told.difference, 6) == 1.0
