"""What a seed decides before anything is simulated: what to hide, how strongly, in which campaign.

Each decision has its own stream of random numbers, so that the campaign and the noise of a seed are
the same whatever is hidden, and nothing that fails later can change them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.plant.campaign import Campaign, draw_campaign
from erdctl.plant.crowd import crowd, crowd_campaign, crowd_levels, scattered
from erdctl.plant.noise import (
    COLOURS,
    ForceNoise,
    MotionNoise,
    draw_force_noise,
    draw_gains,
    draw_motion_noise,
)
from erdctl.plant.sparse import sparse_campaign, sparse_level, sparse_order
from erdctl.plant.twin import Twin
from erdctl.plant.twins import every

Random = np.random.Generator

KINDS = ("single", "pair", "null", "unknown")
ASKED = ("crowded", "sparse")  # drawn only when asked for
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
    "crowded",
    "sparse",
)


@dataclass(frozen=True)
class CasePlan:
    """effects : to hide;  levels : wanted for each;  known : which of them can be named.

    zeros : of the force in each record, over the range of the force; () where none has any
    instead : what else to hide, in turn, where the campaign cannot show the first as strong as that
    spare : for the place of a faint one that would live next to reversals only
    """

    seed: int
    kind: str
    effects: tuple[Twin, ...]
    known: tuple[bool, ...]
    levels: tuple[float, ...]
    campaign: Campaign
    force_noise: ForceNoise
    motion_noise: MotionNoise
    gains: tuple[float, ...]
    zeros: tuple[float, ...] = ()
    instead: tuple[tuple[Twin, ...], ...] = ()
    spare: tuple[Twin, ...] = ()


def stream(seed: int, name: str, *more: int) -> Random:
    """Random numbers of one decision."""
    return np.random.default_rng([seed, STREAMS.index(name), *more])


def draw_plan(
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
) -> CasePlan:
    """A plan; the arguments are those of `draw`."""
    _known("kind", kind, (*KINDS, *ASKED))
    _known("concealment", concealment, CONCEALMENTS)
    _known("motion", motion, ("exact", "measured"))
    _known("colour", colour, COLOURS)
    random = stream(seed, "plan")
    chosen = str(random.choice(KINDS, p=KIND_SHARES))
    twins = every()
    inside = {n: t for n, t in twins.items() if known is None or n in known}
    outside = {n: t for n, t in twins.items() if n not in inside}
    if kind is None and effects is not None:
        chosen = "unknown" if all(e in outside for e in effects) else "single"
    elif chosen == "unknown" and not outside:
        chosen = "single"
    chosen = kind or chosen
    _hideable(chosen, effects or (), inside, outside)
    source = outside if chosen == "unknown" else inside
    if chosen in ASKED:
        pool = _pool(effects, source, unlogged=concealment == "not_logged")
        drawn = _crowded if chosen == "crowded" else _sparse
        return drawn(seed, pool, level, motion, colour, always=effects is not None)
    hidden = _chosen(random, chosen, effects, source, unlogged=concealment == "not_logged")
    levels = tuple(
        _level(random, chosen, concealment) if level is None else float(level) for _ in hidden
    )
    campaign = draw_campaign(stream(seed, "campaign"))
    gains = stream(seed, "gains")
    spread = float(gains.uniform(0.02, 0.06)) if scatter else 0.0
    return CasePlan(
        seed, chosen, hidden, tuple(e.name in inside for e in hidden), levels, campaign,
        draw_force_noise(stream(seed, "force noise"), colour),
        draw_motion_noise(stream(seed, "motion noise"), campaign, motion),
        draw_gains(gains, len(campaign.records), spread),
    )  # fmt: skip


def _known(name: str, value: str | None, values: Sequence[str]) -> None:
    if value is not None and value not in values:
        raise ValueError(f"{name} is {value!r}, expected one of {', '.join(values)}")


Twins = Mapping[str, Twin]


def _hideable(kind: str, names: Sequence[str], inside: Twins, outside: Twins) -> None:
    """Raise ValueError, which says why, if a kind of case cannot hide what is asked for."""
    if kind == "null":
        return
    if kind == "unknown" and not outside:
        raise ValueError("nothing is unknown: the catalogue has all that the plant can hide")
    source, other = (outside, inside) if kind == "unknown" else (inside, outside)
    known, unknown = "the catalogue has it", "it is not in the catalogue, so its kind is unknown"
    for name in names:
        if name in other:
            raise ValueError(
                f"no such effect to hide: {name} in a case of kind {kind}, as "
                f"{known if kind == 'unknown' else unknown}; there are {list(source)}"
            )
        if name not in source:
            raise ValueError(
                f"no such effect to hide: {name}, the plant has no twin of that name; "
                f"there are {list(source)}"
            )


def _chosen(
    random: Random, kind: str, names: Sequence[str] | None, source: Twins, *, unlogged: bool
) -> tuple[Twin, ...]:
    if kind == "null":
        return ()
    pool = _pool(names, source, unlogged=unlogged)
    first = pool[int(random.integers(len(pool)))]
    if kind != "pair":
        return (first,)
    others = [e for e in pool if first.goes_with(e)]
    if not others:
        raise ValueError(
            f"nothing to pair {first.name} with: the others fill the same place, or act by the "
            "motion that it changes"
        )
    return first, others[int(random.integers(len(others)))]


def _pool(names: Sequence[str] | None, source: Twins, *, unlogged: bool) -> list[Twin]:
    pool = [source[n] for n in names or source if source[n].hidden or not unlogged]
    if not pool:
        raise ValueError("none of these effects hides a temperature or a fault's onset")
    return pool


def _crowded(
    seed: int, pool: Sequence[Twin], level: float | None, motion: str | None, colour: str | None,
    *, always: bool,
) -> CasePlan:  # fmt: skip
    random = stream(seed, "crowded")
    hidden, spare = crowd(random, pool)
    levels = crowd_levels(random, len(hidden) - 1, level)
    campaign = crowd_campaign(stream(seed, "campaign"))
    gains, zeros = scattered(stream(seed, "gains"), len(campaign.records))
    return CasePlan(
        seed, "crowded", hidden, (True,) * len(hidden), levels, campaign,
        draw_force_noise(stream(seed, "force noise"), colour),
        draw_motion_noise(stream(seed, "motion noise"), campaign, motion), gains, zeros,
        tuple((*hidden[k:], *hidden[:k]) for k in range(1, len(hidden))), spare,
    )  # fmt: skip


def _sparse(
    seed: int, pool: Sequence[Twin], level: float | None, motion: str | None, colour: str | None,
    *, always: bool,
) -> CasePlan:  # fmt: skip
    random = stream(seed, "sparse")
    order = sparse_order(random, pool, always=always or level is not None)
    wanted = sparse_level(random) if level is None else level
    hidden = order[:1]
    campaign = sparse_campaign(stream(seed, "campaign"))
    return CasePlan(
        seed, "sparse", hidden, (True,) * len(hidden), (wanted,) * len(hidden), campaign,
        draw_force_noise(stream(seed, "force noise"), colour),
        draw_motion_noise(stream(seed, "motion noise"), campaign, motion),
        (1.0,) * len(campaign.records), instead=tuple((twin,) for twin in order[1:]),
    )  # fmt: skip


def _level(random: Random, kind: str, concealment: str | None) -> float:
    """Below the noise nobody can tell what a stranger is, nor that a fit fails elsewhere."""
    low, high = BANDS[int(random.choice(len(BANDS), p=BAND_SHARES))]
    if kind == "pair":
        low, high = OF_A_PAIR
    elif kind == "unknown" or concealment == "absorbed":
        low, high = BANDS[-1]
    return float(np.exp(random.uniform(np.log(low), np.log(high))))
