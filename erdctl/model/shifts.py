"""Forces of a model near a point: one parameter moved at a time, at the cost of what it reaches.

A derivative by differences asks for one force for each parameter. Most of them reach one group of
the force alone (T_d the yield force, a friction's slip its own term), so the others are kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.composed import Model, product
from erdctl.model.effect import Effect, in_slot
from erdctl.model.response import Factors, Prepared
from erdctl.model.slots import (
    ChannelSlot,
    FeedbackSlot,
    FieldSlot,
    GasSlot,
    HysteresisSlot,
    MotionSlot,
    ScaleSlot,
    SeriesSlot,
    SignSlot,
    TermSlot,
    Values,
    ViscousSlot,
    YieldSlot,
)

# The group that each of the paper's parameters reaches, and that of each slot; what acts on the
# sum of all groups reaches none.
_OF_PAPER = {"k_nom": "gas", "c_vis": "viscous", "T_d": "yield", "sigma": "yield", "beta": "yield"}
_OF_SLOT: Mapping[type, tuple[str, ...]] = {
    GasSlot: ("gas",),
    ViscousSlot: ("viscous",),
    SignSlot: ("yield",),
    FieldSlot: ("yield",),
    HysteresisSlot: ("yield",),
    YieldSlot: ("yield",),
    TermSlot: (),
    ChannelSlot: (),
    FeedbackSlot: (),
}


class Shifts:
    """Forces next to given values of all parameters.

    prepared : the model at these values, if it is there
    """

    def __init__(
        self, model: Model, signals: Signals, values: Values, prepared: Prepared | None = None
    ) -> None:
        self.model, self.signals, self.values = model, signals, dict(values)
        self.prepared = model.prepare(signals, values) if prepared is None else prepared
        self.bare = self.prepared.bare(values)
        self.force = self.prepared.total(self.bare, values)
        self._owner = {e.key(q.symbol): e for e in model.effects for q in e.quantities}

    def at(self, name: str, value: float) -> Array:
        """(n,) force with one parameter at another value."""
        values = {**self.values, name: value}
        owner = self._owner.get(name)
        if owner is not None and isinstance(owner.slot, ScaleSlot) and not owner.amplitudes:
            return self._scaled(owner, values)
        if owner is not None and self._joint_alone(owner, values):
            return replace(self._at(values, owner), gap=self.model.gap(values)).force(values)
        reached = self._reached(name, owner)
        if reached is None:
            return self.model.force(self.signals, values)
        prepared = self._moved(values, name, owner)
        if "spring" in self.bare and self._behind_spring(reached, owner):
            return prepared.force(values)
        bare = {**self.bare, **{group: prepared.group(group, values) for group in reached}}
        return prepared.total(bare, values)

    def _at(self, values: Values, owner: Effect | None) -> Prepared:
        """The model at other values of one effect or of the paper's model, with what is known."""
        moved = replace(self.prepared, values=values)
        if owner is None or not owner.amplitudes:
            moved.__dict__["terms"] = self.prepared.terms
        return moved

    def _scaled(self, owner: Effect, values: Values) -> Array:
        """(n,) force with the factors of one effect at other values."""
        assert isinstance(owner.slot, ScaleSlot)
        moved = owner.slot(self.prepared.signals, owner.local(values))
        scale, of_speed = product((e, moved if e is owner else f) for e, f in self._scales)
        prepared = replace(self._at(values, owner), scale=scale, of_speed=of_speed)
        if "spring" in self.bare:
            return prepared.force(values)
        return prepared.total(self.bare, values)

    def _joint_alone(self, owner: Effect, values: Values) -> bool:
        """Whether an effect is a spring, or play in its joint, of which there is one all along."""
        if "spring" not in self.bare or owner.amplitudes:
            return False
        if isinstance(owner.slot, MotionSlot):
            return owner.slot.free_play is not None and "gas" not in self.bare
        return isinstance(owner.slot, SeriesSlot) and self.prepared.has_spring(values)

    @cached_property
    def _scales(self) -> list[tuple[Effect, Factors]]:
        """(n,) factors of each effect at the values themselves."""
        return self.model.scales(self.prepared.signals, self.values)

    def _reached(self, name: str, owner: Effect | None) -> set[str] | None:
        """The groups of bare forces that a parameter changes; None where it may change all."""
        if owner is None:
            return {_OF_PAPER[name.partition(".")[2]]}
        if any(owner.key(q.symbol) == name for q in owner.amplitudes):
            return {"other"}
        groups = _OF_SLOT.get(type(owner.slot))
        if groups is None:
            return None
        return {*groups, "other"} if owner.amplitudes else set(groups)

    def _behind_spring(self, reached: set[str], owner: Effect | None) -> bool:
        """Whether what a parameter changes moves with the spring, or is scaled as it does."""
        whole = "gas" not in self.bare  # the spring carries the damper, not its fluid alone
        carried = whole and owner is not None and owner.carried
        inside = carried or not reached <= self.bare.keys()
        scaled = bool(self.prepared.scale or in_slot(self.model.effects, FeedbackSlot))
        return inside or (scaled and reached != {"other"})

    def _moved(self, values: Values, name: str, owner: Effect | None) -> Prepared:
        """The model at the new values, with what they change of what is there."""
        p, s = self._at(values, owner), self.prepared.signals
        slot = None if owner is None else owner.slot
        if isinstance(slot, FieldSlot) or (owner is None and name.endswith(".beta")):
            return replace(p, fields=self.model.fields(s, values))
        if isinstance(slot, GasSlot):
            return replace(p, gas=self.model.replaced(GasSlot, s, values, s.x))
        if isinstance(slot, ViscousSlot):
            return replace(p, viscous=self.model.replaced(ViscousSlot, s, values, s.xdot))
        if isinstance(slot, SignSlot | HysteresisSlot):
            sign, unsteady = self.model.sign(s, values)
            return replace(p, sign=sign, unsteady=unsteady)
        return p
