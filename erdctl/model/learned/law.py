"""A learned law as an effect: a curve in one place of the model, its values the parameters.

    force      F -> F + f(z)
    friction   F -> F + f(z) sign(xdot)
    yield      F_yield -> max(1 + f(z), 0) F_yield, and so of viscous and gas
    fluid      the same of F_viscous and F_yield together

z : the coordinate;  f : the curve [N], or [1] of a factor
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Stage, Variable
from erdctl.model.learned.curve import Curve
from erdctl.model.slots import ScaleSlot, TermSlot, Values


class LawSlot(StrEnum):
    """Where in the model a learned law acts."""

    FORCE = "force"
    FRICTION = "friction"
    YIELD = "yield"
    VISCOUS = "viscous"
    GAS = "gas"
    FLUID = "fluid"

    @property
    def adds(self) -> bool:
        """Whether it adds a force, in place of a factor on one."""
        return self in (LawSlot.FORCE, LawSlot.FRICTION)

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups of forces that it scales."""
        return () if self.adds else ("viscous", "yield") if self is LawSlot.FLUID else (self.value,)


@dataclass(frozen=True)
class Law:
    """A curve in a place."""

    slot: LawSlot
    curve: Curve

    @property
    def unit(self) -> str:
        """Of the curve."""
        return "N" if self.slot.adds else "1"

    @property
    def name(self) -> str:
        """Of the effect that it makes."""
        return f"learned_{self.slot}_{self.curve.name}"

    @property
    def equation(self) -> str:
        """What becomes of the force, with z for the coordinate."""
        f = self.curve.equation
        if self.slot.adds:
            return (
                f"F -> F + ({f}) sign(xdot)" if self.slot is LawSlot.FRICTION else f"F -> F + {f}"
            )
        return ", ".join(f"F_{g} -> max(1 + {f}, 0) F_{g}" for g in self.slot.groups)

    def columns(self, s: Signals, p: Values) -> Array:
        """(k, n) added forces at unit amplitudes [N]."""
        rows = self.curve.rows(s, p)
        return rows * s.sign if self.slot is LawSlot.FRICTION else rows

    def factors(self, s: Signals, p: Values) -> dict[str, Array]:
        """(n,) factors of groups [1]."""
        sizes = np.array([p[q.symbol] for q in self.curve.amplitudes("1")])
        if not sizes.any():
            return {}
        factor = np.maximum(1.0 + sizes @ self.curve.rows(s, p), 0.0)
        return dict.fromkeys(self.slot.groups, factor)

    @property
    def effect(self) -> LearnedEffect:
        """The effect, as a model takes it."""
        adds, curve = self.slot.adds, self.curve
        low, high = curve.range
        z = curve.kind
        return LearnedEffect(
            name=self.name, stage=Stage.FLUID, slot=TermSlot() if adds else ScaleSlot(self.factors),
            title=f"a learned law of {z.words}", equation=self.equation,
            source="learned from data",
            validity=f"{z.words} from {low:.4g} to {high:.4g} {z.unit}",
            requires=(), shows=Variable.TIME,
            quantities=(*curve.amplitudes(self.unit), *curve.shape()),
            columns=self.columns if adds else None, smooth=curve.form is None, law=self,
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class LearnedEffect(Effect):
    """An effect that a law makes."""

    law: Law
