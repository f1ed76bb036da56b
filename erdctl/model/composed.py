"""The paper's model with any list of effects: force, or unit columns for a fit.

    motion -> control -> field -> lag -> sign -> yield -> groups gas + viscous + yield, scaled
    -> terms -> compliance in series -> driven forces -> force channel

Nothing here names an effect; each enters through the slot that it declares. With every effect at
its off value the force equals that of the model without it, bit for bit.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.quantity import Quantity
from erdctl.core.recording import COMPRESSION, DIRECTIONS, RELEASE, Array
from erdctl.core.signals import Signals
from erdctl.model import paper
from erdctl.model.checked import GROUPS
from erdctl.model.effect import Effect, S, in_slot
from erdctl.model.response import Factors, Prepared, multiplied
from erdctl.model.slots import (
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
    Values,
    ViscousSlot,
    number_of,
)

_AMPLITUDE_OF = dict(zip(GROUPS, ("k_nom", "c_vis", "sigma"), strict=True))


@dataclass(frozen=True)
class Model:
    """The paper's model and a list of effects, as a function of named parameter values.

    Values are named `compression.k_nom`, `release.beta`, `coulomb_friction.F_c` and so on.
    """

    effects: tuple[Effect, ...] = ()

    @cached_property
    def quantities(self) -> dict[str, Quantity]:
        """Every parameter by its full name, the paper's first."""
        out = {f"{d}.{s}": q for d in DIRECTIONS for s, q in paper.QUANTITIES.items()}
        for effect in self.effects:
            out.update({effect.key(q.symbol): q for q in effect.quantities})
        return out

    @cached_property
    def linear(self) -> tuple[str, ...]:
        """Names of the amplitudes, in the order of `columns`."""
        groups = [f"{d}.{_AMPLITUDE_OF[g]}" for g in GROUPS for d in DIRECTIONS]
        return (*groups, *(e.key(q.symbol) for e in self.effects for q in e.amplitudes))

    @cached_property
    def shape(self) -> tuple[str, ...]:
        """Names of all other parameters."""
        return tuple(name for name in self.quantities if name not in self.linear)

    @cached_property
    def said_by_effects(self) -> frozenset[str]:
        """Names of the paper's parameters that keep their value, as an effect says them as well."""
        return frozenset(name for e in self.effects for name in e.says_as_well)

    @cached_property
    def separable(self) -> bool:
        """Whether the force is linear in the amplitudes: no effect is made from the force."""
        return not any(
            isinstance(e.slot, SeriesSlot | FeedbackSlot | DrivenSlot | LagSlot)
            for e in self.effects
        )

    def past_alone(self) -> Model:
        """The same model with the past alone known at a sample: `simulate`, exported C."""
        return Model(tuple(effect.past_alone() for effect in self.effects))

    def of(self, kind: type[S]) -> list[tuple[Effect, S]]:
        """The effects of one slot, each with it, in the order in which they act."""
        return in_slot(self.effects, kind)

    def force(self, signals: Signals, values: Values) -> Array:
        """(n,) damper force [N]."""
        return self.prepare(signals, values).force(values)

    def parts(self, signals: Signals, values: Values) -> dict[str, Array]:
        """(n,) force of each group, `gas`, `viscous`, `yield`, and of the terms, `other` [N]."""
        return self.prepare(signals, values).parts(values)

    def columns(self, signals: Signals, values: Values) -> Array:
        """(k, n) force for each amplitude at one and all other amplitudes at zero.

        `values` needs the shape parameters only. Raises ValueError if the model is not separable.
        """
        if not self.separable:
            raise ValueError("the force of this model is not linear in its amplitudes")
        return self.prepare(signals, values).columns()

    def prepare(self, signals: Signals, values: Values) -> Prepared:
        """All that does not depend on the amplitudes, computed once."""
        s, jointed = signals, self._jointed(values)
        for effect, motion in self.of(MotionSlot):
            if not (jointed and motion.free_play is not None):
                s = motion(s, effect.local(values))
        for effect, control in self.of(ControlSlot):
            s = s.with_duty(control(s, effect.local(values)))
        scale, of_speed = product(self.scales(s, values))
        sign, unsteady = self.sign(s, values)
        return Prepared(
            effects=self.effects,
            signals=s,
            gas=self.replaced(GasSlot, s, values, s.x),
            viscous=self.replaced(ViscousSlot, s, values, s.xdot),
            sign=sign,
            unsteady=unsteady,
            fields=self.fields(s, values),
            lags=self._lags(s, values),
            scale=scale,
            of_speed=of_speed,
            gap=self.gap(values),
            values=values,
        )

    def scales(self, s: Signals, values: Values) -> list[tuple[Effect, Factors]]:
        """(n,) factors of groups by each effect that has some, on the piston's signals."""
        return [(e, law(s, e.local(values))) for e, law in self.of(ScaleSlot)]

    def _lags(self, s: Signals, values: Values) -> tuple[Array, Array] | None:
        """(n,) factors of T_d while the yield force rises and while it falls; None if all are 1."""
        rises = falls = np.ones(1)
        for effect, lag in self.of(LagSlot):
            factor = lag(s, effect.local(values))
            falls = falls * factor
            rises = rises * factor if lag.rising else rises
        if (rises == 1.0).all() and (falls == 1.0).all():
            return None  # off takes the same path as absent
        return np.broadcast_to(rises, len(s)).copy(), np.broadcast_to(falls, len(s)).copy()

    def gap(self, values: Values) -> float:
        """Free play [m] in the joint of a compliance in series; 0 where there is none."""
        if not self._jointed(values):
            return 0.0
        plays = [(motion.free_play, e.local(values)) for e, motion in self.of(MotionSlot)]
        return sum((number_of(play, p) for play, p in plays if play is not None), 0.0)

    def _jointed(self, values: Values) -> bool:
        """Whether a compliance in series with the whole damper acts, whose joint may have play."""
        springs = [(e, spring) for e, spring in self.of(SeriesSlot) if spring.carries is None]
        return any(spring(e.local(values)) > 0.0 for e, spring in springs)

    def replaced(
        self,
        kind: type[GasSlot] | type[ViscousSlot] | type[SignSlot],
        s: Signals,
        values: Values,
        plain: Array,
    ) -> Array:
        """(n,) what stands in the place of a signal of the piston: that itself, or an effect's."""
        laws = [(e, e.slot) for e in self.effects if isinstance(e.slot, kind)]
        if len(laws) > 1:
            names = ", ".join(e.name for e, _ in laws)
            what = {GasSlot: "gas", ViscousSlot: "viscous", SignSlot: "sign"}[kind]
            raise IncompatibleEffects(f"only one effect can take the place of {what}: {names}")
        return laws[0][1](s, laws[0][0].local(values)) if laws else plain

    def sign(self, s: Signals, values: Values) -> tuple[Array, Array]:
        """(n,) what stands in the place of sign(xdot), by what follows it over travel, and (r,) how
        far that is from steady as each record begins."""
        sign = law = self.replaced(SignSlot, s, values, s.sign)
        for effect, stretched in self.of(HysteresisSlot):
            sign = stretched(sign, s, effect.local(values))
        return sign, (sign - law)[s.starts[:-1]]

    def fields(self, s: Signals, values: Values) -> tuple[Array, Array]:
        """(n,) normalised steady yield force for either direction, on the piston's signals."""
        laws = self.of(FieldSlot)

        def law(direction: int) -> Array:
            field = paper.field_law(s.duty, values[f"{DIRECTIONS[direction]}.beta"])
            for effect, slot in laws:
                field = slot(field, s, effect.local(values), DIRECTIONS[direction])
            return field

        compression = law(COMPRESSION)
        same = values["compression.beta"] == values["release.beta"] and not laws
        return compression, compression if same else law(RELEASE)


def product(scales: Iterable[tuple[Effect, Factors]]) -> tuple[Factors, Factors]:
    """The factors of all effects together, those of speed alone apart."""
    scale: Factors = {}
    of_speed: Factors = {}
    for effect, factors in scales:
        if effect.of_speed:
            of_speed = multiplied(of_speed, factors)
        else:
            scale = multiplied(scale, factors)
    return scale, of_speed


def off_values(model: Model) -> dict[str, float]:
    """Values at which every effect of a model is exactly absent."""
    return {name: value for effect in model.effects for name, value in effect.off.items()}
