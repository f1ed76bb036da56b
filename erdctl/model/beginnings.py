"""How records begin that begin in motion: as if it had gone on so before.

A state that follows the motion over a travel x_d remembers what was before the first sample. Where
the motion comes by its first place again in the same direction and at about the same speed, after
two reversals at least, it is taken to have done so before, with the state that it has then; where
it never does, or where the record begins at rest, the state begins as it is given.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals

ABOUT = 0.2  # of the highest speed in a record, by which the speed may differ there


def as_before(states: Callable[[Array], Array], steady: Array, s: Signals, x_d: float) -> Array:
    """(n,) states, within -1..1, of records that begin as the motion comes by that place again.

    states : (n,) of records that begin with given ones (r,), of which exp(-path / x_d) is kept
    steady : (r,) with which they begin where nothing else is known
    """
    z = states(steady)
    record, again, part, travel = _again(s)
    if not len(record):
        return z
    then = (1.0 - part) * z[again - 1] + part * z[again]
    kept = np.exp(-travel / x_d)  # of what it began with
    first = steady.copy()
    # Within bounds also where a step is long for x_d, and the line across it no exponential.
    first[record] = np.clip((then - kept * steady[record]) / (1.0 - kept), -1.0, 1.0)
    return states(first)


@lru_cache(maxsize=4)
def _again(s: Signals) -> tuple[Index, Index, Array, Array]:
    """Where records that begin in motion first come by their first place again, as they began.

    Returns (k,) the records, (k,) the samples behind that, (k,) parts of the step up to it, and
    (k,) distances travelled until then [m].
    """
    found = []
    turned, path = s.turns[0], s.path[0]
    for record, (a, b) in enumerate(pairwise(s.starts.tolist())):
        way, speed = np.sign(s.xdot[a]), s.xdot[a:b]
        turns = turned[(turned >= a) & (turned < b)] + 1
        if way == 0.0 or s.rests[record] or len(turns) < 2:
            continue
        ahead = way * (s.x[turns[1] : b] - s.x[a])
        along = way * s.xdot[turns[1] + 1 : b] > 0.0
        alike = np.abs(s.xdot[turns[1] + 1 : b] - s.xdot[a]) <= ABOUT * np.abs(speed).max()
        passed = np.flatnonzero((ahead[:-1] < 0.0) & (ahead[1:] >= 0.0) & along & alike)
        if len(passed):
            i = passed[0]
            part, before = ahead[i] / (ahead[i] - ahead[i + 1]), turns[1] + i
            travel = float(path[a:before].sum() + part * path[before])
            found.append((record, before + 1, part, travel))
    columns = np.array(found).reshape(-1, 4).T
    return columns[0].astype(np.intp), columns[1].astype(np.intp), columns[2], columns[3]
