"""Logs that show little: one to three short records, one duty or two, one speed or a few.

Such logs are what there is when a damper is looked at for the first time. Many laws are one on
them, and what may be said is little.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from erdctl.plant.campaign import (
    Campaign,
    CampaignRecord,
    DutyProgramme,
    Rating,
    draw_motion,
)
from erdctl.plant.trajectory import Trajectory
from erdctl.plant.twin import Twin

Random = np.random.Generator

SAMPLES = (3_000, 8_000)
MOST_RECORDS = 3
RATES = (100.0, 200.0, 250.0)  # Hz
HIDDEN = 2 / 3  # of the cases; in the others there is nothing
LEVELS = (1.0, 10.0)  # misfit over noise
CYCLES = 4  # of the slowest motion, in a record


def sparse_campaign(random: Random) -> Campaign:
    """The campaign."""
    rate = float(random.choice(RATES))
    total = float(np.exp(random.uniform(*np.log(SAMPLES))))
    count = int(random.integers(1, MOST_RECORDS + 1))
    n = round(total / count)
    low = max(float(np.exp(random.uniform(np.log(0.3), np.log(1.0)))), CYCLES * rate / n)
    high = max(rate / float(random.uniform(50, 80)), 1.5 * low)
    stroke = float(np.exp(random.uniform(np.log(0.008), np.log(0.06))))
    rating = Rating(stroke, 2 * np.pi * float(np.sqrt(low * high)) * stroke)
    reach_x, reach_v = float(random.uniform(0.5, 1.0)), float(random.uniform(0.5, 1.0))

    def drawn() -> Trajectory:
        return draw_motion(random, rating, n / rate, low, high, reach_x, reach_v)

    if random.random() < 0.5:  # one speed
        one = drawn()
        while len(one.frequencies) > 1:
            one = drawn()
        phases = random.uniform(0, 2 * np.pi, count)
        motions = [replace(one, phases=(float(p),)) for p in phases]
    else:
        motions = [drawn() for _ in range(count)]
    duties = _duties(random, count, n, rate)
    levels = tuple(sorted({level for d in duties for level in d.levels}))
    records = tuple(
        CampaignRecord(f"r{i + 1:02d}", rate, n, motion, duty)
        for i, (motion, duty) in enumerate(zip(motions, duties, strict=True))
    )
    top = levels[-1] or 1.0  # a damper has its field also where no record shows it
    return Campaign(rating, rate, low, high, reach_x, reach_v, top, levels, records)


def _duties(random: Random, count: int, n: int, rate: float) -> list[DutyProgramme]:
    """One duty throughout, or two: by record, or in turns within each."""
    first = 0.0 if random.random() < 0.2 else round(float(random.uniform(0.15, 1.0)), 3)
    if random.random() < 0.5:
        return [DutyProgramme((first,), (0,))] * count
    other = round(float(random.uniform(0.15, 1.0)), 3)
    both = (first, 0.0 if first and random.random() < 0.5 else other)
    if count > 1 and random.random() < 0.5:
        return [DutyProgramme((both[i % 2],), (0,)) for i in range(count)]
    hold = float(np.exp(random.uniform(np.log(0.3), np.log(3.0))))
    starts = tuple(range(0, n, round(hold * rate)))
    return [DutyProgramme(tuple(both[k % 2] for k in range(len(starts))), starts)] * count


def sparse_order(random: Random, pool: Sequence[Twin], *, always: bool) -> tuple[Twin, ...]:
    """What to hide, in the order in which it is tried: a campaign that shows so little may not
    show the first at all. () for nothing."""
    hides = random.random() < HIDDEN
    order = tuple(pool[i] for i in random.permutation(len(pool)))
    return order if hides or always else ()


def sparse_level(random: Random) -> float:
    """Wanted misfit over noise."""
    return float(np.exp(random.uniform(*np.log(LEVELS))))
