"""Which effects are worth a fit: seen through what the parent has, and from what a user gave."""

from __future__ import annotations

from dataclasses import replace

import pytest
from dampers import damper
from rig import campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.executor import executor
from erdctl.diagnose.forward_step import Exploration, Explored, _worth_a_fit
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.record_effects import NONE_VARY
from erdctl.diagnose.screening import Screen
from erdctl.effects import get
from erdctl.model.parameters import Parameters


def log_of(truth: Parameters, rms: float = 0.2) -> Problem:
    """The campaign as a damper would give it."""
    clean: Recording = campaign(100.0, 6.0)
    bare = prepare(clean, NONE_VARY)
    force = truth.model.force(bare.block.signals, truth.values)
    return prepare(noisy(replace(clean, force=force), 5, rms), NONE_VARY)


@pytest.mark.parametrize(
    ("there", "values"),
    [("force_smoothing", {"w": 0.15}), ("mount_compliance", {"s_m": 3e-4}),
     ("time_skew", {"tau": 0.03})],
)  # fmt: skip
def test_an_added_force_is_seen_through_what_the_parent_has(
    there: str, values: dict[str, float]
) -> None:
    """A friction behind an average has no corners, and one behind a spring comes late."""
    problem = log_of(damper(there, "coulomb_friction", F_c=4.0, **values))
    given = damper(there, **values)
    parent = fit_hypothesis(problem, given.model.effects, [given.values], 1)
    found = Screen(problem, parent).candidate(get("coulomb_friction"))
    assert found is not None
    assert found.gain > 0.6


def test_what_bent_the_given_model_is_seen_from_where_it_was_given() -> None:
    """A friction that the fit of a given power law has taken up is worth most before that fit."""
    problem = log_of(damper("shear_thinning", "coulomb_friction", F_c=9.0, n=0.9))
    given = damper("shear_thinning", n=0.9)
    base, told = (
        fit_hypothesis(problem, given.model.effects, [given.values], steps) for steps in (200, 1)
    )
    names = ("coulomb_friction", "quadratic_damping", "thermal_fade", "fluid_inertia")
    gains = []
    for view in (None, told):
        with executor((problem,), 1, lambda stage, what: None) as workers:
            x = Exploration(problem, base, Explored([base]), workers, view)
            found = _worth_a_fit(x, base, [get(n) for n in names])
            gains.append({c.effect.name: (c.gain, seen_from) for seen_from, c in found})
    assert gains[0]["coulomb_friction"][1] is base
    assert gains[1]["coulomb_friction"][1] is told
    left = [1.0 - g["coulomb_friction"][0] for g in gains]
    assert left[1] < 0.6 * left[0]
