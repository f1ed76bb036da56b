"""A learned law as an effect: a curve in one place of the model, its values the parameters.

    force       F -> F + f(z)
    friction    F -> F + f(z) sign(xdot)
    yield       F_yield -> max(1 + f(z), 0) F_yield, and so of viscous and gas; at least -1 where z
                is what is left of the former direction
    fluid       the same of F_viscous and F_yield together
    lag         T_d -> max(1 + f(z), 0.01) T_d
    duty        v -> max(1 + f(z), 0) v, at most 1
    deflection  x -> x + f(z),  xdot -> xdot + d f(z)/dt

z : the coordinate, or two of them;  f : the curve [N], [m] of a deflection, or [1] of a factor
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Stage, Variable
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law_slot import LEAST_LAG
from erdctl.model.learned.law_slot import LawSlot as LawSlot  # for those who make laws
from erdctl.model.slots import (
    ControlSlot,
    LagSlot,
    MotionSlot,
    ScaleSlot,
    Slot,
    TermSlot,
    Values,
)

EXPONENTS = tuple(f"{d}.beta" for d in DIRECTIONS)


@dataclass(frozen=True)
class Law:
    """A curve in a place."""

    slot: LawSlot
    curve: Curve

    @property
    def unit(self) -> str:
        """Of the curve."""
        return "N" if self.slot.adds else "m" if self.slot is LawSlot.DEFLECTION else "1"

    @property
    def name(self) -> str:
        """Of the effect that it makes."""
        return f"learned_{self.slot}_{self.curve.name}"

    @property
    def equation(self) -> str:
        """What becomes of the force, with z for the coordinate."""
        f = self.curve.equation
        written = {
            LawSlot.FORCE: f"F -> F + {f}",
            LawSlot.FRICTION: f"F -> F + ({f}) sign(xdot)",
            LawSlot.LAG: f"T_d -> max(1 + {f}, {LEAST_LAG:g}) T_d",
            LawSlot.DUTY: f"v -> max(1 + {f}, 0) v, at most 1",
            LawSlot.DEFLECTION: f"x -> x + {f}",
        }
        if self.slot in written:
            return written[self.slot]
        least = self.curve.kind.least
        return ", ".join(f"F_{g} -> max(1 + {f}, {least:g}) F_{g}" for g in self.slot.groups)

    def columns(self, s: Signals, p: Values) -> Array:
        """(k, n) added forces at unit amplitudes [N]."""
        rows = self.curve.rows(s, p)
        return rows * s.sign if self.slot is LawSlot.FRICTION else rows

    def factors(self, s: Signals, p: Values) -> dict[str, Array]:
        """(n,) factors of groups [1]."""
        change = self._change(s, p)
        if change is None:
            return {}
        return dict.fromkeys(self.slot.groups, np.maximum(1.0 + change, self.curve.kind.least))

    def lag(self, s: Signals, p: Values) -> Array:
        """(n,) factor of T_d [1]."""
        change = self._change(s, p)
        return np.ones(len(s)) if change is None else np.maximum(1.0 + change, LEAST_LAG)

    def control(self, s: Signals, p: Values) -> Array:
        """(n,) duty that reaches the electrodes [1]."""
        change = self._change(s, p)
        return s.duty if change is None else np.clip((1.0 + change) * s.duty, 0.0, 1.0)

    def motion(self, s: Signals, p: Values) -> Signals:
        """Motion with what is added to the deflection, and its slope to the velocity."""
        more = self._change(s, p)
        if more is None:
            return s
        slope = np.zeros(len(s))
        for a, b in pairwise(s.starts.tolist()):
            if b - a > 1:
                slope[a:b] = np.gradient(more[a:b], s.t[a:b])
        return s.with_motion(s.x + more, s.xdot + slope, s.engaged)

    def _change(self, s: Signals, p: Values) -> Array | None:
        """(n,) the curve along a motion; None where all its sizes are 0."""
        sizes = np.array([p[q.symbol] for q in self.curve.amplitudes(self.unit)])
        return np.asarray(sizes @ self.curve.rows(s, p)) if sizes.any() else None

    @property
    def place(self) -> Slot:
        """Where it enters a model."""
        if self.slot.adds:
            return TermSlot()
        others: dict[LawSlot, Callable[[], Slot]] = {
            LawSlot.LAG: lambda: LagSlot(self.lag, rising=True),
            LawSlot.DUTY: lambda: ControlSlot(self.control),
            LawSlot.DEFLECTION: lambda: MotionSlot(self.motion),
        }
        return others[self.slot]() if self.slot in others else ScaleSlot(self.factors)

    def in_c(self) -> CLaw:
        """The same in C99."""
        from erdctl.model.learned.c_law import c_law

        return c_law(self)

    @property
    def where(self) -> str:
        """Its coordinates by their letters."""
        return ", ".join(f"{z} {a.kind.words}" for z, a in zip("zy", self.curve.axes, strict=False))

    @property
    def words(self) -> str:
        """What it depends on."""
        return " and ".join(axis.kind.words for axis in self.curve.axes)

    @property
    def effect(self) -> LearnedEffect:
        """The effect, as a model takes it."""
        adds, curve = self.slot.adds, self.curve
        ranges = [(axis.kind, *axis.range) for axis in curve.axes]
        return LearnedEffect(
            name=self.name, stage=Stage.FLUID, slot=self.place,
            title=f"a learned law of {self.words}", equation=self.equation,
            source="learned from data",
            validity=" and ".join(
                f"{z.words} from {low:.4g} to {high:.4g} {z.unit}" for z, low, high in ranges
            ),
            requires=(), shows=Variable.TIME,
            quantities=(*curve.amplitudes(self.unit), *curve.shape()),
            columns=self.columns if adds else None, smooth=curve.form is None, law=self,
            writes_c=self.in_c,
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class LearnedEffect(Effect):
    """An effect that a law makes."""

    law: Law

    @property
    def says_as_well(self) -> tuple[str, ...]:
        """The exponent of the field, of a factor of it over the duty alone.

        Within the log each can be the other; beyond it the factor stays and the exponent goes on.
        """
        field = self.law.slot is LawSlot.DUTY or "yield" in self.law.slot.groups
        over_duty = [axis.coordinate for axis in self.law.curve.axes] == ["duty"]
        return EXPONENTS if field and over_duty else ()
