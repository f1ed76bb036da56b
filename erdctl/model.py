"""The paper's model with any list of effects: force, or unit columns for a fit.

    motion -> control -> field -> lag -> sign -> groups gas + viscous + yield (scaled) + terms
    -> force channel

Nothing here names an effect; each enters through the slot that it declares. With every effect at
its off value the force equals that of the model without it, bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from erdctl import paper
from erdctl.effect import Effect, Slot, Values
from erdctl.quantity import Quantity
from erdctl.recording import COMPRESSION, DIRECTIONS, RELEASE, Array
from erdctl.signals import Signals

GROUPS = ("gas", "viscous", "yield")
_AMPLITUDE_OF = dict(zip(GROUPS, ("k_nom", "c_vis", "sigma"), strict=True))

Lag = Callable[[Array, Array], Array]


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
        """Names of the parameters in which the force is linear, in the order of `columns`."""
        groups = [f"{d}.{_AMPLITUDE_OF[g]}" for g in GROUPS for d in DIRECTIONS]
        terms = [e.key(q.symbol) for e in self._in(Slot.TERM) for q in e.amplitudes]
        return (*groups, *terms)

    @cached_property
    def shape(self) -> tuple[str, ...]:
        """Names of all other parameters."""
        return tuple(name for name in self.quantities if name not in self.linear)

    def _in(self, slot: Slot) -> list[Effect]:
        return sorted((e for e in self.effects if e.slot is slot), key=lambda e: e.order)

    def force(self, signals: Signals, values: Values) -> Array:
        """(n,) damper force [N]."""
        return self.prepare(signals, values).force(values)

    def parts(self, signals: Signals, values: Values) -> dict[str, Array]:
        """(n,) force of each group, `gas`, `viscous`, `yield`, and of the terms, `other` [N]."""
        return self.prepare(signals, values).parts(values)

    def columns(self, signals: Signals, values: Values) -> Array:
        """(k, n) force for each linear parameter at one and all other linear ones at zero.

        `values` needs the shape parameters only.
        """
        return self.prepare(signals, values).columns()

    def prepare(self, signals: Signals, values: Values) -> Prepared:
        """All that does not depend on the linear parameters, computed once."""
        s = signals
        for effect in self._in(Slot.MOTION):
            s = effect.apply(s, effect.local(values))  # type: ignore[assignment]
        for effect in self._in(Slot.CONTROL):
            s = s.with_duty(_array(effect.apply(s, effect.local(values))))
        sign = self._replace(Slot.SIGN, s, values, np.sign(s.xdot))
        return Prepared(
            signals=s,
            sign=sign,
            gas=self._replace(Slot.GAS, s, values, s.x),
            viscous=self._replace(Slot.VISCOUS, s, values, s.xdot),
            fields=self._fields(s, values),
            lag=self._lag(s, sign, values),
            scale=self._scale(s, values),
            terms=[
                (e.key(q.symbol), row)
                for e in self._in(Slot.TERM)
                for q, row in zip(e.amplitudes, _array(e.apply(s, e.local(values))), strict=True)
            ],
            channel=[(e, e.local(values)) for e in self._in(Slot.CHANNEL)],
        )

    def _replace(self, slot: Slot, s: Signals, values: Values, plain: Array) -> Array:
        effects = self._in(slot)
        if len(effects) > 1:
            names = ", ".join(e.name for e in effects)
            raise ValueError(f"only one effect can take the place of {slot.value}: {names}")
        return _array(effects[0].apply(s, effects[0].local(values))) if effects else plain

    def _fields(self, s: Signals, values: Values) -> tuple[Array, Array]:
        laws = self._in(Slot.FIELD)

        def law(direction: int) -> Array:
            field = paper.field_law(s.duty, values[f"{DIRECTIONS[direction]}.beta"])
            for effect in laws:
                field = _array(effect.apply(field, s, effect.local(values)))
            return field

        compression = law(COMPRESSION)
        same = values["compression.beta"] == values["release.beta"]
        return compression, compression if same else law(RELEASE)

    def _lag(self, s: Signals, sign: Array, values: Values) -> Lag:
        T = [values[f"{d}.T_d"] for d in DIRECTIONS]

        def lag(compression: Array, release: Array) -> Array:
            return paper.yield_force(s, compression, release, T[COMPRESSION], T[RELEASE])

        replaced: Lag | None = None
        for effect in self._in(Slot.LAG):
            replaced = effect.apply(lag, s, sign, effect.local(values))  # type: ignore[assignment]
        return replaced or (lambda compression, release: lag(compression, release) * sign)

    def _scale(self, s: Signals, values: Values) -> dict[str, Array]:
        out: dict[str, Array] = {}
        for effect in self._in(Slot.SCALE):
            factors: Mapping[str, Array] = effect.apply(s, effect.local(values))  # type: ignore[assignment]
            for group, factor in factors.items():
                out[group] = out[group] * factor if group in out else factor
        return out


@dataclass(frozen=True, eq=False)
class Prepared:
    """A model on given signals and shape parameters; only the linear parameters are open."""

    signals: Signals
    gas: Array
    viscous: Array
    sign: Array
    fields: tuple[Array, Array]
    lag: Lag
    scale: Mapping[str, Array]
    terms: Sequence[tuple[str, Array]]
    channel: Sequence[tuple[Effect, Values]]

    def force(self, values: Values, factors: Mapping[str, Array] | None = None) -> Array:
        """(n,) force; `factors` multiply groups sample by sample (faults, Eqs. 20-23)."""
        parts = self.parts(values, factors)
        total = parts["gas"]
        for name in (*GROUPS[1:], "other"):
            if name in parts:
                total = total + parts[name]
        return total

    def parts(self, values: Values, factors: Mapping[str, Array] | None = None) -> dict[str, Array]:
        """(n,) force of each group and, if there are any terms, of all `other` forces."""

        def pair(symbol: str) -> tuple[float, float]:
            return values[f"compression.{symbol}"], values[f"release.{symbol}"]

        sigma = pair("sigma")
        u_c = self.fields[COMPRESSION] * sigma[COMPRESSION]
        shared = sigma[0] == sigma[1] and self.fields[0] is self.fields[1]
        u_r = u_c if shared else self.fields[RELEASE] * sigma[RELEASE]
        out = {
            "gas": self.gas * self.signals.per_direction(*pair("k_nom")),
            "viscous": self.viscous * self.signals.per_direction(*pair("c_vis")),
            "yield": self.lag(u_c, u_r),
        }
        for group in GROUPS:
            for source in (self.scale, factors or {}):
                if group in source:
                    out[group] = out[group] * source[group]
        if self.terms:
            out["other"] = sum((values[n] * row for n, row in self.terms[1:]),
                               start=values[self.terms[0][0]] * self.terms[0][1])  # fmt: skip
        return {name: self._through_channel(part) for name, part in out.items()}

    def columns(self) -> Array:
        """(k, n) unit responses in the order of `Model.linear`."""
        up = self.signals.compressing
        zero = np.zeros(len(self.signals))
        rows = []
        for group, shape in (("gas", self.gas), ("viscous", self.viscous)):
            factor = self.scale.get(group)
            shape = shape if factor is None else shape * factor
            rows += [np.where(up, shape, 0.0), np.where(up, 0.0, shape)]
        factor = self.scale.get("yield")
        for fields in ((self.fields[COMPRESSION], zero), (zero, self.fields[RELEASE])):
            response = self.lag(*fields)
            rows.append(response if factor is None else response * factor)
        rows += [row for _, row in self.terms]
        return np.array([self._through_channel(row) for row in rows])

    def _through_channel(self, column: Array) -> Array:
        for effect, p in self.channel:
            column = _array(effect.apply(column, self.signals, p))
        return column


def _array(result: Any) -> Array:
    return np.asarray(result, dtype=np.float64)


def off_values(model: Model) -> dict[str, float]:
    """Values at which every effect of a model is exactly absent."""
    return {name: value for effect in model.effects for name, value in effect.off.items()}
