"""An interval holds its value, also where the profile of another parameter has moved that."""

from __future__ import annotations

from typing import Any

import pytest
from rig import campaign, noisy

from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate import intervals
from erdctl.estimate.profile_cost import ProfileData
from erdctl.estimate.starts import fresh_start

FIRST, SECOND = "backlash.g", "input_delay.tau"


@pytest.fixture
def best() -> Hypothesis:
    r = noisy(campaign(duration=6.0), seed=3)
    start = fresh_start(0.05, 0.4) | {FIRST: 5e-4, SECOND: 5e-3}
    return fit_hypothesis(prepare(r), (get("backlash"), get("input_delay")), [start])


@pytest.mark.parametrize("again", [True, False])
def test_it_is_looked_for_anew_and_holds_the_value(
    best: Hypothesis, again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """again : whether the second profile of the first has the value inside."""
    asked: list[str] = []

    def profile(own: Any, name: str, values: dict[str, float]) -> Any:
        asked.append(name)
        here = values[name]
        to = here + 1e-3 if name == SECOND and asked.count(name) == 1 else here
        off = 0.0 if again or asked.count(name) == 1 else 2e-4
        return intervals._Profile(None, to, to - 1e-4 + off, to + 1e-4 + off, None, [])

    def taken_up(data: ProfileData, values: dict[str, float], name: str, rest: Any) -> Any:
        return {**values, FIRST: values[FIRST] + 5e-4}

    def likes(data: ProfileData, here: Any, others: Any) -> Any:
        return others[0]

    monkeypatch.setattr(intervals._Own, "profile", profile)
    monkeypatch.setattr(ProfileData, "taken_up", taken_up)
    monkeypatch.setattr(ProfileData, "best", likes)
    fit, _ = fit_errors(best.problem, best, lambda stage, what: None, 1)
    assert asked.count(FIRST) == 2
    low, high = fit.intervals[FIRST]
    assert low <= fit.values[FIRST] <= high
    assert high - low < 4e-4
