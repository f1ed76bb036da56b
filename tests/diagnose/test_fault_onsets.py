"""Faults that set in within a record, hidden in the plant: kind, onset, ramp, and their place."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from erdctl.core.recording import Recording
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.localisation import since_onset
from erdctl.diagnose.screening import Screen
from erdctl.effects import get
from erdctl.estimate.onsets import onset_intervals
from erdctl.estimate.starts import fresh_start
from erdctl.model.effect import Variable
from erdctl.plant import CampaignRecord, DutyProgramme, Plant, Side, Trajectory
from erdctl.plant.simulate import force, ride

RATE, SECONDS = 200.0, 20.0
DAMPER = Plant(
    Side(k_nom=900.0, c_vis=64.6, T_d=0.043, sigma=12.8, beta=0.6),
    Side(k_nom=700.0, c_vis=68.8, T_d=0.030, sigma=17.0, beta=0.8),
)
FIELDS = {
    "oil_leakage": "oil",
    "electrical_fault": "electrical",
    "deformation_fault": "deformation",
}


@cache
def log(kind: str, onset: float, ramp: float) -> Recording:
    """One record of 20 s, white noise of 0.3 N, half of what the fault takes gone."""
    n = round(RATE * SECONDS)
    motion = Trajectory("tones", (0.006, 0.004, 0.002), (0.4, 0.9, 2.3), (0.1, 2.0, 4.0), 0.001)
    duty = DutyProgramme((0.1, 0.4, 0.0, 0.25, 0.5, 0.15) * 4, tuple(range(0, n, n // 24))[:24])
    over = ride(CampaignRecord("r1", RATE, n, motion, duty))
    plant = DAMPER.with_physics(onset=onset, ramp=ramp, **{FIELDS[kind]: 0.5})
    t, x, v = over.sampled()
    rest = 0.3 * np.random.default_rng(4).standard_normal(n)
    return Recording(
        t=t, x=x, xdot=v, duty=over.duty, force=force(plant, over) + rest,
        starts=np.array([0, n]), names=("r1",),
    )  # fmt: skip


@cache
def base(kind: str, onset: float, ramp: float) -> tuple[Problem, Hypothesis]:
    problem = prepare(log(kind, onset, ramp))
    return problem, fit_hypothesis(problem, (), [fresh_start(0.05, 0.4)])


CASES = [(kind, *when) for kind in FIELDS for when in ((13.21, 0.0), (7.3, 4.0))]


@pytest.mark.few(3)
@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c[0]}-{c[1]}-{c[2]}")
def test_kind_onset_and_ramp(case: tuple[str, float, float]) -> None:
    kind, onset, ramp = case
    problem, plain = base(*case)
    screen, fits = Screen(problem, plain), {}
    for name in FIELDS:
        effect = get(name)
        candidate = screen.candidate(effect)
        assert candidate is not None
        fits[name] = fit_hypothesis(problem, (effect,), [{**plain.values, **candidate.starts[0]}])
        if name == kind:
            # What the screen counted is what the fit gains: one step from the parent's values alone
            # would count a tenth of it.
            gain = 1.0 - fits[name].fitted.cost / plain.fitted.cost
            assert gain > 0.8
            assert candidate.gain == pytest.approx(gain, rel=0.25)
    assert min(fits, key=lambda name: fits[name].score) == kind
    best, effect = fits[kind], get(kind)
    assert best.values[effect.key("f")] == pytest.approx(0.5, abs=0.02)
    found = onset_intervals(best.model, problem.block, best.values, problem.held)
    for symbol, truth in (("t_0", onset), ("t_r", ramp)):
        low, high = found[effect.key(symbol)]
        assert low <= truth <= high, symbol
        assert high - low < 0.5, symbol
    assert np.sqrt(best.score) < 1.05 * 0.3


def test_where_it_acts_is_the_time_from_its_onset_on() -> None:
    problem, _ = base("oil_leakage", 13.21, 0.0)
    effect = get("oil_leakage")
    square = np.where(problem.block.signals.t >= 15.0, 1.0, 0.0)
    [region] = since_onset(problem, [effect, get("backlash")], {effect.key("t_0"): 13.21}, square)
    assert (region.variable, region.low) == (Variable.TIME, 13.21)
    assert region.high == pytest.approx(SECONDS - 1 / RATE)
    assert region.share == pytest.approx(1.0)
    assert "from 13.21 s to the end" in region.text
    assert since_onset(problem, [effect], {effect.key("t_0"): 25.0}, square) == []
