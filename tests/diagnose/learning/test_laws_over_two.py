"""Laws over two coordinates, of the duty and of the lag: screened, learned, and told by a part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.learning.law_screen import LawScreen
from erdctl.diagnose.learning.laws import laws, spread, surfaces
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.screening import Screen
from erdctl.diagnose.told import as_told
from erdctl.effects import get
from erdctl.model.composed import Model
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.learned.surface import Surface

PULL = 0.5


def pulled() -> tuple[Law, dict[str, float]]:
    """A yield force times 1 + PULL x/X u/U."""
    log = campaign(100.0, 8.0)
    stroke = float(np.abs(log.x).max())
    top = float(log.duty.max())
    ends, duties = (-stroke, 0.0, stroke), (0.0, 0.5 * top, top)
    law = Law(LawSlot.YIELD, Surface("x", ends, across=Curve("duty", duties)))
    values = [PULL * x / stroke * u / top for x in ends for u in duties]
    symbols = [q.symbol for q in law.curve.amplitudes("1")]
    return law, dict(zip(symbols, values, strict=True))


@pytest.mark.long
def test_a_law_over_two_coordinates_is_learned_and_right_where_it_was_not_fitted() -> None:
    law, own = pulled()
    values = {**TRUTH, **{law.effect.key(k): v for k, v in own.items()}}
    true = Model((law.effect,))
    log, fresh = campaign(100.0, 8.0), campaign(100.0, 5.0)
    r = noisy(replace(log, force=true.force(Signals.of(log), values)), seed=41)
    found = diagnose(r, [get("coulomb_friction"), get("gas_preload")], limits=False)
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.learned is not None
    said = found.learned.laws[0].law
    assert said.slot in (LawSlot.YIELD, LawSlot.DUTY, LawSlot.FLUID)
    assert {axis.coordinate for axis in said.curve.axes} == {"x", "duty"}
    end = found.learned.selection.best
    signals = Signals.of(fresh)
    target = true.force(signals, values)
    base = found.selection.base
    errors = [float(np.std(target - h.model.force(signals, h.values))) for h in (base, end)]
    assert errors[1] < 0.25 * errors[0]


@pytest.mark.parametrize("slot", list(LawSlot))
def test_the_cheap_slopes_are_those_of_the_force(slot: LawSlot) -> None:
    """A deflection is looked at as any effect is."""
    problem = prepare(noisy(campaign(100.0, 4.0), seed=5))
    fitted = fit_hypothesis(problem, (), [TRUTH], 20)
    law = Law(slot, Curve("x", (-0.01, 0.0, 0.01), zero_first=not slot.adds))
    start = {q.symbol: q.start for q in law.effect.quantities}
    cheap = LawScreen(problem, fitted)._slopes(law.effect, start)
    exact = Screen(problem, fitted)._slopes(law.effect, start)
    assert len(cheap) == len(exact) == (0 if slot.adds else 2)
    for one, other in zip(cheap, exact, strict=True):
        # A lag of three steps goes on as it was within each.
        assert np.linalg.norm(one - other) < 0.15 * np.linalg.norm(other)


def test_a_lag_that_nothing_tells_has_no_law() -> None:
    r = campaign(100.0, 4.0)
    steady = replace(r, duty=np.full_like(r.duty, 0.4))
    slots = {law.slot for law in laws(prepare(noisy(steady, seed=2)))}
    assert LawSlot.LAG not in slots
    assert slots >= {LawSlot.FORCE, LawSlot.YIELD, LawSlot.DEFLECTION}


def test_a_second_coordinate_is_another_one() -> None:
    problem = prepare(noisy(campaign(100.0, 4.0), seed=2))
    knots = spread(problem, "abs_x", 6, None)
    assert knots is not None
    over = [
        law.curve.axes[1].coordinate
        for law in surfaces(problem, Law(LawSlot.GAS, Curve("abs_x", knots)), None)
    ]
    assert "duty" in over
    assert "direction" in over
    assert not {"x", "abs_x", "late_duty"} & set(over)


def test_where_a_part_tells_nothing_a_surface_has_the_value_of_what_it_tells() -> None:
    law, own = pulled()
    effect = law.effect
    s = Signals.of(campaign(100.0, 8.0))
    values = {**TRUTH, **{effect.key(k): v for k, v in own.items()}}
    whole = np.ones(len(s))
    rest = np.where(s.duty > 0.7 * s.duty.max(), 0.0, whole)  # the highest duties are left out
    told, part = as_told(Model((effect,)), values, s, rest, whole)
    (found,) = (e for e in told.effects if isinstance(e, LearnedEffect))
    assert part[found.key("f_3_3")] == part[found.key("f_3_2")] == own["f_3_2"]
    same, _ = as_told(Model((effect,)), values, s, whole, whole)
    assert same.effects == (effect,)
