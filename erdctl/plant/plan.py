"""What a seed decides before anything is simulated: what to hide, how strongly, in which campaign.

Each decision has its own stream of random numbers, so that the campaign and the noise of a seed are
the same whatever is hidden, and nothing that fails later can change them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.plant.campaign import Campaign, draw_campaign
from erdctl.plant.hidden import CATALOGUE, OUTSIDE, Twin
from erdctl.plant.noise import (
    COLOURS,
    ForceNoise,
    MotionNoise,
    draw_force_noise,
    draw_gains,
    draw_motion_noise,
)

Random = np.random.Generator

KINDS = ("single", "pair", "null", "unknown")
CONCEALMENTS = ("unlabelled", "absorbed", "not_logged")
KIND_SHARES = (0.6, 0.15, 0.125, 0.125)
BANDS = ((0.2, 1.0), (1.0, 2.0), (2.0, 10.0))
BAND_SHARES = (0.2, 0.25, 0.55)
OF_A_PAIR = (2.0, 5.0)  # each; with more, one hides the other
STREAMS = (
    "plan",
    "campaign",
    "force noise",
    "motion noise",
    "gains",
    "damper",
    "fresh",
    "sound",
    "rig",
)


@dataclass(frozen=True)
class CasePlan:
    """effects : to hide;  levels : wanted for each."""

    seed: int
    kind: str
    effects: tuple[Twin, ...]
    levels: tuple[float, ...]
    campaign: Campaign
    force_noise: ForceNoise
    motion_noise: MotionNoise
    gains: tuple[float, ...]


def stream(seed: int, name: str, *more: int) -> Random:
    """Random numbers of one decision."""
    return np.random.default_rng([seed, STREAMS.index(name), *more])


def draw_plan(
    seed: int,
    *,
    effects: Sequence[str] | None = None,
    level: float | None = None,
    kind: str | None = None,
    concealment: str | None = None,
    motion: str | None = None,
    colour: str | None = None,
    scatter: bool = False,
) -> CasePlan:
    """A plan; the arguments are those of `draw`."""
    _known("kind", kind, KINDS)
    _known("concealment", concealment, CONCEALMENTS)
    _known("motion", motion, ("exact", "measured"))
    _known("colour", colour, COLOURS)
    random = stream(seed, "plan")
    chosen = str(random.choice(KINDS, p=KIND_SHARES))
    if kind is None and effects is not None:
        chosen = "unknown" if all(e in OUTSIDE for e in effects) else "single"
    chosen = kind or chosen
    hidden = _chosen(random, chosen, effects, unlogged=concealment == "not_logged")
    levels = tuple(
        _level(random, chosen, concealment) if level is None else float(level) for _ in hidden
    )
    campaign = draw_campaign(stream(seed, "campaign"))
    gains = stream(seed, "gains")
    spread = float(gains.uniform(0.02, 0.06)) if scatter else 0.0
    return CasePlan(
        seed, chosen, hidden, levels, campaign,
        draw_force_noise(stream(seed, "force noise"), colour),
        draw_motion_noise(stream(seed, "motion noise"), campaign, motion),
        draw_gains(gains, len(campaign.records), spread),
    )  # fmt: skip


def _known(name: str, value: str | None, values: Sequence[str]) -> None:
    if value is not None and value not in values:
        raise ValueError(f"{name} is {value!r}, expected one of {', '.join(values)}")


def _chosen(
    random: Random, kind: str, names: Sequence[str] | None, *, unlogged: bool
) -> tuple[Twin, ...]:
    if kind == "null":
        return ()
    source = OUTSIDE if kind == "unknown" else CATALOGUE
    unknown = [n for n in names or () if n not in source]
    if unknown:
        raise ValueError(f"no such effect to hide: {', '.join(unknown)}; there are {list(source)}")
    pool = [source[n] for n in names or source if source[n].hidden or not unlogged]
    if not pool:
        raise ValueError("none of these effects hides a temperature or a fault's onset")
    first = pool[int(random.integers(len(pool)))]
    if kind != "pair":
        return (first,)
    others = [e for e in pool if e.family != first.family]
    if not others:
        raise ValueError(f"nothing to pair {first.name} with: the others fill the same place")
    return first, others[int(random.integers(len(others)))]


def _level(random: Random, kind: str, concealment: str | None) -> float:
    """Below the noise nobody can tell what a stranger is, nor that a fit fails elsewhere."""
    low, high = BANDS[int(random.choice(len(BANDS), p=BAND_SHARES))]
    if kind == "pair":
        low, high = OF_A_PAIR
    elif kind == "unknown" or concealment == "absorbed":
        low, high = BANDS[-1]
    return float(np.exp(random.uniform(np.log(low), np.log(high))))
