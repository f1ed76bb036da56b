"""A law over two coordinates, and the slots that are neither a force nor a factor of one."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from msgspec import to_builtins
from rig import TRUTH, campaign

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import Memory, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.learned.surface import Surface
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import remarks, simulate

LOG = campaign(100.0, 4.0)
S = Signals.of(LOG)
STROKE = float(np.abs(LOG.x).max())
KNOTS = (-STROKE, 0.0, STROKE)


def surface(slot: LawSlot) -> Law:
    across = Curve("duty", (0.0, 0.5, 1.0))
    return Law(slot, Surface("x", KNOTS, zero_first=not slot.adds, across=across))


def sized(law: Law, of: Any) -> dict[str, float]:
    """Sizes of a function of both coordinates, at the knots; less that at the first of both."""
    curve = law.curve
    assert isinstance(curve, Surface)
    least = of(curve.knots[0], curve.across.knots[0]) if curve.zero_first else 0.0
    values = [of(z, y) - least for z in curve.knots for y in curve.across.knots]
    symbols = [q.symbol for q in curve.amplitudes(law.unit)]
    return dict(zip(symbols, values[len(values) - len(symbols) :], strict=True))


def force(law: Law, own: dict[str, float]) -> Array:
    effect = law.effect
    return Model((effect,)).force(S, {**TRUTH, **{effect.key(k): v for k, v in own.items()}})


def test_a_plane_is_a_plane() -> None:
    law = surface(LawSlot.FORCE)
    added = force(law, sized(law, lambda z, y: 2.0 * z / STROKE + 3.0 * z / STROKE * y))
    expected = (2.0 + 3.0 * LOG.duty) * LOG.x / STROKE
    np.testing.assert_allclose(added - Model().force(S, TRUTH), expected, atol=1e-9)


def test_a_factor_over_two_coordinates_multiplies_its_group() -> None:
    law = surface(LawSlot.YIELD)
    parts = Model().parts(S, TRUTH)
    scaled = force(law, sized(law, lambda z, y: 0.3 * z / STROKE * y))
    expected = (
        parts["gas"] + parts["viscous"] + parts["yield"] * (1 + 0.3 * LOG.x / STROKE * LOG.duty)
    )
    np.testing.assert_allclose(scaled, expected, atol=1e-9)


def sent_of(effects: tuple[Effect, ...], own: dict[str, float]) -> Parameters:
    model = Model(effects)
    estimates = {
        n: Estimate(value=v, unit=model.quantities[n].unit) for n, v in {**TRUTH, **own}.items()
    }
    return Parameters(model=model, estimates=estimates)


@pytest.mark.parametrize("slot", list(LawSlot))
def test_it_travels_and_off_is_exactly_absent(slot: LawSlot) -> None:
    law = surface(slot)
    assert np.array_equal(force(law, dict.fromkeys(sized(law, lambda z, y: 0.0), 0.0)),
                          Model().force(S, TRUTH))  # fmt: skip
    effect = law.effect
    small = 1e-4 if slot is LawSlot.DEFLECTION else 0.2
    own = {effect.key(k): v for k, v in sized(law, lambda z, y: small * z / STROKE * y).items()}
    sent = sent_of((effect,), own)
    arrived = parse_parameters(json.dumps(to_builtins(to_document(sent))).encode(), "laws.json")
    assert np.array_equal(simulate(arrived, LOG), simulate(sent, LOG))
    assert not np.array_equal(simulate(sent, LOG), simulate(sent_of((), {}), LOG))


def test_simulate_says_which_of_both_is_asked_for_more() -> None:
    law = Law(LawSlot.FORCE, Surface("x", KNOTS, across=Curve("duty", (0.0, 0.01))))
    own = {law.effect.key(q.symbol): 1.0 for q in law.curve.amplitudes("N")}
    found = sent_of((law.effect,), own)
    (said,) = [r for r in remarks(found, LOG) if "stays at its end value" in r]
    assert said.startswith("the duty cycle spans")


@pytest.mark.parametrize(
    ("coordinates", "said"),
    [
        ([{"name": "x"}, {"name": "duty", "knots": [0.0]}], "coordinates.2.knots: expected two"),
        ([{"name": "x"}, {"name": "late_duty", "knots": [0.0, 1.0]}], "the second has no memory"),
        ([{"name": "x"}, {"name": "duty"}, {"name": "t"}], "one coordinate or two, found 3"),
    ],
)
def test_a_surface_that_is_none_is_refused(coordinates: list[Any], said: str) -> None:
    law = surface(LawSlot.YIELD)
    own = {law.effect.key(k): v for k, v in sized(law, lambda z, y: 0.1).items()}
    document = to_builtins(to_document(sent_of((law.effect,), own)))
    document["effects"][0]["law"]["coordinates"] = coordinates
    with pytest.raises(InputProblem, match=said):
        parse_parameters(json.dumps(document).encode(), "laws.json")


def line(slot: LawSlot, coordinate: str, ends: tuple[float, float], size: float) -> Array:
    law = Law(slot, Curve(coordinate, ends, "line"))
    return force(law, {"a": size})


def test_a_duty_law_changes_what_acts() -> None:
    half = line(LawSlot.DUTY, "duty", (0.0, 1.0), 0.0)
    assert np.array_equal(half, Model().force(S, TRUTH))
    law = Law(LawSlot.DUTY, Curve("t", (0.0, 1.0)))
    less = force(law, {"f_1": -0.25, "f_2": -0.25})
    expected = Model().force(S.with_duty(0.75 * S.duty), TRUTH)
    np.testing.assert_allclose(less, expected, rtol=1e-12)


def test_a_lag_law_that_is_the_same_throughout_is_another_time_constant() -> None:
    law = Law(LawSlot.LAG, Curve("t", (0.0, 1.0)))
    slower = force(law, {"f_1": 1.0, "f_2": 1.0})
    twice = {n: 2.0 * v if n.endswith(".T_d") else v for n, v in TRUTH.items()}
    np.testing.assert_allclose(slower, Model().force(S, twice), rtol=1e-9, atol=1e-9)


def test_a_deflection_law_moves_the_piston_and_its_velocity() -> None:
    more = line(LawSlot.DEFLECTION, "x", (-STROKE, STROKE), 0.1 * STROKE)
    slope = np.concatenate([np.gradient(LOG.x[r], LOG.t[r]) for r in LOG.slices])
    expected = Model().force(S.with_motion(1.1 * S.x, S.xdot + 0.1 * slope), TRUTH)
    np.testing.assert_allclose(more, expected, atol=1e-9)


def test_what_rings_does_so_at_its_own_frequency() -> None:
    """After a jump the cosine's ringing is -1 and swings through 0 every half period."""
    t = np.arange(0.0, 1.0, 1e-3)
    duty = np.where(t < 0.1, 0.0, 1.0)
    one = np.ones(len(t))
    s = Signals(t, one, one, duty, np.append(np.diff(t), 0.0), np.array([0, len(t)]))
    y = along("ringing_field", s, Memory(0.02, 0.05))
    assert y[:100] == pytest.approx(0.0)
    assert y[100] == pytest.approx(-1.0, abs=0.05)
    assert y.max() == pytest.approx(np.exp(-0.05 * np.pi), rel=0.03)
    crossings = np.diff(t[1:][(y[1:] > 0) != (y[:-1] > 0)])[1:]
    assert np.median(crossings) == pytest.approx(np.pi * 0.02, rel=0.02)
