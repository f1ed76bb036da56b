"""From a seed to a concealed case.

The campaign stands; if it cannot show the effect as wanted, the damper and the amplitude of the
noise are drawn anew: less noise and a part of the force that carries the effect, or, where the
misfit would live only next to the reversals, more noise and less yield force, so that the same
level needs more of the effect. At last the effect is made stronger than wanted.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from erdctl.plant.base import Weights
from erdctl.plant.build import Built, Variation, build
from erdctl.plant.campaign import Campaign, draw_other
from erdctl.plant.case import Case, Truth
from erdctl.plant.noise import FRACTIONS
from erdctl.plant.plan import CasePlan, draw_plan, stream
from erdctl.plant.plant import Plant
from erdctl.plant.refit import joined, predicted
from erdctl.plant.regions import regions
from erdctl.plant.simulate import forces, rides
from erdctl.plant.strength import MOST_NEAR
from erdctl.plant.twin import Twin

TRIES = 6
PATIENCE = 3  # tries before levels are raised, or given up
CHOICES = 4  # of fresh records, where those must show that the fit fails
NOT_AS_ASKED = 10.0  # fault of a case that is not concealed as asked
TOLERANCE = 0.1  # of the log of a level
GOOD = 0.1  # NRMSE below which a plain fit looks good
WORSE = 1.5  # times as bad on fresh records
LABELS = {True: "absorbed", False: "unlabelled"}
ABSORBED = 0.15  # part of the raw misfit that the refit leaves at most


def draw(
    seed: int,
    *,
    known: Collection[str] | None = None,
    effects: Sequence[str] | None = None,
    level: float | None = None,
    kind: str | None = None,
    concealment: str | None = None,
    motion: str | None = None,
    colour: str | None = None,
    scatter: bool = False,
) -> Case:
    """A concealed case.

    known : names that a diagnosis can give, its catalogue; None for all that the plant can hide
    effects : names to choose from; all that are known, or all that are not for "unknown"
    level : misfit that the refitted paper model leaves, over the rms of the force noise
    kind : "single", "pair", "null" (nothing hidden) or "unknown" (not known); drawn only when asked
        for: "crowded" (a strong effect among faint ones, records that scatter; `level` is that of
        the strong one) and "sparse" (few short records, one effect in two thirds of the cases)
    concealment : "absorbed" looks for a damper whose plain fit looks good and fails elsewhere (it
        may find none, and the case says what it is), "not_logged" for a hidden temperature or onset
    motion : "exact", or "measured" for xdot from a noisy, quantised x
    colour : of the force noise, "white", "ar1" or "pink";  scatter : of the gain between records
    """
    plan = draw_plan(
        seed, known=known, effects=effects, level=level, kind=kind, concealment=concealment,
        motion=motion, colour=colour, scatter=scatter,
    )  # fmt: skip
    case, faults = _drawn(plan, concealment)
    for hidden in plan.instead:
        if faults == 0.0:
            break
        other, worse = _drawn(replace(plan, effects=hidden), concealment)
        case, faults = min([(case, faults), (other, worse)], key=lambda c: c[1])
    return case


def _drawn(plan: CasePlan, concealment: str | None) -> tuple[Case, float]:
    """The case of a plan that is least at fault, and by how much."""
    seed, over = plan.seed, rides(plan.campaign)
    tries = PATIENCE if plan.instead else TRIES
    variation, best = Variation(), None
    for attempt in range(tries):
        built = build(plan, over, stream(seed, "damper", attempt), variation)
        drawn = replace(plan, effects=built.effects)
        for choice in range(CHOICES if concealment == "absorbed" else 1):
            other = draw_other(stream(seed, "fresh", attempt, choice), plan.campaign)
            case = _case(drawn, built, other)
            faults = _faults(case, built, concealment)
            if best is None or faults < best[0]:
                best = faults, case
            if faults < NOT_AS_ASKED:
                break
        # A level out of this campaign's reach stays so; the key says what was reached instead.
        calm = max(built.crowding, default=1.0) == 1.0
        given_up = attempt >= PATIENCE and faults < NOT_AS_ASKED and calm
        if faults == 0.0 or given_up:
            break
        variation = _next(variation, built, built.effects, attempt)
    assert best is not None
    return best[1], best[0]


def _next(variation: Variation, built: Built, effects: Sequence[Twin], attempt: int) -> Variation:
    """What to change after an attempt that did not give what was wanted."""
    weights, noise = variation.weights, variation.noise
    levels = variation.levels or (1.0,) * len(effects)
    fraction = built.noise.fraction
    crowding = max(built.crowding, default=1.0)
    aimed = built.off[: built.aims]
    weak = [off < -TOLERANCE for off in aimed]
    if crowding > 1.0 and not any(weak):
        gain = min(crowding, FRACTIONS[1] / fraction)
        noise *= gain
        weights = replace(weights, yielding=weights.yielding * 0.9 * gain / crowding)
    elif any(weak):
        noise *= max(0.9 * float(np.exp(min(aimed))), FRACTIONS[0] / fraction)
        for effect, off in zip(effects, aimed, strict=False):
            if off < -TOLERANCE:
                weights = _favoured(weights, effect.part, min(1.5 * float(np.exp(-off)), 6.0))
    # Where one effect of a pair needs less noise and the other more, or nothing else helps.
    if any(weak) or attempt >= PATIENCE:
        levels = tuple(
            level * min(crowded, 2.0) for level, crowded in zip(levels, built.crowding, strict=True)
        )
    return Variation(weights, noise, levels)


def _farthest(built: Built) -> float:
    return max((abs(off) for off in built.off[: built.aims]), default=0.0)


def _favoured(weights: Weights, part: str, factor: float) -> Weights:
    return Weights(
        weights.gas * (factor if part == "gas" else 1.0),
        weights.viscous * (factor if part == "viscous" else 1.0),
        weights.yielding * (factor if part == "yielding" else 1.0),
    )


def _faults(case: Case, built: Built, concealment: str | None) -> float:
    """0 for a case as wanted; else how far off it is."""
    if not case.truth:
        return 0.0
    near = max(case.near, *(alone.near for alone in built.alone[: built.aims]))
    off = max(_farthest(built) - TOLERANCE, 0.0) + 4.0 * max(near - MOST_NEAR, 0.0)
    if concealment == "absorbed" and not _absorbed(case.own_nrmse, case.fresh_nrmse):
        off += NOT_AS_ASKED
    return off


def _absorbed(own: float, fresh: float) -> bool:
    return own < GOOD and fresh > WORSE * own


def _case(plan: CasePlan, built: Built, other: Campaign) -> Case:
    setting, whole = built.setting, built.whole
    spread = float(np.ptp(whole.force))
    own = float(np.hypot(whole.fitted.rms, built.noise.rms)) / spread
    over = rides(other)
    true = forces(whole.plant, over)
    missed = true - predicted(joined(over), whole.fitted.plant)
    fresh = float(np.sqrt(np.mean(missed**2)) / np.ptp(true))
    hidden = any(e.hidden for e in plan.effects)
    return Case(
        seed=plan.seed,
        kind=plan.kind,
        concealment="not_logged"
        if hidden
        else LABELS[bool(plan.effects) and _absorbed(own, fresh)],
        truth=tuple(_truth(plan, built, k) for k in range(len(plan.effects))),
        plant=whole.plant,
        refitted=whole.fitted.plant,
        campaign=plan.campaign,
        fresh=other,
        force_noise=built.noise,
        motion_noise=plan.motion_noise,
        gains=plan.gains,
        level=whole.level,
        raw=whole.raw,
        near=whole.near if plan.effects else 0.0,
        own_nrmse=own,
        fresh_nrmse=fresh,
        regions=regions(setting.samples, whole.force, whole.fitted.rest) if plan.effects else (),
        effect_regions=regions(setting.samples, whole.force, whole.force - setting.plain),
        flags=_flags(plan, built),
        zeros=built.zeros,
    )


def _truth(plan: CasePlan, built: Built, k: int) -> Truth:
    effect, alone = plan.effects[k], built.alone[k]
    within = alone.level
    if built.without:
        added = built.whole.fitted.rest - built.without[k].fitted.rest
        within = float(np.sqrt(np.mean(added**2))) / built.noise.rms
    return Truth(
        name=effect.name,
        catalogued=plan.known[k],
        parameters={
            path.split(".")[1]: (_value(built.whole.plant, effect.name, path), unit)
            for path, unit in effect.shows.items()
        },
        strength=alone.strength,
        wanted=plan.levels[k],
        alone=alone.level,
        raw=alone.raw,
        within=within,
        equivalent=effect.equivalents,
        law=_law(effect, built.whole.plant),
        lies=effect.lies,
    )


def _law(effect: Twin, plant: Plant) -> dict[str, float] | None:
    """Parameters of the law usually fitted; None where the plant's is another."""
    if effect.law is None:
        return None
    nearest, parameters = effect.law(plant)
    return parameters if nearest == plant else None


def _value(plant: Plant, name: str, path: str) -> float:
    """Value of a field that a twin shows, in the plant or among what the twin's own file brings."""
    part, field = path.split(".")
    if part == "own":
        return next(dict(o.values)[field] for o in plant.own if o.hooks.name == name)
    return float(getattr(getattr(plant, part), field))


def _flags(plan: CasePlan, built: Built) -> tuple[str, ...]:
    flags = []
    if plan.effects and built.whole.near > MOST_NEAR:
        flags.append("the misfit lives next to reversals only")
    for effect, alone, off in zip(plan.effects, built.alone, built.off, strict=True):
        if abs(off) > TOLERANCE:
            flags.append(f"{effect.name}: wanted level not reached")
        if alone.near > MOST_NEAR:
            flags.append(f"{effect.name}: lives next to reversals only")
        if alone.level < ABSORBED * alone.raw:
            flags.append(f"{effect.name}: the paper's parameters absorb it")
        if alone.level < 0.5:
            flags.append(f"{effect.name}: far below the noise")
    return tuple(dict.fromkeys(flags))
