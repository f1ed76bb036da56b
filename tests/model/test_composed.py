"""Composition: unit columns against the force, and effects in their slots."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rig import TRUTH, campaign

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.effect import Effect, Slot, Stage, Variable


def effect(slot: Slot, apply: Any, name: str = "probe") -> Effect:
    linear = slot is Slot.TERM
    p = Quantity(symbol="p", unit="1", title="p", low=-10, high=10, start=1.0, linear=linear)
    return Effect(
        name=name, stage=Stage.FLUID, slot=slot, title="", equation="", source="", validity="",
        requires=(), shows=Variable.X, quantities=(p,),
        apply=None if linear else apply, columns=apply if linear else None,
    )  # fmt: skip


NOT_LINEAR = (Slot.SERIES, Slot.FEEDBACK, Slot.LAG)  # the force acts on itself
SLOTS: dict[Slot, Any] = {
    Slot.MOTION: lambda s, p: s.with_motion((1 + p["p"]) * s.x, (1 + p["p"]) * s.xdot),
    Slot.CONTROL: lambda s, p: s.duty * (1 + p["p"]),
    Slot.FIELD: lambda field, s, p, way: field * (1 + p["p"]),
    Slot.LAG: lambda s, p: np.full(len(s), 1 + p["p"]),
    Slot.SIGN: lambda s, p: np.sign(s.xdot) * (1 + p["p"]),
    Slot.YIELD: lambda force, s, p: force * (1 + p["p"]),
    Slot.VISCOUS: lambda s, p: s.xdot * (1 + p["p"]),
    Slot.GAS: lambda s, p: s.x * (1 + p["p"]),
    Slot.TERM: lambda s, p: s.x[None],
    Slot.SCALE: lambda s, p: {"yield": np.full(len(s), 1 + p["p"])},
    Slot.FEEDBACK: lambda parts, s, p: {"yield": 1 - p["p"] * np.tanh(parts["yield"] ** 2 / 1e3)},
    Slot.SERIES: lambda p: p["p"] * 1e-4,
    Slot.CHANNEL: lambda column, s, p: column * (1 + p["p"]),
}


@pytest.fixture
def s() -> Signals:
    return Signals.of(campaign())


@pytest.mark.parametrize("slot", list(Slot))
def test_every_slot_is_exact_when_off_and_acts_when_on(slot: Slot, s: Signals) -> None:
    model = Model((effect(slot, SLOTS[slot]),))
    plain = Model().force(s, TRUTH)
    assert np.array_equal(model.force(s, TRUTH | {"probe.p": 0.0}), plain)
    assert not np.allclose(model.force(s, TRUTH | {"probe.p": 0.5}), plain)


@pytest.mark.parametrize("slot", [s for s in Slot if s not in NOT_LINEAR])
def test_columns_times_amplitudes_is_the_force(slot: Slot, s: Signals) -> None:
    model = Model((effect(slot, SLOTS[slot]),))
    values = TRUTH | {"probe.p": 0.7}
    amplitudes = np.array([values[n] for n in model.linear])
    assert amplitudes @ model.columns(s, values) == pytest.approx(model.force(s, values), abs=1e-9)


def test_parts_add_up(s: Signals) -> None:
    parts = Model().parts(s, TRUTH)
    assert set(parts) == {"gas", "viscous", "yield"}
    total: Array = parts["gas"] + parts["viscous"] + parts["yield"]
    assert total == pytest.approx(Model().force(s, TRUTH), abs=1e-12)


def test_two_laws_for_one_place_are_refused(s: Signals) -> None:
    laws = tuple(effect(Slot.SIGN, SLOTS[Slot.SIGN], name) for name in ("a", "b"))
    with pytest.raises(ValueError, match="only one effect"):
        Model(laws).force(s, TRUTH | {"a.p": 0.0, "b.p": 0.0})


@pytest.mark.parametrize("slot", NOT_LINEAR)
def test_feedback_has_no_columns(slot: Slot, s: Signals) -> None:
    with pytest.raises(ValueError, match="not linear"):
        Model((effect(slot, SLOTS[slot]),)).columns(s, TRUTH | {"probe.p": 0.1})


def test_amplitudes_and_columns_go_together() -> None:
    with pytest.raises(ValueError, match="go together"):
        replace(effect(Slot.TERM, SLOTS[Slot.TERM]), columns=None)
