"""Work on long channels in parts that fit into a processor's cache."""

from __future__ import annotations

from collections.abc import Iterator

PART = 1 << 16  # samples that fit with a few that are computed of each


def parts(samples: int) -> Iterator[slice]:
    """So many samples in parts: whole temporaries cost more in memory than in arithmetic.

    Check: 100,000 samples are the parts 0 to 65536 and 65536 to 100000.
    >>> [(p.start, p.stop) for p in parts(100_000)]
    [(0, 65536), (65536, 100000)]
    """
    for first in range(0, samples, PART):
        yield slice(first, min(first + PART, samples))
