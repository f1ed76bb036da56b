"""A learned law acts as an effect of the catalogue does, and travels as one."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import to_builtins
from rig import TRUTH, campaign

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.composed import Model
from erdctl.model.learned.coordinates import KINDS, Memory, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import remarks, simulate

LOG = campaign(100.0, 4.0)
LOG = replace(LOG, temperature=20.0 + np.cumsum(LOG.step))


def law(slot: LawSlot, kind: str, form: str | None = None, log: Recording = LOG) -> Law:
    z = along(kind, Signals.of(log), Memory(0.3))
    ends = np.quantile(z[np.isfinite(z)], [0.05, 0.95]).tolist()
    knots = np.linspace(*ends, 5).tolist() if form is None else ends
    curve = Curve(kind, tuple(knots), form, zero_first=form is None and not slot.adds)
    return Law(slot, curve)


def parameters(found: Law, **sizes: float) -> Parameters:
    """Table 2 with a law; sizes not given are a tenth."""
    effect = found.effect
    values = {**TRUTH, **{effect.key(q.symbol): q.start for q in effect.quantities}}
    for q in found.curve.amplitudes(found.unit):
        values[effect.key(q.symbol)] = 0.1
    values |= {effect.key(symbol): v for symbol, v in sizes.items()}
    model = Model((effect,))
    estimates = {n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()}
    return Parameters(model=model, estimates=estimates)


@pytest.mark.untraced
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("slot", LawSlot)
def test_without_size_it_is_absent_bit_for_bit(slot: LawSlot, kind: str) -> None:
    effect = law(slot, kind).effect
    signals = Signals.of(LOG)
    with_law = Model((effect,)).force(signals, {**TRUTH, **effect.off})
    assert np.array_equal(with_law, Model().force(signals, TRUTH))


@pytest.mark.parametrize("kind", KINDS)
def test_no_record_lets_another_one_see_it(kind: str) -> None:
    """Commands compute a long log in runs of records: the same force must come out."""
    found = parameters(law(LawSlot.YIELD, kind))
    whole = simulate(found, LOG)
    apart = [simulate(found, LOG.select([k])) for k in range(len(LOG.names))]
    assert np.allclose(whole, np.concatenate(apart), rtol=1e-12, atol=1e-12)  # sums of a path


@settings(deadline=None)  # a lag of its own has a loop to compile
@given(
    slot=st.sampled_from(list(LawSlot)),
    kind=st.sampled_from(list(KINDS)),
    form=st.sampled_from([None, *FORMS]),
    size=st.floats(-0.9, 0.9),
)
def test_it_travels_and_gives_the_same_force(
    slot: LawSlot, kind: str, form: str | None, size: float
) -> None:
    found = law(slot, kind, form)
    size *= 1e-3 if slot is LawSlot.DEFLECTION else 1.0  # mm: metres would be refused as diverged
    sizes = {q.symbol: size for q in found.curve.amplitudes(found.unit)}
    sent = parameters(found, **sizes)
    text = json.dumps(to_builtins(to_document(sent))).encode()
    arrived = parse_parameters(text, "laws.json")
    log = LOG.select([0, 2])
    assert np.isfinite(simulate(sent, log)).all()
    assert np.array_equal(simulate(arrived, log), simulate(sent, log))


@pytest.mark.parametrize("form", FORMS)
@given(data=st.data())
def test_a_closed_form_is_finite_wherever_its_parameters_may_lie(
    form: str, data: st.DataObject
) -> None:
    low = data.draw(st.floats(-1.0, 1.0))
    curve = Curve("x", (low, low + data.draw(st.floats(1e-6, 10.0))), form)
    values = {q.symbol: data.draw(st.floats(q.low, q.high)) for q in curve.shape()}
    z = np.linspace(low - 1.0, low + 11.0, 50)
    with np.errstate(all="raise", under="ignore"):
        assert np.isfinite(curve.at(z, values)).all()


@given(st.floats(1.0, 100.0))
def test_beyond_what_was_seen_it_stays_at_its_end_value(times: float) -> None:
    found = law(LawSlot.FORCE, "x")
    low, high = found.curve.range
    values = {q.symbol: 0.3 * k for k, q in enumerate(found.curve.amplitudes("N"), 1)}
    ends = found.curve.at(np.array([low, high]), values)
    out = found.curve.at(np.array([low - times * abs(low), high + times * abs(high)]), values)
    assert np.array_equal(ends, out)


@pytest.mark.parametrize("form", FORMS)
@given(low=st.floats(-3.0, 3.0), span=st.floats(0.01, 5.0), part=st.floats(0.0, 1.0))
def test_a_closed_form_goes_on_but_not_without_end(
    form: str, low: float, span: float, part: float
) -> None:
    curve = Curve("since_duty_step", (low, low + span), form)
    inside = np.linspace(*curve.range, 50)
    values = {q.symbol: q.low + part * (q.high - q.low) for q in curve.shape()}
    far = np.array([1.0, 1.5, 2.0, 2.1, 1e3]) * span
    ((*above,), (*below,)) = (curve.at(z, values)[0] for z in (inside[-1] + far, low - far))
    for side in (above, below):
        assert side[3] == side[4]  # no farther than two times the range
        most = 3.0 * np.abs(curve.at(inside[[0, -1]], values)).max()
        assert max(map(abs, side)) <= (most if FORMS[form].grows else 1.0) * (1.0 + 1e-12)
    if form == "line":
        scale = max(abs(low), abs(low + span))
        assert above[0] == pytest.approx((inside[-1] + span) / scale, rel=1e-9, abs=1e-9)
    end = curve.at(inside[[-1]], values)
    assert np.array_equal(curve.at(np.array([np.inf]), values), end)  # no step has been yet


def test_simulate_says_that_a_closed_form_goes_on() -> None:
    line = Law(LawSlot.FRICTION, Curve("abs_x", (0.0, float(np.abs(LOG.x).max())), "line"))
    (said,) = [r for r in remarks(parameters(line), replace(LOG, x=2.0 * LOG.x)) if "law" in r]
    assert "it goes on by its form as far as 2 times that range, tested by no data" in said


def test_simulate_says_where_a_law_is_asked_for_more() -> None:
    found = parameters(law(LawSlot.YIELD, "abs_x"))
    beyond, within = (replace(LOG, x=times * LOG.x) for times in (2.0, 0.9))
    (said,) = [r for r in remarks(found, beyond) if "stays at its end value" in r]
    assert "the size of the deflection spans" in said
    assert not [r for r in remarks(found, within) if "stays at its end value" in r]


def changed(**law_fields: Any) -> bytes:
    document = to_builtins(to_document(parameters(law(LawSlot.YIELD, "x"))))
    document["effects"][0]["law"] |= law_fields
    return json.dumps(document).encode()


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"slot": "spring"}, "unknown slot 'spring'; known are force, friction"),
        ({"coordinates": [{"name": "moon"}]}, "unknown coordinate 'moon'"),
        ({"coordinates": []}, "expected one coordinate or two, found 0"),
        ({"form": "wish"}, "unknown form 'wish'"),
        ({"knots": [0.0, 1.0]}, "expected three rising numbers or more"),
        ({"knots": [0.0, 1.0, 1.0, 2.0, 3.0]}, "expected three rising numbers or more"),
        ({"form": "tanh"}, "expected two rising numbers"),
        ({"knots": [0.0, 0.5, 1.0]}, "expected the parameters"),
    ],
)
def test_a_law_that_is_none_is_refused_with_its_place(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(InputProblem, match=r"effects\[0\]") as problem:
        parse_parameters(changed(**fields), "laws.json")
    assert said in str(problem.value)


def test_only_a_learned_effect_has_a_law() -> None:
    document = to_builtins(to_document(parameters(law(LawSlot.YIELD, "x"))))
    document["effects"][0]["effect"] = "coulomb_friction"
    with pytest.raises(InputProblem, match="'learned', and it alone, has a law"):
        parse_parameters(json.dumps(document).encode(), "laws.json")
