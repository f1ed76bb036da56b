"""One strong effect among faint ones, in a rig whose records scatter: what a crowded case draws.

A real damper has more than one fault, and its records are not of one gain and one zero: between
them the cell is touched, the amplifier warms.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.plant.campaign import Campaign, draw_short
from erdctl.plant.noise import draw_gains
from erdctl.plant.twin import Twin

Random = np.random.Generator

STRONG = (4.0, 10.0)  # misfit over noise of the strong one alone
FAINT = (0.3, 1.5)  # and of each other
FEWEST, MOST = 2, 4  # faint ones
SAMPLES = (8_000, 20_000)
RECORDS = 8, 13
GAIN = 0.01  # scatter of the force's gain from record to record
ZERO = 0.004  # and of its zero, over the range of the force: 0.3 N of a model car's 75 N


def crowd_campaign(random: Random) -> Campaign:
    """8 to 13 records of 8,000 to 20,000 samples in all."""
    samples = round(float(np.exp(random.uniform(*np.log(SAMPLES)))))
    return draw_short(
        random, samples=samples, count=int(random.integers(RECORDS[0], RECORDS[1] + 1))
    )


def crowd(random: Random, pool: Sequence[Twin]) -> tuple[tuple[Twin, ...], tuple[Twin, ...]]:
    """Effects that one damper can have together, the strong one first, and others to spare.

    No two of one family: that is what fills one place, or is the same at the rod. So faint, some
    would live next to reversals only, as no real one does; another takes the place of such a one.
    """
    count = int(random.integers(FEWEST, MOST + 1))
    order = [pool[i] for i in random.permutation(len(pool))]
    chosen: list[Twin] = []
    for twin in order:
        if len(chosen) <= count and all(twin.goes_with(c) for c in chosen):
            chosen.append(twin)
    if len(chosen) <= FEWEST:
        raise ValueError(
            f"no crowd among {', '.join(t.name for t in pool)}: a strong effect and {FEWEST} faint "
            "ones are needed that one damper can have together"
        )
    return tuple(chosen), tuple(t for t in order if t not in chosen)


def crowd_levels(random: Random, count: int, strong: float | None) -> tuple[float, ...]:
    """Wanted misfit over noise of each; `strong` if one was asked for."""
    first = _between(random, STRONG)
    return (first if strong is None else strong, *(_between(random, FAINT) for _ in range(count)))


def scattered(random: Random, count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Gain of each record, and its zero over the range of the force."""
    gains = draw_gains(random, count, GAIN)
    return gains, tuple(float(z) for z in ZERO * random.standard_normal(count))


def _between(random: Random, ends: tuple[float, float]) -> float:
    return float(np.exp(random.uniform(*np.log(ends))))
