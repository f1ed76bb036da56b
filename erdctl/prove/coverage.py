"""Whether 95 % intervals hold the truth in 95 % of draws: the plant's dampers, known to the digit.

A damper is drawn with a short campaign, and read as often as asked with another noise; nothing is
searched for, the model is the right one. Counted is, for every parameter with a value, whether its
interval holds what the plant was given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import NONE_VARY, Varying
from erdctl.effects import get
from erdctl.estimate.covariance import estimates
from erdctl.estimate.identify import identify
from erdctl.model.parameters import Estimate
from erdctl.plant.base import draw_base
from erdctl.plant.campaign import draw_short
from erdctl.plant.noise import DISTURBANCES, disturbed
from erdctl.plant.own import velocity
from erdctl.plant.plant import Plant
from erdctl.plant.refit import joined
from erdctl.plant.simulate import Ride, forces, rides
from erdctl.plant.strength import scales_of
from erdctl.plant.twins import every

FRACTIONS = (0.003, 0.01)  # rms of the noise over the range of the force
WEAKEST, STRONGEST = 0.3, 2.0  # times the strength that a twin starts with
SAMPLES = 5_000
SOFTER = 8  # parts of the plant's step


@dataclass(frozen=True, eq=False)
class Concealed:
    """A damper with at most one effect, over one campaign.

    effect : its name, "" for the paper's model alone;  recording : with its force, free of noise
    truth : every parameter that has one;  rms : of the noise to come [N]
    """

    effect: str
    seed: int
    recording: Recording
    truth: dict[str, float]
    rms: float


@dataclass(frozen=True)
class Held:
    """One parameter of one reading, and whether its interval holds the truth."""

    parameter: str
    truth: float
    estimate: Estimate

    @property
    def inside(self) -> bool | None:
        """None without a value or an interval."""
        if self.estimate.value is None or self.estimate.interval is None:
            return None
        low, high = self.estimate.interval
        return low <= self.truth <= high

    @property
    def off(self) -> float | None:
        """Estimate less truth over the standard error, where it has one."""
        e = self.estimate
        return (e.value - self.truth) / e.stderr if e.value is not None and e.stderr else None


def conceal(effect: str, seed: int, samples: int = SAMPLES) -> Concealed:
    """The damper of a seed, with an effect whose law is the one that is fitted."""
    random = np.random.default_rng([seed, *effect.encode()])
    campaign = draw_short(random, samples=samples)
    twin = every()[effect] if effect else None
    # What lies behind a spring marches by implicit Euler, whose error at the plant's usual step is
    # that of a gas that is one standard error stiffer.
    over = rides(campaign, refine=SOFTER if twin and twin.soft else 1)
    plant, own = draw_base(random, campaign), dict[str, float]()
    clean = forces(plant, over)
    if twin:
        if twin.law is None:
            raise ValueError(f"{effect}: the plant has another law than is fitted, so no truth")
        scales = scales_of(over, clean, joined(over), campaign.rating.stroke)
        ends = max(twin.low, WEAKEST * twin.start), min(twin.high, STRONGEST * twin.start)
        strength = float(np.exp(random.uniform(*np.log(ends))))
        plant, own = twin.law(twin.build(plant, strength, twin.drawn(random), scales))
        clean = forces(plant, over)
    truth = _paper(plant) | {k if "." in k else get(effect).key(k): v for k, v in own.items()}
    rms = float(np.exp(random.uniform(*np.log(FRACTIONS)))) * float(np.ptp(clean))
    return Concealed(effect, seed, _recording(plant, over, clean), truth, rms)


def read(damper: Concealed, kind: str, number: int = 0, *, free: Varying = NONE_VARY) -> list[Held]:
    """What a fit says of a damper whose force is read with some kind of noise.

    free : what each record may have of its own
    """
    clean = damper.recording
    assert clean.force is not None
    random = np.random.default_rng([damper.seed, DISTURBANCES.index(kind), number])
    lengths = np.diff(clean.starts).tolist()
    noisy = disturbed(random, clean.force, lengths, damper.rms, kind)
    recording, truth = replace(clean, force=noisy), damper.truth
    if not damper.effect and not free:
        found = dict(identify(recording).joint)
    else:
        problem = prepare(recording, free)
        effects = [get(damper.effect)] if damper.effect else []
        hypothesis = fit_hypothesis(problem, effects, [truth])
        fit, _ = fit_errors(problem, hypothesis)
        found = estimates(fit, {n: need.reason for n, need in hypothesis.problem.needs.items()})
    return [Held(name, truth[name], e) for name, e in found.items() if name in truth]


def _paper(plant: Plant) -> dict[str, float]:
    sides = {"compression": plant.compression, "release": plant.release}
    return {f"{d}.{s}": v for d, side in sides.items() for s, v in side._asdict().items()}


def _recording(plant: Plant, over: Sequence[Ride], force: Array) -> Recording:
    t, x, v = zip(*(r.sampled() for r in over), strict=True)
    v = tuple(velocity(plant.own, part, i) for i, part in enumerate(v))
    lengths = [r.record.samples for r in over]
    return Recording(
        t=np.concatenate(t), x=np.concatenate(x), xdot=np.concatenate(v),
        duty=np.concatenate([r.duty for r in over]), force=force,
        starts=np.concatenate([[0], np.cumsum(lengths)]).astype(np.intp),
        names=tuple(r.record.name for r in over),
    )  # fmt: skip
