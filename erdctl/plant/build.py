"""One attempt at a case: a damper is drawn, and each effect made as strong as the plan wants it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from erdctl.plant.base import PLAIN, Weights, draw_base
from erdctl.plant.noise import ForceNoise
from erdctl.plant.plan import CasePlan
from erdctl.plant.plant import Plant
from erdctl.plant.refit import joined
from erdctl.plant.simulate import Ride, forces
from erdctl.plant.strength import MOST_NEAR, Outcome, Setting, crowding, outcome, scales_of, sought
from erdctl.plant.twin import Scales, Twin

Random = np.random.Generator


@dataclass(frozen=True)
class Variation:
    """How an attempt may differ from a plain draw.

    weights : parts of the force that are favoured;  noise : factor on the noise's amplitude
    levels : factor on the wanted level of each effect; 1 where there is none
    """

    weights: Weights = PLAIN
    noise: float = 1.0
    levels: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Built:
    """An attempt: what came out for each effect alone, without each, and for all together.

    effects : the hidden ones, in which a spare one may stand for one that was planned
    off : log of reached over wanted level, of each effect
    aims : how many of the effects, the first, an attempt must get right; in a crowd the strong one
    zeros : of the force channel in each record [N]
    crowding : of each, how many times its level must rise not to live next to reversals only
    """

    setting: Setting
    noise: ForceNoise
    effects: tuple[Twin, ...]
    alone: tuple[Outcome, ...]
    without: tuple[Outcome, ...]
    whole: Outcome
    off: tuple[float, ...]
    crowding: tuple[float, ...]
    aims: int
    zeros: tuple[float, ...]


def build(plan: CasePlan, over: tuple[Ride, ...], random: Random, variation: Variation) -> Built:
    """An attempt at a plan."""
    base = draw_base(random, plan.campaign, variation.weights)
    samples, plain = joined(over), forces(base, over)
    scales = scales_of(over, plain, samples, plan.campaign.rating.stroke)
    noise = plan.force_noise.scaled(float(np.ptp(plain)), variation.noise)
    zeros = tuple(z * float(np.ptp(plain)) for z in plan.zeros)
    setting = Setting(over, samples, base, plain, scales, noise.rms)
    makers, alone, off = [], [], []
    crowd: list[float] = []
    aims = 1 if plan.kind == "crowded" else len(plan.effects)
    factors = variation.levels or (1.0,) * len(plan.effects)
    effects, spare = list(plan.effects), list(plan.spare)
    for k, (level, factor) in enumerate(zip(plan.levels, factors, strict=True)):
        wanted, aimed = level * factor, k < aims
        while True:
            effect = effects[k]
            maker = _maker(effect, effect.drawn(random), scales)
            alone_in_base = partial(maker, base)
            found = sought(setting, effect, alone_in_base, wanted)
            others = [e for i, e in enumerate(effects) if i != k]
            fitting = [t for t in spare if all(t.goes_with(o) for o in others)]
            if aimed or found.near <= MOST_NEAR or not fitting:
                break
            effects[k] = fitting[0]
            spare.remove(fitting[0])
        crowd.append(crowding(setting, effect, alone_in_base, found) if aimed else 1.0)
        off.append(float(np.log(max(found.level, 1e-9) / wanted)))
        makers.append(maker)
        alone.append(found)
    rest = tuple(off), tuple(crowd), aims, zeros
    hidden = tuple(effects)
    if len(alone) == 1:
        return Built(setting, noise, hidden, tuple(alone), (), alone[0], *rest)
    strengths = [a.strength for a in alone]
    whole = _together(setting, makers, strengths)
    without = tuple(
        _together(setting, makers[:k] + makers[k + 1 :], strengths[:k] + strengths[k + 1 :])
        for k in range(len(alone))
    )
    return Built(setting, noise, hidden, tuple(alone), without, whole, *rest)


Maker = Callable[[Plant, float], Plant]


def _maker(effect: Twin, shape: dict[str, float], scales: Scales) -> Maker:
    return lambda plant, s: effect.build(plant, s, shape, scales)


def _together(setting: Setting, makers: Sequence[Maker], strengths: Sequence[float]) -> Outcome:
    plant = setting.base
    for maker, s in zip(makers, strengths, strict=True):
        plant = maker(plant, s)
    return outcome(setting, plant, float("nan"), full=True)
