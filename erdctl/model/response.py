"""The response of a composed model on given signals: forces by group, or unit columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.recording import COMPRESSION, RELEASE, Array
from erdctl.core.signals import Signals
from erdctl.model import paper
from erdctl.model.checked import GROUPS
from erdctl.model.effect import Effect, in_slot
from erdctl.model.paper import pair
from erdctl.model.slots import (
    ChannelSlot,
    DrivenSlot,
    FeedbackSlot,
    SeriesSlot,
    Values,
    YieldSlot,
    number_of,
)

Factors = Mapping[str, Array]


class _Spring(NamedTuple):
    """What is in series: whether with the whole damper, [m/N], damping [N s/m], own play [m]."""

    whole: bool
    compliance: float
    damping: float
    play: float


class _Behind(NamedTuple):
    """What marches behind a spring: (n,) force, stretch and speed, forces that are no laws of it,
    laws on a grid, (n,) factors."""

    force: Array
    stretch: Array
    speed: Array
    beside: Array
    grid: Array
    viscous: Array
    friction: Array
    gain: Factors


@dataclass(frozen=True, eq=False)
class Prepared:
    """A model on given signals and shape parameters; only the amplitudes are open.

    gas, viscous, sign : (n,) shapes in place of x, xdot and sign(xdot)
    unsteady : (r,) how far `sign` is from its law as each record begins
    fields : (n,) normalised steady yield force for either direction
    lags : (n,) factors of T_d while the yield force rises and while it falls, or None
    scale, of_speed : (n,) factors of groups; behind a spring, those of speed follow the piston's
    gap : free play [m] in the joint of a compliance in series
    """

    effects: tuple[Effect, ...]
    signals: Signals
    gas: Array
    viscous: Array
    sign: Array
    unsteady: Array
    fields: tuple[Array, Array]
    lags: tuple[Array, Array] | None
    scale: Factors
    of_speed: Factors
    gap: float
    values: Values

    def force(self, values: Values, factors: Factors | None = None) -> Array:
        """(n,) force; `factors` multiply groups sample by sample (faults, Eqs. 20-23)."""
        return self.total(self.bare(values, factors), values, factors)

    def parts(self, values: Values, factors: Factors | None = None) -> dict[str, Array]:
        """(n,) force of each group and, if there are any terms, of all `other` forces."""
        springs = self._springs(values)
        if springs:
            out = self._behind_spring(values, self._fed_back(values, factors), springs[0])
        else:
            out = self._scaled(self.bare(values), values, factors)
        for row in self._driven(out, values):
            out["other"] = out["other"] + row if "other" in out else row
        return {name: self._recorded(part) for name, part in out.items()}

    def bare(self, values: Values, factors: Factors | None = None) -> dict[str, Array]:
        """(n,) force of each group and of the terms before any factor; see `total`.

        Behind a spring its force in place of what it carries, and that with all factors.
        """
        springs = self._springs(values)
        if springs:
            factors = self._fed_back(values, factors)
            out = {"spring": self._march(values, factors, springs[0]).force}
            if not springs[0].whole:
                gas = self.group("gas", values)
                out["gas"] = gas * factors["gas"] if "gas" in factors else gas
        else:
            out = {group: self.group(group, values) for group in GROUPS}
        if any(e.amplitudes for e in self.effects):
            out["other"] = self.group("other", values)
        return out

    def group(self, group: str, values: Values) -> Array:
        """(n,) force of a group, or of the terms outside a spring, before any factor."""
        if group == "other":
            springs = self._springs(values)
            inner = bool(springs) and springs[0].whole
            rows = self._outside(inner=inner)
            return sum((values[name] * row for name, row in rows), np.zeros(len(self.signals)))
        per = self.signals.per_direction
        if group == "gas":
            return np.asarray(self.gas * per(*pair(values, "k_nom")))
        if group == "viscous":
            return np.asarray(self.viscous * per(*pair(values, "c_vis")))
        sigma = pair(values, "sigma")
        u_c = self.fields[COMPRESSION] * sigma[COMPRESSION]
        shared = sigma[0] == sigma[1] and self.fields[0] is self.fields[1]
        return self._signed_yield(u_c, u_c if shared else self.fields[RELEASE] * sigma[RELEASE])

    def total(self, bare: Factors, values: Values, factors: Factors | None = None) -> Array:
        """(n,) recorded force that bare ones add up to."""
        if "spring" not in bare:
            bare = parts = self._scaled(bare, values, factors)
        elif in_slot(self.effects, DrivenSlot):
            fed = self._fed_back(values, factors)
            parts = self._behind_spring(values, fed, self._springs(values)[0])
        else:
            parts = {}
        out = None
        for name in ("spring", *GROUPS, "other"):
            if name in bare:
                out = bare[name] if out is None else out + bare[name]
        assert out is not None
        for row in self._driven(parts, values):
            out = out + row
        return self._recorded(out)

    def _driven(self, parts: Factors, values: Values) -> list[Array]:
        """(n,) forces that those of the groups bring about [N]."""
        return [
            law({g: parts[g] for g in GROUPS}, self.signals, e.local(values))
            for e, law in in_slot(self.effects, DrivenSlot)
        ]

    def _scaled(
        self, bare: Factors, values: Values, factors: Factors | None = None
    ) -> dict[str, Array]:
        """(n,) forces with the factors of their groups, also those that depend on the forces."""
        scale = multiplied(multiplied(self.scale, factors or {}), self.of_speed)
        out = multiplied(bare, scale)
        for effect, feedback in in_slot(self.effects, FeedbackSlot):
            out = multiplied(out, feedback(out, self.signals, effect.local(values)))
        return out

    def _fed_back(self, values: Values, factors: Factors | None) -> Factors:
        """(n,) factors of groups behind a spring, with those that depend on the forces."""
        factors = multiplied(self.scale, factors or {})
        for effect, feedback in in_slot(self.effects, FeedbackSlot):
            out = self._behind_spring(values, factors, self._springs(values)[0])
            back = feedback(out, self.signals, effect.local(values))
            factors = multiplied(factors, back)
        return factors

    def columns(self) -> Array:
        """(k, n) unit responses in the order of `Model.linear`."""
        zero = np.zeros(len(self.signals))
        rows: list[Array] = []
        scale = multiplied(self.scale, self.of_speed)
        for group, shape in (("gas", self.gas), ("viscous", self.viscous)):
            factor = scale.get(group)
            shape = shape if factor is None else shape * factor
            rows += self.signals.split(shape)
        factor = scale.get("yield")
        for fields in ((self.fields[COMPRESSION], zero), (zero, self.fields[RELEASE])):
            response = self._signed_yield(*fields)
            rows.append(response if factor is None else response * factor)
        rows += [row for _, row in self.terms]
        return np.array([self._recorded(row) for row in rows])

    def yield_state(self, compression: Array, release: Array) -> Array:
        """(n,) F_ER of Eq. 12 for given steady values in either direction."""
        T_c, T_r = pair(self.values, "T_d")
        return paper.yield_force(self.signals, compression, release, T_c, T_r, lags=self.lags)

    @cached_property
    def terms(self) -> Sequence[tuple[str, Array]]:
        """Name and (n,) unit response of every amplitude that an effect adds."""
        return [
            (e.key(q.symbol), row)
            for e in self.effects
            for q, row in zip(
                e.amplitudes, e.added(self.signals, e.local(self.values)), strict=True
            )
        ]

    def _signed_yield(self, compression: Array, release: Array) -> Array:
        force = self.yield_state(compression, release) * self.sign
        for effect, law in in_slot(self.effects, YieldSlot):
            force = law(force, self.signals, effect.local(self.values))
        return force

    def _recorded(self, column: Array) -> Array:
        for effect, channel in in_slot(self.effects, ChannelSlot):
            column = channel(column, self.signals, effect.local(self.values))
        return column

    def has_spring(self, values: Values) -> bool:
        """Whether a compliance in series acts; raises IncompatibleEffects if several do."""
        return bool(self._springs(values))

    def _springs(self, values: Values) -> list[_Spring]:
        """The compliance in series, if there is one."""
        all_ = [(slot, e.local(values)) for e, slot in in_slot(self.effects, SeriesSlot)]
        springs = [
            _Spring(
                slot.carries is None,
                slot(p),
                number_of(slot.damping, p),
                number_of(slot.free_play, p),
            )
            for slot, p in all_
        ]
        springs = [spring for spring in springs if spring.compliance > 0.0]
        if len(springs) > 1:
            raise IncompatibleEffects("only one compliance can be in series")
        return springs

    def _outside(self, *, inner: bool) -> Sequence[tuple[str, Array]]:
        """Terms in parallel with the spring; one of all forces carries those of the damper."""
        inside = {e.key(q.symbol) for e in self.effects if e.carried for q in e.amplitudes}
        return [(name, row) for name, row in self.terms if not (inner and name in inside)]

    def _march(self, values: Values, factors: Factors, spring: _Spring) -> _Behind:
        """The spring and what moves behind it.

        Forces of the damper that do not depend on speed alone are those of the recorded motion. A
        gas law in place of x is moved by the spring as x is: their slopes differ by little there.
        """
        from erdctl.model.at_speed import SpeedLaws
        from erdctl.model.behind_spring import (
            beside,
            laws,
            masses,
            other,
            refuse,
            sliding,
            speed_grid,
        )
        from erdctl.model.series_compliance import march

        refuse(self.effects)
        s, inner = self.signals, spring.whole
        grid = speed_grid(float(np.abs(s.xdot).max()))
        by, memory = other(self.effects, values, s, inner=inner)
        apart = memory is not None and memory.yields
        viscous, sign, friction, factor = laws(self.effects, values, grid, apart=apart)
        held = beside(self.effects, self.terms, values, len(s))
        if not inner:
            friction, held = np.zeros_like(friction), np.zeros_like(held)
        ones = np.ones(len(s))
        gain = {g: factors.get(g, ones) for g in GROUPS}
        u_c, u_r = (f * s_ for f, s_ in zip(self.fields, pair(values, "sigma"), strict=True))
        k = pair(values, "k_nom") if inner else (0.0, 0.0)
        T = [max(T_d, 1e-9) for T_d in pair(values, "T_d")]
        rises, falls = (ones, ones) if self.lags is None else self.lags
        viscous = np.array(pair(values, "c_vis"))[:, None] * viscous
        slides = sliding(self.effects)
        slide = dict(self.terms)[slides[0].key(slides[1])] if slides else ones
        force, stretch, v, own = march(
            self.gas, s.x, s.xdot, s.step, rises, falls, s.starts, s.compressing, s.rests,
            held, slide, self.unsteady, u_c, u_r, by, gain["gas"], gain["viscous"], gain["yield"],
            SpeedLaws(grid, viscous, sign, friction, factor), memory,
            k[0], k[1], T[0], T[1], spring.compliance,
            self.gap + spring.play,
            float(sum(values[e.key(m)] for e, m in masses(self.effects) if inner)),
            spring.damping,
        )  # fmt: skip
        return _Behind(force, stretch, v, held + own, grid, viscous, friction, gain)

    def _behind_spring(self, values: Values, factors: Factors, spring: _Spring) -> dict[str, Array]:
        """Forces by group with a compliance in series with the groups that it carries."""
        from erdctl.model.at_speed import along

        s, inner, b = self.signals, spring.whole, self._march(values, factors, spring)
        out = {
            "viscous": along(b.speed, b.grid, b.viscous) * b.gain["viscous"],
            "other": along(b.speed, b.grid, b.friction),
        }
        if inner:
            gas = (self.gas - b.stretch) * s.with_motion(s.x, b.speed).per_direction(
                *pair(values, "k_nom")
            )
            out["gas"] = gas * b.gain["gas"]
            # The yield force is what the rest leaves: at rest, whatever holds the piston.
            out["other"] = out["other"] + b.beside
            out["yield"] = b.force - out["gas"] - out["viscous"] - out["other"]
        else:
            out["gas"] = self.gas * s.per_direction(*pair(values, "k_nom")) * b.gain["gas"]
            out["yield"] = b.force - out["viscous"]
        for name, row in self._outside(inner=inner):
            out["other"] = out["other"] + values[name] * row
        return out


def multiplied(a: Factors, b: Factors) -> dict[str, Array]:
    """Two sets of group factors as one."""
    out = dict(a)
    for group, factor in b.items():
        out[group] = out[group] * factor if group in out else factor
    return out
