"""Whether 95 % intervals hold the truth in 95 % of draws: the plant's dampers, known to the digit.

Each draw is another damper, another short campaign and another noise; nothing is searched for, the
model is the right one. Counted is, for every parameter with a value, whether its interval holds
what the plant was given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate.covariance import estimates
from erdctl.estimate.identify import identify
from erdctl.model.parameters import Estimate
from erdctl.plant.base import draw_base
from erdctl.plant.campaign import draw_short
from erdctl.plant.noise import DISTURBANCES, disturbed
from erdctl.plant.plant import Plant
from erdctl.plant.refit import joined
from erdctl.plant.simulate import Ride, forces, rides
from erdctl.plant.strength import scales_of
from erdctl.plant.twins import every

FRACTIONS = (0.003, 0.01)  # rms of the noise over the range of the force


@dataclass(frozen=True)
class Held:
    """One parameter of one draw.

    inside : whether its interval holds the truth; None if it has no value
    off : estimate less truth over the standard error, where it has one
    """

    effect: str
    kind: str
    seed: int
    parameter: str
    truth: float
    estimate: Estimate
    inside: bool | None
    off: float | None


def draw(effect: str, kind: str, seed: int) -> list[Held]:
    """Parameters of one draw; `effect` is "" for the paper's model alone."""
    own: dict[str, float] = {}
    random = np.random.default_rng([seed, DISTURBANCES.index(kind), *effect.encode()])
    campaign = draw_short(random)
    over = rides(campaign)
    plant = draw_base(random, campaign)
    samples = joined(over)
    clean = forces(plant, over)
    if effect:
        twin = every()[effect]
        scales = scales_of(over, clean, samples, campaign.rating.stroke)
        low, high = max(twin.low, 0.3 * twin.start), min(twin.high, 2.0 * twin.start)
        strength = float(np.exp(random.uniform(np.log(low), np.log(high))))
        plant = twin.build(plant, strength, twin.drawn(random), scales)
        if twin.law is None:
            raise ValueError(f"{effect}: the plant has another law than is fitted, so no truth")
        plant, own = twin.law(plant)
        clean = forces(plant, over)
    lengths = [r.record.samples for r in over]
    rms = float(np.exp(random.uniform(*np.log(FRACTIONS)))) * float(np.ptp(clean))
    recording = _recording(over, disturbed(random, clean, lengths, rms, kind))
    truth = _paper(plant)
    if not effect:
        found = dict(identify(recording).joint)
    else:
        truth |= {k if "." in k else get(effect).key(k): v for k, v in own.items()}
        problem = prepare(recording)
        hypothesis = fit_hypothesis(problem, [get(effect)], [truth])
        fit, _ = fit_errors(problem, hypothesis)
        found = estimates(fit, {n: need.reason for n, need in problem.needs.items()})
    return [
        Held(effect, kind, seed, name, truth[name], e, *_judged(e, truth[name]))
        for name, e in found.items()
    ]


def _judged(e: Estimate, truth: float) -> tuple[bool | None, float | None]:
    if e.value is None or e.interval is None:
        return None, None
    low, high = e.interval
    off = (e.value - truth) / e.stderr if e.stderr else None
    return low <= truth <= high, off


def _paper(plant: Plant) -> dict[str, float]:
    sides = {"compression": plant.compression, "release": plant.release}
    return {f"{d}.{s}": v for d, side in sides.items() for s, v in side._asdict().items()}


def _recording(over: Sequence[Ride], force: np.ndarray) -> Recording:
    t, x, v = (np.concatenate(c) for c in zip(*(r.sampled() for r in over), strict=True))
    lengths = [r.record.samples for r in over]
    return Recording(
        t=t, x=x, xdot=v, duty=np.concatenate([r.duty for r in over]), force=force,
        starts=np.concatenate([[0], np.cumsum(lengths)]).astype(np.intp),
        names=tuple(r.record.name for r in over),
    )  # fmt: skip
