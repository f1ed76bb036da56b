"""The PWM sequence with which a healthy damper acts as a faulty one, Sec. 6, and what it reaches.

The paper's model is inverted by formula (`erdctl.mimic.inverse`), a model with effects by iteration
(`erdctl.mimic.iterate`). What comes out is replayed through the corrected model, and so is the
sequence of the paper's parameters alone. Where that does better for one of the faults, it takes
over while that fault acts; where it is better as a whole, it is the plan, and the plan says so. The
paper's parameters get the same iteration, on their own model: the difference is what the physics is
worth, not the method.

The fault is mimicked in the damper, not in the recording. What the force channel makes of a force
(skew, drift) reaches neither a vehicle nor a rig: a sequence that made up for it would put the
channel's error, turned round, into the damper. So effects of the channel take no part in the
sequence and its figures; `ideal` and `expected` carry them, as the log of the run will.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.mimic.hold import CausalHold
from erdctl.mimic.inverse import Laws, compensate, laws_of, static_duty, static_force
from erdctl.mimic.outcome import Correction, Flags, Plan, Reach
from erdctl.model.amplifier import Amplifier
from erdctl.model.composed import Model
from erdctl.model.effect import Stage
from erdctl.model.faults import Fault, FaultFactors, effectiveness, factors
from erdctl.model.parameters import Parameters
from erdctl.model.response import Prepared
from erdctl.model.slots import ChannelSlot, Values
from erdctl.score.nrmse import nrmse

if TYPE_CHECKING:
    from erdctl.mimic.iterate import Target

SMOOTH_SIGN = 0.05  # below this |sign law| a yield force counts as none
UNSEEN = 2e-3  # of the range of the force: less is a matter of which fault's onset comes first
MISSED = 0.005  # of the range of the force: an error of the best sequence that a user would see


@dataclass(frozen=True, eq=False)
class Inversion:
    """The inversion of one model by formula.

    rest : (n,) ideal force less all but the yield force [N]
    way : (n,) direction in which a yield force pushes, 0 where it counts as none
    target : (n,) yield force that gives the ideal one [N], below 0 where none does
    wanted : (n,) duty of the static inverse;  compensated : (n,) of the lag compensated one
    """

    ideal: Array
    rest: Array
    way: Array
    target: Array
    laws: Laws
    wanted: Array
    compensated: Array


def mimic(
    parameters: Parameters, recording: Recording, faults: Sequence[Fault], amplifier: Amplifier
) -> Plan:
    """Plan the duty sequence with which the damper mimics `faults` over a recording's motion.

    The recording's duty is the healthy control.
    """
    whole, values = parameters.model.past_alone(), parameters.values
    model, left_out = _damper(whole)
    signals = Signals.of(recording)
    g = factors(faults, signals.t, signals.xdot, signals.starts)
    hold = CausalHold.of(signals, amplifier, (g.gas < 1.0) | (g.viscous < 1.0) | (g.yield_ < 1.0))
    found = _invert(model, values, signals, g, hold)
    duty_paper = hold.follow(found.wanted)
    on = [effectiveness(f, signals.t, signals.xdot, signals.starts) < 1.0 for f in faults]
    acting = [(fault, at) for fault, at in zip(faults, on, strict=True) if at.any()]

    def force(v: Array) -> Array:
        return model.force(signals.with_duty(v), values)

    def errors(made: Array) -> list[float]:
        return [nrmse(found.ideal[at], made[at]).nrmse for _, at in acting]

    out = (found.target < 0.0) & hold.acting
    missing = np.where(out, np.abs(found.rest), 0.0)
    duty, plain, correction = found.compensated, None, None
    if whole.effects:
        by_paper = _plain(model, values, signals, found.ideal, g, hold)
        duty, steps = by_paper, 0
        if model.effects:
            task = _task(model, values, signals, found, hold)
            duty, steps = task.improved(min(by_paper, found.compensated, key=task.miss))
        plain = errors(force(by_paper))
        duty = _no_worse(duty, by_paper, found.ideal, [at for _, at in acting], hold.follow, force)
        made, made_plain = force(duty), force(by_paper)
        if acting:
            some = np.logical_or.reduce([at for _, at in acting])
            correction = Correction(
                effects=tuple(e.name for e in model.effects),
                left_out=left_out,
                nrmse=nrmse(found.ideal[some], made[some]).nrmse,
                plain=nrmse(found.ideal[some], made_plain[some]).nrmse,
                steps=steps,
                fell_back=bool(model.effects) and duty is by_paper,
            )
        if model.effects:
            out, missing = _unreached(found, made, force(np.zeros(len(signals))), hold.acting)
    made, made_paper = force(duty), force(duty_paper)
    figures = zip(acting, errors(made), errors(made_paper), strict=True)
    reaches = tuple(
        Reach(
            fault=fault,
            samples=int(at.sum()),
            compensated=compensated,
            paper=paper,
            out_of_reach=float(out[at].mean()),
            missing_rms=float(np.sqrt(np.mean(missing[at] ** 2))),
            missing_max=float(missing[at].max()),
            plain=None if plain is None else plain[i],
        )
        for i, ((fault, at), compensated, paper) in enumerate(figures)
    )
    ideal, of_damper = found.ideal, (made, made_paper)
    if left_out:
        ideal = whole.prepare(signals, values).force(values, _groups(g))
        made, made_paper = (whole.force(signals.with_duty(v), values) for v in (duty, duty_paper))
    return Plan(
        duty=duty,
        duty_paper=duty_paper,
        ideal=ideal,
        expected=made,
        expected_paper=made_paper,
        out_of_reach=out,
        limited=_held_back(found, duty, of_damper[0], hold, amplifier),
        limited_paper=_held_back(found, duty_paper, of_damper[1], hold, amplifier),
        idle=tuple(
            fault
            for fault, at in zip(faults, on, strict=True)
            if not at.any() or (fault.of_field and not signals.duty.any())
        ),
        acting=hold.acting,
        reaches=reaches,
        correction=correction,
    )


def _held_back(
    found: Inversion, duty: Array, made: Array, hold: CausalHold, amplifier: Amplifier
) -> float:
    """Part of the samples at which a sequence is at the highest duty and the force is too small.

    duty, made : (n,) the sequence, and the force that the damper makes of it [N]
    """
    highest = duty > amplifier.duty_max - max(amplifier.resolution, 1e-9)
    short = (found.ideal - made) * found.way > MISSED * np.ptp(found.ideal)
    return float(np.mean(hold.acting & highest & short))


def _damper(whole: Model) -> tuple[Model, tuple[str, ...]]:
    """The model without the effects of the force channel, and their names."""
    channel = [
        e for e in whole.effects if isinstance(e.slot, ChannelSlot) or e.stage is Stage.SENSOR
    ]
    if not channel:
        return whole, ()
    return Model(tuple(e for e in whole.effects if e not in channel)), tuple(
        e.name for e in channel
    )


def _groups(g: FaultFactors) -> dict[str, Array]:
    return {"gas": g.gas, "viscous": g.viscous, "yield": g.yield_}


def _invert(
    model: Model, values: Values, signals: Signals, g: FaultFactors, hold: CausalHold
) -> Inversion:
    healthy: Prepared = model.prepare(signals, values)
    parts = healthy.parts(values)
    ideal = healthy.force(values, _groups(g))
    rest = sum((f for name, f in parts.items() if name != "yield"), start=np.zeros(len(signals)))
    active = np.abs(healthy.sign) > SMOOTH_SIGN
    sign = np.where(active, healthy.sign, 1.0)
    laws = laws_of(model, values)
    # Where the piston stands no yield force shows, but the next stroke begins with it.
    still = np.maximum(static_force(healthy, parts, g, laws), 0.0)
    target = np.where(active, (ideal - rest) / sign, still)
    return Inversion(
        ideal=ideal,
        rest=ideal - rest,
        way=np.where(active, np.sign(sign), 0.0),
        target=target,
        laws=laws,
        wanted=static_duty(healthy, parts, g, laws),
        compensated=compensate(target, healthy, values, laws, hold),
    )


def _no_worse(
    duty: Array,
    plain: Array,
    ideal: Array,
    acting: Sequence[Flags],
    carried_out: Callable[[Array], Array],
    force: Callable[[Array], Array],
) -> Array:
    """The duty (n,), with the plain one where that does better for a fault, or the plain one.

    ideal : (n,) force [N];  acting : (n,) for each fault
    carried_out : what the amplifier makes of a duty;  force : what the damper makes of it
    """
    if not acting:
        return duty
    some = np.logical_or.reduce(acting)

    def errors(v: Array) -> list[float]:
        made = force(v)
        return [nrmse(ideal[at], made[at]).nrmse for at in (some, *acting)]

    whole, *bar = errors(plain)
    for _ in range(2):
        found, *each = errors(duty)
        worse = [at for at, a, b in zip(acting, each, bar, strict=True) if a > b + UNSEEN]
        if not worse:
            return duty if found < whole else plain
        duty = carried_out(np.where(np.logical_or.reduce(worse), plain, duty))
    return plain


def _task(
    model: Model, values: Values, signals: Signals, found: Inversion, hold: CausalHold
) -> Target:
    from erdctl.mimic.iterate import Target  # only where it is needed: it imports scipy

    return Target(model, values, signals, found.ideal, found.laws, hold)


def _plain(
    damper: Model,
    values: Values,
    signals: Signals,
    ideal: Array,
    g: FaultFactors,
    hold: CausalHold,
) -> Array:
    """The duty (n,) of the paper's parameters alone: by formula or iterated, as suits the damper.

    damper, ideal : the corrected model, and the faulty force (n,) [N] that it is to make
    """
    found = _invert(Model(), values, signals, g, hold)
    if not damper.effects:
        return found.compensated
    task = _task(Model(), values, signals, found, hold)
    real = replace(task, model=damper, ideal=ideal)
    return min(found.compensated, task.improved(found.compensated)[0], key=real.miss)


def _unreached(found: Inversion, made: Array, idle: Array, acting: Flags) -> tuple[Flags, Array]:
    """Samples (n,) that no duty brings to the ideal force, and the force missing there (n,) [N].

    Where the force is already too large with no field at all, and the best sequence misses it too:
    with a yield force that outlasts a reversal, the first alone proves nothing.

    made, idle : (n,) force of the best sequence, and with no field at all [N]
    """
    ideal, way = found.ideal, found.way
    missed = np.abs(ideal - made) > MISSED * np.ptp(ideal)
    out = acting & missed & ((ideal - idle) * way < 0.0) & ((ideal - made) * way < 0.0)
    return out, np.where(out, np.minimum(np.abs(ideal - idle), np.abs(ideal - made)), 0.0)
