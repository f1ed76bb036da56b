"""Lines of a measurement by hand, and which tables of it are asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping

import numpy as np


def show(head: str, *columns: object) -> None:
    print(f"{head:46}" + "".join(f"{c:>13}" for c in columns), flush=True)


def summed(name: str, found: Iterable[tuple[str, float]], target: float) -> None:
    """Median and largest of a column, and what misses the target."""
    rows = [*found]
    v = np.array([value for _, value in rows])
    over = [what for what, value in rows if value > target]
    print(
        f"  {name:40} median {np.median(v):.2e}, largest {v.max():.2e},",
        f"over {target:g}: {len(over)} of {len(v)}{': ' if over else ''}{'; '.join(over)}",
        flush=True,
    )


def tables(known: Mapping[str, Callable[..., None]]) -> None:
    """Those of the command line, or all: `name`, or `name:effect,effect` of some effects alone."""
    for asked in sys.argv[1:] or known:
        which, _, effects = asked.partition(":")
        known[which](*(effects.split(",") if effects else ()))
        print(flush=True)
