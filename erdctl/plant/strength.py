"""How strong to make an effect: by what the paper's model leaves of it after its refit.

    level(s) = rms of (force - refitted paper model) / rms of the force noise

grows with the strength s; s is sought on a logarithmic scale until the level is the wanted one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.plant.plant import Plant
from erdctl.plant.refit import Joined, Refit, refit, shape_of, shown
from erdctl.plant.regions import near_reversals
from erdctl.plant.simulate import Ride, forces
from erdctl.plant.twin import Scales, Twin

Array = npt.NDArray[np.float64]

CLOSE = 0.06  # of the log of the level
EVALUATIONS = 12
MOST_NEAR = 0.5  # share of the energy next to reversals
COMFORT = 0.42  # the same, with room for the next draw


@dataclass(frozen=True, eq=False)
class Setting:
    """A plain damper in a campaign, and the noise that its misfit is measured by.

    plain : (n,) its force [N];  noise : rms [N]
    """

    over: tuple[Ride, ...]
    samples: Joined
    base: Plant
    plain: Array
    scales: Scales
    noise: float


@dataclass(frozen=True, eq=False)
class Outcome:
    """A plant with its force (n,) [N], the paper's model refitted to it, and what is left.

    level, raw : misfit over noise, after the refit and against the same damper without the effect
    near : share of the misfit's energy within two samples of a reversal
    """

    strength: float
    plant: Plant
    force: Array
    fitted: Refit
    level: float
    raw: float
    near: float


def scales_of(over: Sequence[Ride], plain: Array, samples: Joined, stroke: float) -> Scales:
    """Sizes of a campaign with its plain damper."""
    inside = [slice(r.lead_in, r.lead_in + r.record.samples * r.substeps) for r in over]
    power = np.maximum(plain * samples.v, 0.0) * samples.dt
    energy = [
        float(power[a:b].sum())
        for a, b in zip(samples.starts[:-1], samples.starts[1:], strict=True)
    ]
    spans = [r.record.samples / r.record.rate for r in over]
    return Scales(
        x=float(np.abs(samples.x).max()),
        v=float(np.abs(samples.v).max()),
        a=max(float(np.abs(r.a[at]).max()) for r, at in zip(over, inside, strict=True)),
        stroke=stroke,
        force=float(np.ptp(plain)) / 2,
        duty=float(samples.duty.max()) or 1.0,
        shortest=min(spans),
        longest=max(spans),
        energy=max(energy),
        tick=over[0].h,
    )


def outcome(
    setting: Setting, plant: Plant, s: float, warm: Array | None = None, *, full: bool = False
) -> Outcome:
    """What a plant gives in a setting; `full` spares no start of the refit."""
    force = forces(plant, setting.over)
    own = shape_of(setting.base)
    starts = [own if warm is None else warm]
    if full:
        starts += [own, own + np.array([-0.7, -0.7, -1.0, -1.0]), own + np.array([0.5, 0.5, 1, 1])]
    fitted = refit(shown(setting.samples, plant), force, starts)
    plain = setting.plain
    if plant.compression != setting.base.compression:  # the effect has its own time constant
        plain = forces(plant.plain(), setting.over)
    raw = float(np.sqrt(np.mean((force - plain) ** 2)))
    near = near_reversals(setting.samples, fitted.rest)
    return Outcome(s, plant, force, fitted, fitted.rms / setting.noise, raw / setting.noise, near)


def sought(
    setting: Setting, effect: Twin, build: Callable[[float], Plant], wanted: float
) -> Outcome:
    """The effect as strong as it must be for the wanted level, or as near to it as it can come."""
    low, high = math.log(effect.low), math.log(effect.high)
    known: list[tuple[float, float]] = []  # log s, log level
    at, best, warm = math.log(effect.start), None, None
    for _ in range(EVALUATIONS):
        now = outcome(setting, build(math.exp(at)), math.exp(at), warm)
        warm = now.fitted.shape
        off = math.log(max(now.level, 1e-9) / wanted)
        if best is None or abs(off) < abs(math.log(max(best.level, 1e-9) / wanted)):
            best = now
        if abs(off) < CLOSE:
            break
        known.append((at, off))
        if off < 0:
            low = at
        else:
            high = at
        if high - low < 1e-3:
            break
        following = _guess(known, low, high)
        if abs(following - at) < 1e-6:
            break
        at = following
    assert best is not None
    return outcome(setting, best.plant, best.strength, best.fitted.shape, full=True)


def crowding(setting: Setting, effect: Twin, build: Callable[[float], Plant], at: Outcome) -> float:
    """How many times the level must rise before the misfit no longer lives next to reversals only;
    1 if it does not."""
    if at.near <= MOST_NEAR:
        return 1.0
    now, s = at, at.strength
    while now.near > COMFORT and s < effect.high:
        s = min(2.0 * s, effect.high)
        now = outcome(setting, build(s), s, now.fitted.shape)
    return max(now.level / max(at.level, 1e-9), 1.0)


def _guess(known: list[tuple[float, float]], low: float, high: float) -> float:
    """Where the level should be right: by a straight line through the two best, kept inside."""
    at, off = known[-1]
    slope = 0.7
    if len(known) > 1:
        (a, fa), (b, fb) = sorted(known, key=lambda p: abs(p[1]))[:2]
        at, off = a, fa
        slope = min(max((fa - fb) / (a - b), 0.15), 2.5) if a != b else slope
    following = at - off / slope
    if not low < following < high:
        below = any(f < 0 for _, f in known)
        above = any(f >= 0 for _, f in known)
        # Without a bracket go to the limit; within one halve it.
        following = 0.5 * (low + high) if below and above else (high if off < 0 else low)
    return following
