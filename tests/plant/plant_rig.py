"""A small campaign and a plain damper that the tests of the plant share."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from erdctl.effects import names
from erdctl.plant import Campaign, CampaignRecord, DutyProgramme, Plant, Side, Trajectory, twins
from erdctl.plant.campaign import Rating
from erdctl.plant.refit import Joined, joined
from erdctl.plant.simulate import Ride, forces, rides
from erdctl.plant.strength import scales_of
from erdctl.plant.twin import Scales, Twin

Array = npt.NDArray[np.float64]

DAMPER = Plant(
    Side(k_nom=263.0, c_vis=64.6, T_d=0.043, sigma=12.8, beta=0.6),
    Side(k_nom=170.4, c_vis=68.8, T_d=0.030, sigma=17.0, beta=0.8),
)
RATE = 250.0
EVERY = twins.names()
KNOWN = names()
UNKNOWN = tuple(name for name in EVERY if name not in KNOWN)


def effect(name: str) -> Twin:
    """By its name."""
    return twins.get(name)


def sine(f: float, a: float, phase: float = 0.3, **more: float) -> Trajectory:
    return Trajectory("tones", (a,), (f,), (phase,), **more)


def constant(level: float) -> DutyProgramme:
    return DutyProgramme((level,), (0,))


def record(
    motion: Trajectory, duty: DutyProgramme, *, seconds: float = 4.0, name: str = "r"
) -> CampaignRecord:
    return CampaignRecord(name, RATE, round(seconds * RATE), motion, duty)


@cache
def campaign() -> Campaign:
    """Four records: no control, constant, steps, random motion under steps."""
    random = Trajectory(
        "tones", (0.006, 0.004, 0.002, 0.001), (0.4, 0.9, 1.7, 2.9), (0.1, 2.0, 4.0, 1.0), 0.002
    )
    steps = DutyProgramme((0.1, 0.4, 0.0, 0.25, 0.5, 0.15), (0, 130, 260, 420, 600, 830))
    records = (
        record(sine(1.0, 0.012), constant(0.0)),
        record(sine(0.7, 0.015, 1.1), constant(0.35)),
        record(sine(1.6, 0.008, 2.2), steps),
        record(random, steps),
    )
    levels = (0.0, 0.1, 0.15, 0.25, 0.35, 0.4, 0.5)
    return Campaign(Rating(0.016, 0.1), RATE, 0.4, 2.9, 1.0, 1.0, 0.5, levels, records)


@cache
def over(refine: int = 1) -> tuple[Ride, ...]:
    return rides(campaign(), refine=refine)


@cache
def samples() -> Joined:
    return joined(over())


@cache
def plain() -> Array:
    return forces(DAMPER, over())


def scales() -> Scales:
    return scales_of(over(), plain(), samples(), 0.016)


def hidden(name: str, s: float) -> Plant:
    """The damper with an effect of strength s in its middle shape."""
    e = effect(name)
    shape = {k: 0.5 * (a + b) for k, (a, b) in e.shape.items()}
    return e.build(DAMPER, s, shape, scales())


# Of these the force is that of the plain damper: their own tests hold them to the motion they log.
MOTION_ALONE = tuple(n for n in EVERY if any(o.hooks.velocity for o in hidden(n, 0.01).own))
ACTING = tuple(n for n in EVERY if n not in MOTION_ALONE)


def rms(u: Array) -> float:
    return float(np.sqrt(np.mean(u**2)))
