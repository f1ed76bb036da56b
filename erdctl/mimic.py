"""Fault emulation, Sec. 6: the PWM sequence with which a healthy damper acts as a faulty one.

The paper inverts the static model (Eqs. 24-35). With multipliers g of the gas, viscous and yield
force (Eqs. 20, 22, 23) all three of its formulas are one:

    v_f = [ ((g_gas - 1) k_nom x + (g_viscous - 1) c_vis xdot) sign(xdot) / sigma
            + g_yield v^beta ]^(1/beta)                                       (27, 31, 35)

(the paper's delta is its sigma). Where the bracket is negative no duty can mimic the fault: the
yield force cannot push, so the duty is zero and the rest is reported as out of reach.

Eq. 12 makes the force follow this v_f late. The compensated sequence looks one update ahead
instead: it asks for the steady yield force u with which F_ER meets its target at the end of the
update, F(t + h) = exp(-h/T_d) F(t) + (1 - exp(-h/T_d)) u, within the limits of the amplifier.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.amplifier import Amplifier
from erdctl.effect import Slot
from erdctl.faults import Fault, FaultFactors, effectiveness, factors
from erdctl.model import Model
from erdctl.paper import field_law
from erdctl.parameters import Parameters
from erdctl.recording import DIRECTIONS, Array, Recording
from erdctl.response import Prepared
from erdctl.score import nrmse
from erdctl.signals import Signals

SMOOTH_SIGN = 0.05  # below this |sign law| a yield force cannot be told from none
GRID = np.linspace(0.0, 1.0, 4001)


@dataclass(frozen=True)
class Reach:
    """How well one fault can be mimicked while it is active.

    compensated, paper : NRMSE of the expected force to the ideal faulty force, over its range
    out_of_reach : part of the time in which no duty gives the ideal force
    missing_rms, missing_max : force that is missing then [N]
    """

    fault: Fault
    samples: int
    compensated: float
    paper: float
    out_of_reach: float
    missing_rms: float
    missing_max: float


@dataclass(frozen=True, eq=False)
class Plan:
    """A PWM sequence for one damper.

    duty, duty_paper : (n,) compensated sequence, and the paper's static inverse
    ideal, expected, expected_paper : (n,) ideal faulty force and what the sequences will give [N]
    out_of_reach : (n,) no duty gives the ideal force
    limited : part of the time in which the amplifier's limits, not the physics, hold the duty
    """

    duty: Array
    duty_paper: Array
    ideal: Array
    expected: Array
    expected_paper: Array
    out_of_reach: npt.NDArray[np.bool_]
    limited: float
    reaches: tuple[Reach, ...]


def mimic(
    parameters: Parameters, recording: Recording, faults: Sequence[Fault], amplifier: Amplifier
) -> Plan:
    """Plan the duty sequence with which the damper mimics `faults` over a recording's motion.

    The recording's duty is the healthy control.
    """
    model, values = parameters.model, parameters.values
    signals = Signals.of(recording)
    healthy = model.prepare(signals, values)
    g = factors(faults, signals.t, signals.xdot, signals.starts)
    groups = {"gas": g.gas, "viscous": g.viscous, "yield": g.yield_}
    parts = healthy.parts(values)
    ideal = healthy.force(values, groups)
    rest = sum((f for name, f in parts.items() if name != "yield"), start=np.zeros(len(signals)))
    active = np.abs(healthy.sign) > SMOOTH_SIGN
    sign = np.where(active, healthy.sign, 1.0)
    target = np.where(active, (ideal - rest) / sign, 0.0)
    laws = (YieldLaw.of(model, values, DIRECTIONS[0]), YieldLaw.of(model, values, DIRECTIONS[1]))
    wanted = static_duty(healthy, parts, g, laws)
    duty_paper = follow(wanted, signals, amplifier)
    duty = _compensate(target, healthy, values, laws, amplifier)

    def expected(v: Array) -> Array:
        return model.force(signals.with_duty(v), values)

    force, force_paper = expected(duty), expected(duty_paper)
    out = active & (target < 0.0)
    reaches = []
    for fault in faults:
        on = effectiveness(fault, signals.t, signals.xdot, signals.starts) < 1.0
        if not on.any():
            continue
        gap = np.where(out, np.abs(ideal - rest), 0.0)[on]
        reaches.append(
            Reach(
                fault=fault,
                samples=int(on.sum()),
                compensated=nrmse(ideal[on], force[on]).nrmse,
                paper=nrmse(ideal[on], force_paper[on]).nrmse,
                out_of_reach=float(out[on].mean()),
                missing_rms=float(np.sqrt(np.mean(gap**2))),
                missing_max=float(gap.max()),
            )
        )
    return Plan(
        duty=duty,
        duty_paper=duty_paper,
        ideal=ideal,
        expected=force,
        expected_paper=force_paper,
        out_of_reach=out,
        limited=float(np.mean(wanted > amplifier.duty_max)),
        reaches=tuple(reaches),
    )


@dataclass(frozen=True)
class YieldLaw:
    """Steady yield force of one direction against duty, and its inverse.

    sigma, beta : of the paper's law;  table : (len(GRID),) normalised force on GRID where effects
    change that law, else None
    """

    sigma: float
    beta: float
    table: Array | None

    @classmethod
    def of(cls, model: Model, values: Mapping[str, float], direction: str) -> YieldLaw:
        """The law of a model in one direction."""
        sigma, beta = values[f"{direction}.sigma"], values[f"{direction}.beta"]
        effects = model.of(Slot.FIELD)
        if not effects:
            return cls(sigma, beta, None)
        zero = np.zeros_like(GRID)
        grid = Signals(GRID, zero, zero, GRID, zero, np.array([0, len(GRID)]))
        field = field_law(GRID, beta)
        for effect in effects:
            field = effect.act(field, grid, effect.local(values))
        # A law may level off: the lowest duty that gives a force is the one to use.
        return cls(sigma, beta, np.maximum.accumulate(field))

    def duty(self, force: float | Array) -> Array:
        """Duty for a force [N] >= 0, above 1 if no duty gives it; below 0 counts as 0."""
        wanted = np.maximum(force, 0.0) / self.sigma if self.sigma > 0 else np.zeros_like(force)
        if self.table is None:
            return np.asarray(wanted ** (1.0 / self.beta))
        within = np.interp(wanted, self.table, GRID)
        return np.where(wanted > self.table[-1], 1.0 + wanted, within)

    def force(self, duty: float) -> float:
        """Force [N] of a duty."""
        if self.table is None:
            return self.sigma * float(duty**self.beta)
        return self.sigma * float(np.interp(duty, GRID, self.table))


Laws = tuple[YieldLaw, YieldLaw]


def static_duty(
    healthy: Prepared,
    parts: Mapping[str, Array],
    g: FaultFactors,
    laws: Laws,
) -> Array:
    """(n,) duty by Eqs. 27, 31 and 35, before any limit; zero where the bracket is negative."""
    up = healthy.signals.compressing
    sigma = np.where(up, laws[0].sigma, laws[1].sigma)
    steady = np.where(up, *healthy.fields) * sigma
    others = (g.gas - 1.0) * parts["gas"] + (g.viscous - 1.0) * parts["viscous"]
    force = others * np.sign(healthy.sign) + g.yield_ * steady
    return np.where(up, laws[0].duty(force), laws[1].duty(force))


def _updates(signals: Signals, amplifier: Amplifier) -> npt.NDArray[np.bool_]:
    """(n,) samples at which the duty may change."""
    out = np.ones(len(signals), dtype=bool)
    if amplifier.update_rate is not None:
        for a, b in zip(signals.starts[:-1], signals.starts[1:], strict=True):
            tick = np.floor((signals.t[a:b] - signals.t[a]) * amplifier.update_rate + 1e-9)
            out[a + 1 : b] = tick[1:] != tick[:-1]  # the first sample of a record is always one
    return out


def follow(wanted: Array, signals: Signals, amplifier: Amplifier) -> Array:
    """The sequence (n,) nearest to a wanted duty (n,) that the amplifier can carry out."""
    update = _updates(signals, amplifier)
    if amplifier.slew == np.inf and not amplifier.resolution:
        chosen = np.minimum(wanted, amplifier.duty_max)
        return np.asarray(
            chosen[np.maximum.accumulate(np.where(update, np.arange(len(chosen)), 0))]
        )
    out = np.empty_like(wanted)
    last, since = 0.0, np.inf
    rows = zip(wanted.tolist(), update.tolist(), signals.step.tolist(), strict=True)
    for i, (w, new, dt) in enumerate(rows):
        if new:
            last, since = amplifier.limit(w, last, since), 0.0
        # The step is 0 at the end of a record: nothing limits the first duty of the next.
        since = since + dt if dt else np.inf
        out[i] = last
    return out


def _compensate(
    target: Array, healthy: Prepared, values: Mapping[str, float], laws: Laws, amplifier: Amplifier
) -> Array:
    """The duty with which F_ER (n,) meets its target one update ahead, update by update."""
    s = healthy.signals
    T = [max(values[f"{d}.T_d"], 1e-9) for d in DIRECTIONS]
    at = np.flatnonzero(_updates(s, amplifier))
    record = np.searchsorted(s.starts, at, side="right") - 1
    ends = np.minimum(np.append(at[1:], len(s) - 1), s.starts[record + 1] - 1)
    span = s.t[ends] - s.t[at]
    up = s.compressing[at]
    decay = np.exp(-span / np.where(up, T[0], T[1]))
    duty = np.empty(len(at))
    state, last = 0.0, 0.0
    rows = zip(
        np.diff(record, prepend=-1).tolist(), target[at].tolist(), target[ends].tolist(),
        up.tolist(), decay.tolist(), span.tolist(), strict=True,
    )  # fmt: skip
    for k, (begins, now, goal, up_k, a, dt) in enumerate(rows):
        law = laws[0 if up_k else 1]
        if begins:
            # A record begins at the steady force of its first duty.
            last = min(float(law.duty(now)), amplifier.duty_max)
            state = law.force(last)
        ask = (goal - a * state) / (1.0 - a) if a < 1.0 else goal
        last = amplifier.limit(float(law.duty(ask)), last, np.inf if begins else dt)
        state = a * state + (1.0 - a) * law.force(last)
        duty[k] = last
    return np.repeat(duty, np.diff(np.append(at, len(s))))
