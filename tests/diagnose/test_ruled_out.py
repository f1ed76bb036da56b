"""What the measured force alone rules out of an effect is no hypothesis, however well it fits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.errors import EffectFailed
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.diagnose.bounds import Bounds
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.screening import Screen
from erdctl.effects import get

RECORDING = noisy(campaign(100.0, 6.0), seed=4)
FRICTION = get("coulomb_friction")
SMOOTH = get("preyield_viscosity")


def test_a_hypothesis_beyond_what_a_log_allows_is_none() -> None:
    problem = prepare(RECORDING)
    task = Task("", (FRICTION,), ({},))
    free, tight = (
        Executor([problem], bounds=bounds)
        for bounds in (None, Bounds({}, {"coulomb_friction.F_c": -1.0}))
    )
    (found,) = free.fit(problem, [task])
    assert found is not None
    assert tight.fit(problem, [task]) == [None]
    # Without another one it may ask for more than with that: then it is no better than nothing.
    (refitted,) = tight.fit_compatible(problem, [task])
    assert refitted.cross_validated is problem.block.force
    assert free.fit_compatible(problem, [task])[0].score < 0.5 * refitted.score


def test_a_hypothesis_below_what_a_log_resolves_is_none() -> None:
    problem = prepare(RECORDING)
    task = Task("", (FRICTION,), ({},))
    assert Executor([problem], bounds=Bounds({"coulomb_friction.F_c": 1e3}, {})).fit(
        problem, [task]
    ) == [None]


def test_an_effect_that_would_go_beyond_it_is_no_candidate() -> None:
    problem = prepare(RECORDING)
    base = fit_hypothesis(problem, (), [{}])
    open_, tight = Screen(problem, base), Screen(problem, base, {"preyield_viscosity.v_y": 0.0})
    assert open_.candidate(SMOOTH) is not None
    assert tight.candidate(SMOOTH) is None


def test_what_an_effect_allows_is_checked() -> None:
    def unknown(s: Signals, force: Array) -> dict[str, float]:
        return {"w": 1.0}

    def endless(s: Signals, force: Array) -> dict[str, float]:
        return {"v_y": np.inf}

    block = prepare(RECORDING).block
    for wrong in (unknown, endless):
        with pytest.raises(EffectFailed, match=wrong.__name__):
            replace(SMOOTH, most=wrong).allowed(block.signals, block.force)
    assert SMOOTH.allowed(block.signals, block.force) == {}
