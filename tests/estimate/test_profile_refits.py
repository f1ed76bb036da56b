"""A profile's fits go as far as its interval asks, and whoever waits is told of which it is."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate import profile_cost
from erdctl.estimate.covariance import Fit
from erdctl.estimate.last_step import assess
from erdctl.estimate.least_squares import Fitted, fit
from erdctl.model.composed import Model

NAMES = ("force_smoothing", "preyield_viscosity")


def assessed(progress: Any, threads: int = 1) -> Fit:
    """A model of the wrong form: what is left is a force of its own, many times the noise."""
    r = noisy(campaign(250.0, 6.0), seed=11)
    noise = 0.3 * np.random.default_rng(2).standard_normal(len(r.x))
    yields = 12.0 * np.sqrt(r.duty) * np.tanh(r.xdot / 0.01)
    force = 200.0 * r.x + 80.0 * r.xdot + yields + 3.0 * np.sin(900.0 * r.x) + noise
    model = Model(tuple(get(n) for n in NAMES))
    paper = {"k_nom": 200.0, "c_vis": 80.0, "sigma": 12.0, "beta": 0.5, "T_d": 1.4e-5}
    start = {f"{d}.{n}": v for d in ("compression", "release") for n, v in paper.items()}
    start |= {"force_smoothing.w": 0.008, "preyield_viscosity.v_y": 0.01}
    block = prepare(replace(r, force=force)).block
    values = fit(model, block, start=start, max_evaluations=25).values
    return assess(model, [block], values, threads=threads, progress=progress)


@pytest.mark.long
def test_refits_end_where_a_step_gains_nothing_that_an_interval_would_show(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On 103,000 samples of a real damper, where a misfit is left, they took five minutes."""
    counted: list[int] = []
    told: list[tuple[str, str]] = []

    def search(*args: Any, **options: Any) -> Fitted:
        found = fit(*args, **options)
        counted.append(found.evaluations)
        return found

    monkeypatch.setattr(profile_cost, "fit", search)
    found = assessed(lambda stage, what: told.append((stage, what)))
    few = sum(counted)
    counted.clear()
    monkeypatch.setattr(profile_cost, "SETTLED", 1e-8)
    finely = assessed(lambda stage, what: None)
    assert 0 < few < 0.9 * sum(counted)
    assert found.intervals.keys() == finely.intervals.keys()
    for name, ends in finely.intervals.items():
        assert found.intervals[name] == pytest.approx(ends, rel=0.02), name
    assert {stage for stage, _ in told} == {"intervals"}
    assert any(what.startswith("force_smoothing.w, ") for _, what in told)


def test_intervals_are_the_same_by_any_number_of_threads() -> None:
    """Also where a profile finds a better value, from which what comes after it begins."""
    told: list[str] = []
    alone = assessed(lambda stage, what: told.append(what))
    names = list(told)
    told.clear()
    together = assessed(lambda stage, what: told.append(what), threads=3)
    assert told == names
    assert alone.intervals
    assert together.intervals == alone.intervals
    assert together.values == alone.values
