"""A thermometer in the log is a coordinate: what the fluid does with the temperature is learned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.learning.laws import laws
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.io.effect_test_file import motion
from erdctl.model.composed import Model
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import remarks, simulate

FALL = 0.015  # of viscosity and yield stress for each degree
LAW = Law(LawSlot.FLUID, Curve("temperature", (15.0, 25.0, 35.0, 45.0), zero_first=True))


def warm(log: Recording, seed: int) -> Recording:
    """A test through a day: each record begins where the oil is by then, and warms it."""
    random = np.random.default_rng(seed)
    temperature = np.empty(len(log))
    for part in log.slices:
        begins = random.uniform(18.0, 38.0)
        temperature[part] = begins + 0.4 * (log.t[part] - log.t[part][0])
    return replace(log, temperature=temperature + random.normal(0.0, 0.05, len(log)))


def thinning(log: Recording) -> Array:
    """The force of a fluid that thins as it warms [N]."""
    assert log.temperature is not None
    parts = Model().parts(Signals.of(log), TRUTH)
    thin = np.exp(-FALL * (log.temperature - 25.0))
    return np.asarray(parts["gas"] + thin * (parts["viscous"] + parts["yield"]))


@pytest.fixture(scope="module")
def thinned() -> Diagnosis:
    log = warm(campaign(100.0, 8.0), seed=7)
    r = noisy(replace(log, force=thinning(log)), seed=51)
    return diagnose(r, [get("thermal_fade"), get("coulomb_friction")], limits=False)


@pytest.mark.long
def test_the_law_is_one_of_the_temperature(thinned: Diagnosis) -> None:
    assert thinned.verdict is Verdict.UNEXPLAINED
    assert thinned.learned is not None
    said = thinned.learned.laws[0].law
    assert said.slot is LawSlot.FLUID
    assert said.curve.coordinate == "temperature"


def test_it_is_right_at_other_temperatures(thinned: Diagnosis) -> None:
    fresh = warm(campaign(100.0, 5.0), seed=8)
    target, signals = thinning(fresh), Signals.of(fresh)
    assert thinned.learned is not None
    hypotheses = (thinned.selection.base, thinned.learned.selection.best)
    before, after = (float(np.std(target - h.model.force(signals, h.values))) for h in hypotheses)
    assert after < 0.2 * before


def test_a_temperature_that_nothing_depends_on_is_no_law() -> None:
    r = noisy(warm(campaign(100.0, 8.0), seed=9), seed=52)
    found = diagnose(r, [get("thermal_fade"), get("coulomb_friction")], limits=False)
    assert found.verdict is Verdict.ADEQUATE
    assert found.learned is None


def test_a_log_without_a_thermometer_offers_no_such_law() -> None:
    log = noisy(campaign(100.0, 4.0), seed=3)
    with_one = {law.curve.coordinate for law in laws(prepare(warm(log, seed=3)))}
    without = {law.curve.coordinate for law in laws(prepare(log))}
    assert with_one - without == {"temperature"}


def test_a_log_without_a_thermometer_is_refused() -> None:
    """Whoever simulates is told what is missing, and beyond what was seen the law stays."""
    effect = LAW.effect
    values = {**TRUTH, **dict.fromkeys((effect.key(q.symbol) for q in effect.quantities), -0.1)}
    model = Model((effect,))
    estimates = {n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()}
    parameters = Parameters(model=model, estimates=estimates)
    log = campaign(100.0, 4.0)
    with pytest.raises(InputProblem, match=r"expected a column temperature \[degC\]"):
        simulate(parameters, log)
    hot = replace(log, temperature=np.full(len(log), 90.0))
    assert np.isfinite(simulate(parameters, hot)).all()
    (said,) = remarks(parameters, hot)
    assert "the temperature spans 90..90 degC" in said


def test_the_file_of_such_an_effect_has_a_thermometer_in_its_test() -> None:
    size = {LAW.effect.key(q.symbol): -0.1 for q in LAW.effect.quantities}
    shown = motion(LAW.effect, {**TRUTH, **size})
    assert shown.temperature is not None
    assert np.ptp(shown.temperature) == 30.0
