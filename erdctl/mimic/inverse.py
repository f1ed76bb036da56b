"""The duty for a wanted yield force: the paper's static inverse, and one that looks ahead.

The paper inverts the static model (Eqs. 24-35). With multipliers g of the gas, viscous and yield
force (Eqs. 20, 22, 23) all three of its formulas are one:

    v_f = [ ((g_gas - 1) k_nom x + (g_viscous - 1) c_vis xdot) sign(xdot) / sigma
            + g_yield v^beta ]^(1/beta)                                       (27, 31, 35)

(the paper's delta is its sigma). Where the bracket is negative no duty can mimic the fault: the
yield force cannot push, so the duty is zero.

Eq. 12 makes the force follow this v_f late. The compensated sequence looks one update ahead
instead: it asks for the steady yield force u with which F_ER meets its target at the end of the
update, F(t + h) = exp(-h/T_d) F(t) + (1 - exp(-h/T_d)) u, within the limits of the amplifier.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array, Index
from erdctl.core.signals import Signals
from erdctl.mimic.hold import CausalHold
from erdctl.mimic.outcome import Flags
from erdctl.model.composed import Model
from erdctl.model.faults import FaultFactors
from erdctl.model.paper import field_law
from erdctl.model.response import Prepared
from erdctl.model.slots import ControlSlot, FieldSlot

NODES = np.linspace(0.0, 1.0, 1501) ** 6  # of a tabulated law, which is steepest where it sets in
SECANTS = 6  # towards a duty between two that are near each other


@dataclass(frozen=True)
class YieldLaw:
    """Steady yield force of one direction against duty, and its inverse.

    sigma, beta : of the paper's law
    grid, table : (m,) duties and normalised forces where effects change that law, else None
    """

    sigma: float
    beta: float
    grid: Array | None = None
    table: Array | None = None

    @classmethod
    def of(cls, model: Model, values: Mapping[str, float], direction: str) -> YieldLaw:
        """The law of a model in one direction."""
        sigma, beta = values[f"{direction}.sigma"], values[f"{direction}.beta"]
        control, laws = model.of(ControlSlot), model.of(FieldSlot)
        if not control and not laws:
            return cls(sigma, beta)

        def steady(duties: Array) -> Array:
            # Each duty has a record of its own, in which delays and ramps have long been over.
            duty, zero = np.repeat(duties, 2), np.zeros(2 * len(duties))
            step = np.tile([1.0, 0.0], len(duties))
            held = Signals(1.0 - step, zero, zero, duty, step, np.arange(0, len(duty) + 1, 2))
            for effect, slot in control:
                held = held.with_duty(slot(held, effect.local(values)))
            field = field_law(held.duty, beta)
            for effect, law in laws:
                field = law(field, held, effect.local(values), direction)
            return field[::2]

        low, high = 0.0, 1.0  # between them the force sets in
        for _ in range(5):
            grid = np.linspace(low, high, 65)
            some = np.flatnonzero(steady(grid) > 0.0)
            first = int(some[0]) if some.size else 64
            low, high = float(grid[max(first - 1, 0)]), float(grid[first])
        grid = low + (1.0 - low) * NODES
        # A law may level off: the lowest duty that gives a force is the one to use.
        return cls(sigma, beta, grid, np.maximum.accumulate(steady(grid)))

    def duty(self, force: float | Array) -> Array:
        """Duty for a force [N] >= 0, above 1 if no duty gives it; below 0 counts as 0."""
        wanted = np.maximum(force, 0.0) / self.sigma if self.sigma > 0 else np.zeros_like(force)
        if self.table is None or self.grid is None:
            return np.asarray(wanted ** (1.0 / self.beta))
        # Below a threshold all duties give no force, and none is as good as any.
        within = np.where(wanted > 0.0, np.interp(wanted, self.table, self.grid), 0.0)
        return np.where(wanted > self.table[-1], 1.0 + wanted, within)

    def one(self, force: float) -> float:
        """`duty` of a single force, without an array's cost."""
        if self.table is not None or not self.sigma > 0.0:
            return float(self.duty(force))
        return float((force / self.sigma) ** (1.0 / self.beta)) if force > 0.0 else 0.0

    def force(self, duty: float) -> float:
        """Force [N] of a duty."""
        if self.table is None or self.grid is None:
            return self.sigma * float(duty**self.beta)
        return self.sigma * float(np.interp(duty, self.grid, self.table))

    def forces(self, duty: Array) -> Array:
        """Forces [N] of duties (n,)."""
        if self.table is None or self.grid is None:
            return np.asarray(self.sigma * duty**self.beta)
        return np.asarray(self.sigma * np.interp(duty, self.grid, self.table))


Laws = tuple[YieldLaw, YieldLaw]


def laws_of(model: Model, values: Mapping[str, float]) -> Laws:
    """The yield laws of compression and release."""
    return (YieldLaw.of(model, values, DIRECTIONS[0]), YieldLaw.of(model, values, DIRECTIONS[1]))


def static_force(
    healthy: Prepared, parts: Mapping[str, Array], g: FaultFactors, laws: Laws
) -> Array:
    """(n,) steady yield force [N] in the bracket of Eqs. 27, 31 and 35; below zero none does."""
    sigma = np.where(healthy.signals.compressing, laws[0].sigma, laws[1].sigma)
    steady = np.where(healthy.signals.compressing, *healthy.fields) * sigma
    others = (g.gas - 1.0) * parts["gas"] + (g.viscous - 1.0) * parts["viscous"]
    return np.asarray(others * np.sign(healthy.sign) + g.yield_ * steady)


def static_duty(
    healthy: Prepared,
    parts: Mapping[str, Array],
    g: FaultFactors,
    laws: Laws,
) -> Array:
    """(n,) duty by Eqs. 27, 31 and 35, before any limit; zero where the bracket is negative."""
    force = static_force(healthy, parts, g, laws)
    return np.where(healthy.signals.compressing, laws[0].duty(force), laws[1].duty(force))


@dataclass(frozen=True, eq=False)
class _Spans:
    """Stretches over which a duty is held, and F_ER at their ends: a F + before u_1 + after u_2.

    at, ends : (k,) first sample, and the one at which the next stretch begins or the record ends
    begins : (k,) it is the first of its record;  up : (k,) direction in which it begins
    a, before, after : (k,) from Eq. 12, with the yield forces u_1, u_2 [N] of the duty before and
        after the motion turns, if it does (only the first turn counts; two in one are rare)
    """

    at: Index
    ends: Index
    begins: Flags
    up: Flags
    a: Array
    before: Array
    after: Array

    @classmethod
    def of(cls, s: Signals, at: Index, values: Mapping[str, float]) -> _Spans:
        """The stretches that begin at samples (k,), the starts of all records among them."""
        T_c, T_r = (max(values[f"{d}.T_d"], 1e-9) for d in DIRECTIONS)
        record = np.searchsorted(s.starts, at, side="right") - 1
        ends = np.minimum(np.append(at[1:], len(s) - 1), s.starts[record + 1] - 1)
        up, (turns, part) = s.compressing[at], s.turns
        which = np.searchsorted(turns, at)
        turning = np.append(turns, len(s))[which] < ends
        k = which[turning]
        first = s.t[ends] - s.t[at]
        rest = np.zeros(len(at))
        moment = s.t[turns[k]] + part[k] * s.step[turns[k]]
        first[turning], rest[turning] = moment - s.t[at[turning]], s.t[ends[turning]] - moment
        a_1 = np.exp(-first / np.where(up, T_c, T_r))
        a_2 = np.exp(-rest / np.where(up, T_r, T_c))
        begins = np.diff(record, prepend=-1) > 0
        return cls(at, ends, begins, up, a_1 * a_2, (1.0 - a_1) * a_2, 1.0 - a_2)


def _meeting(goal: float, before: float, after: float, law: YieldLaw, turned: YieldLaw) -> float:
    """The duty whose yield forces before and after a turn give before u_1 + after u_2 = goal."""
    if not after:
        return law.one(goal / before)
    mean = goal / (before + after)
    low, high = one, other = law.one(mean), turned.one(mean)
    if low == high:
        return low

    def missing(v: float) -> float:
        return before * law.force(v) + after * turned.force(v) - goal

    # Each law alone is short of the goal at one of these duties and beyond it at the other.
    f_low, f_high = missing(low), missing(high)
    for _ in range(SECANTS):
        if f_low == f_high:
            break
        low, high, f_low = high, high - f_high * (high - low) / (f_high - f_low), f_high
        f_high = missing(max(high, 0.0))
    return min(max(high, min(one, other)), max(one, other))


def compensate(
    target: Array, healthy: Prepared, values: Mapping[str, float], laws: Laws, hold: CausalHold
) -> Array:
    """(n,) duty with which F_ER (n,) meets its target one tick ahead, from tick to tick.

    While no fault acts, the healthy duty, or the way back to it; F_ER follows that too.
    """
    s = healthy.signals
    p = _Spans.of(s, np.flatnonzero(hold.ticks | ~hold.acting), values)
    at, control = p.at, hold.healthy[p.at]
    idle = [np.where(up, laws[0].forces(control), laws[1].forces(control)) for up in (p.up, ~p.up)]
    undisturbed = p.before * idle[0] + p.after * idle[1]
    level, towards, slew = hold.levels.one, hold.levels.towards, hold.slew
    limited = np.isfinite(slew)
    duty = np.empty(len(at))
    state, last, changed = 0.0, 0.0, 0.0
    rows = zip(
        p.begins.tolist(), hold.acting[at].tolist(), hold.ticks[at].tolist(), control.tolist(),
        undisturbed.tolist(), target[at].tolist(), target[p.ends].tolist(), p.up.tolist(),
        p.a.tolist(), p.before.tolist(), p.after.tolist(), hold.reach[at].tolist(),
        s.t[at].tolist(), strict=True,
    )  # fmt: skip
    for k, (begin, acts, tick, v, source, now, goal, up, a, c_1, c_2, reach, t) in enumerate(rows):
        law, turned = laws if up else laws[::-1]
        if begin:
            # A record begins at the steady force of its first duty.
            last = level(law.one(now)) if acts else v
            state, changed, reach = law.force(last), t, np.inf
        wanted = v
        if not acts and wanted == last:
            state = a * state + source
            duty[k] = last
            continue
        if acts and tick:
            ask = goal - a * state
            wanted = level(_meeting(ask, c_1, c_2, law, turned) if a < 1.0 else law.one(goal))
        if tick:
            if limited and not begin:
                wanted = towards(last, wanted, reach, slew * (t - changed))
            if wanted != last:
                last, changed = wanted, t
        state = a * state + c_1 * law.force(last)
        if c_2:
            state += c_2 * turned.force(last)
        duty[k] = last
    return hold.follow(np.repeat(duty, np.diff(np.append(at, len(s)))))
