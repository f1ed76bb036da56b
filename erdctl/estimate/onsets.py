"""The time at which something sets in: found by a search of all times, as its cost has many dips.

A step towards a lower cost sees only the samples next to an onset. So a fit of all other
parameters and a search of all times (`estimate.onset_profile`) take turns.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.estimate.onset_profile import Profile
from erdctl.model.checked import GROUPS
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.onset import AMOUNT, RAMP, START
from erdctl.model.slots import ChannelSlot, Values

DIFFERENCE = 1e-6  # relative step of a one-sided difference


def placed(model: Model) -> tuple[str, ...]:
    """Names of the parameters that are found by a search of all times, and by no other."""
    return tuple(e.key(symbol) for e in model.effects if e.sets_in for symbol in (START, RAMP))


def profile(
    model: Model, effect: Effect, signals: Signals, residual: Array, lever: Array, values: Values,
    held: Iterable[str], times: Array | None = None,
) -> Profile:  # fmt: skip
    """The profile of the onset of an effect that a model does not hold, at some values.

    residual : (n,) that the model leaves, weighted;  lever : (n,) of its force on that
    held : names of parameters that do not move
    times : (n,) in which onsets are sought [s], if not those of the records
    """
    fixed = {*held, *placed(model)}
    free = [n for n, q in model.quantities.items() if n not in fixed and q.low < values[n] < q.high]
    prepared = model.prepare(signals, values)
    parts = prepared.parts(values)
    whole, failing = np.zeros((2, len(free) + 1, len(signals)))
    linear: dict[str, tuple[str, Array]] = {}
    if model.separable:
        groups = [g for g in GROUPS for _ in DIRECTIONS]
        groups += ["other"] * (len(model.linear) - len(groups))
        rows = zip(groups, prepared.columns(), strict=True)
        linear = dict(zip(model.linear, rows, strict=True))
    for k, name in enumerate(free):
        if name in linear:
            group, row = linear[name]
            changes = {group: row}
        else:
            q = model.quantities[name]
            step = DIFFERENCE * max(abs(values[name]), 1e-3 * max(abs(q.start), 1e-3))
            step = -step if values[name] + step > q.high else step
            shifted = model.parts(signals, {**values, name: values[name] + step})
            changes = {g: (shifted[g] - part) / step for g, part in parts.items()}
        for group, change in changes.items():
            whole[k] += change * lever
            if group in effect.sets_in:
                failing[k] += change * lever
    whole[-1] = residual
    failing[-1] = -lever * np.sum([parts[g] for g in effect.sets_in], axis=0)
    acted = signals.t if times is None else times
    for channel, slot in model.of(ChannelSlot):
        # What is linear in a force and keeps a steady one delays the time as it does that.
        acted = slot(acted, signals, channel.local(values))
    return Profile(signals, acted, whole, failing)


def profile_within(
    model: Model, effect: Effect, block: Block, values: Values, held: Iterable[str]
) -> Profile:
    """The same of an effect that the model holds."""
    others = Model(tuple(e for e in model.effects if e is not effect))
    lever = np.sqrt(block.weight)
    residual = (block.force - others.force(block.signals, values)) * lever
    return profile(others, effect, block.signals, residual, lever, values, held)


def place(model: Model, block: Block, values: Values, held: Iterable[str]) -> dict[str, float]:
    """Values with every onset where it leaves least, all others moving to first order."""
    out, fixed = dict(values), set(held)
    for effect in model.effects:
        if effect.sets_in and not fixed.issuperset(effect.key(s) for s in (START, RAMP)):
            found = profile_within(model, effect, block, out, fixed).best()
            out |= {effect.key(symbol): value for symbol, value in found.values.items()}
    return out


def onset_intervals(
    model: Model, block: Block, values: Values, held: Iterable[str]
) -> dict[str, tuple[float, float]]:
    """95 % intervals of every onset and ramp of a fitted model, by name."""
    out: dict[str, tuple[float, float]] = {}
    fixed = set(held)
    for effect in model.effects:
        names = {symbol: effect.key(symbol) for symbol in (AMOUNT, START, RAMP)}
        if effect.sets_in and fixed.isdisjoint(names.values()):
            at = profile_within(model, effect, block, values, fixed)
            best = at.least(*(values[names[symbol]] for symbol in (START, RAMP, AMOUNT)))
            out |= {names[symbol]: interval for symbol, interval in at.intervals(best).items()}
    return out
