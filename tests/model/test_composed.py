"""Composition: unit columns against the force, and effects in their slots."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from rig import TRUTH, campaign

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.effect import Effect, Stage, Variable
from erdctl.model.slots import (
    ChannelSlot,
    ControlSlot,
    DrivenSlot,
    FeedbackSlot,
    FieldSlot,
    GasSlot,
    HysteresisSlot,
    LagSlot,
    MotionSlot,
    ScaleSlot,
    SeriesSlot,
    SignSlot,
    Slot,
    TermSlot,
    ViscousSlot,
    YieldSlot,
)


def effect(slot: Slot, name: str = "probe") -> Effect:
    linear = isinstance(slot, TermSlot)
    p = Quantity(symbol="p", unit="1", title="p", low=-10, high=10, start=1.0, linear=linear)
    return Effect(
        name=name, stage=Stage.FLUID, slot=slot, title="", equation="", source="", validity="",
        requires=(), shows=Variable.X, quantities=(p,),
        columns=(lambda s, p: s.x[None]) if linear else None,
    )  # fmt: skip


NOT_LINEAR: tuple[Slot, ...] = (  # the force is made from itself
    LagSlot(lambda s, p: np.full(len(s), 1 + p["p"])),
    FeedbackSlot(lambda parts, s, p: {"yield": 1 - p["p"] * np.tanh(parts["yield"] ** 2 / 1e3)}),
    DrivenSlot(lambda parts, s, p: p["p"] * np.abs(parts["viscous"])),
    SeriesSlot(lambda p: p["p"] * 1e-4),
)
LINEAR: tuple[Slot, ...] = (
    MotionSlot(lambda s, p: s.with_motion((1 + p["p"]) * s.x, (1 + p["p"]) * s.xdot)),
    ControlSlot(lambda s, p: s.duty * (1 + p["p"])),
    FieldSlot(lambda field, s, p, way: field * (1 + p["p"])),
    SignSlot(lambda s, p: np.sign(s.xdot) * (1 + p["p"])),
    HysteresisSlot(lambda part, s, p: part * (1 + p["p"]), travel="p"),
    YieldSlot(lambda force, s, p: force * (1 + p["p"])),
    ViscousSlot(lambda s, p: s.xdot * (1 + p["p"])),
    GasSlot(lambda s, p: s.x * (1 + p["p"])),
    TermSlot(),
    ScaleSlot(lambda s, p: {"yield": np.full(len(s), 1 + p["p"])}),
    ChannelSlot(lambda column, s, p: column * (1 + p["p"])),
)


def of_slot(slot: Slot) -> str:
    return type(slot).__name__


def test_every_slot_is_here() -> None:
    assert {type(s) for s in (*LINEAR, *NOT_LINEAR)} == set(get_args(Slot))


@pytest.fixture
def s() -> Signals:
    return Signals.of(campaign())


@pytest.mark.parametrize("slot", [*LINEAR, *NOT_LINEAR], ids=of_slot)
def test_every_slot_is_exact_when_off_and_acts_when_on(slot: Slot, s: Signals) -> None:
    model = Model((effect(slot),))
    plain = Model().force(s, TRUTH)
    assert np.array_equal(model.force(s, TRUTH | {"probe.p": 0.0}), plain)
    assert not np.allclose(model.force(s, TRUTH | {"probe.p": 0.5}), plain)


@pytest.mark.parametrize("slot", LINEAR, ids=of_slot)
def test_columns_times_amplitudes_is_the_force(slot: Slot, s: Signals) -> None:
    model = Model((effect(slot),))
    values = TRUTH | {"probe.p": 0.7}
    amplitudes = np.array([values[n] for n in model.linear])
    assert amplitudes @ model.columns(s, values) == pytest.approx(model.force(s, values), abs=1e-9)


def test_parts_add_up(s: Signals) -> None:
    parts = Model().parts(s, TRUTH)
    assert set(parts) == {"gas", "viscous", "yield"}
    total: Array = parts["gas"] + parts["viscous"] + parts["yield"]
    assert total == pytest.approx(Model().force(s, TRUTH), abs=1e-12)


def test_two_laws_for_one_place_are_refused(s: Signals) -> None:
    law = SignSlot(lambda s, p: np.sign(s.xdot))
    laws = tuple(effect(law, name) for name in ("a", "b"))
    with pytest.raises(IncompatibleEffects, match="only one effect"):
        Model(laws).force(s, TRUTH | {"a.p": 0.0, "b.p": 0.0})


@pytest.mark.parametrize("slot", NOT_LINEAR, ids=of_slot)
def test_feedback_has_no_columns(slot: Slot, s: Signals) -> None:
    with pytest.raises(ValueError, match="not linear"):
        Model((effect(slot),)).columns(s, TRUTH | {"probe.p": 0.1})


def test_amplitudes_and_columns_go_together() -> None:
    with pytest.raises(ValueError, match="go together"):
        replace(effect(TermSlot()), columns=None)
