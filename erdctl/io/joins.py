"""Runs that follow one another in a log without a column `record`, told apart by their joins."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.io.checks import Place

FEWEST = 8  # samples of a run; a time that falls earlier is a row out of order
NEAR = 0.02  # of a run's duration: how near to its own first time a new run begins
STEPS = 3.0  # or so many steps
SPEEDS = 25.0  # times the fastest motion elsewhere is no motion
_BLOCK = 1 << 16


def restarts(t: Array) -> Index | None:
    """Offsets of the runs whose times begin anew, or None where time falls in another way.

    t : (n,) [s]. A run begins where t falls to where the run before it began, or to 0, and grows
    from there on for at least FEWEST samples; all falls must be such.
    Check: 0 1 .. 9 0 1 .. 9 s are two runs; 0 1 2 1.5 3 .. s are none.
    >>> restarts(np.tile(np.arange(10.0), 2)).tolist()
    [0, 10, 20]
    >>> restarts(np.array([0.0, 1, 2, 1.5, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]))
    """
    falls = np.concatenate(
        [
            np.flatnonzero(np.diff(t[i : i + _BLOCK + 1]) < 0.0) + i + 1
            for i in range(0, t.size, _BLOCK)
        ]
    )
    if not falls.size:
        return None
    edges = t[falls - 1], t[falls]
    return restarts_at(falls, np.concatenate([t[:1], edges[1]]), np.append(edges[0], t[-1]), t.size)


def restarts_at(falls: Index, begins: Array, ends: Array, samples: int) -> Index | None:
    """The same from the times (r,) at which runs begin and end, where t falls (r - 1,)."""
    starts = np.concatenate([[0], falls, [samples]]).astype(np.intp)
    lengths = np.diff(starts)
    if lengths.min() < FEWEST:
        return None
    durations = ends - begins
    tolerances = np.maximum(NEAR * durations, STEPS * durations / (lengths - 1))
    new = begins[1:]
    away = np.minimum(np.abs(new - begins[:-1]), np.abs(new - begins[0]))
    if (np.minimum(away, np.abs(new)) > tolerances[:-1]).any():
        return None
    return starts


def suspected(t: Array, x: Array, starts: Index) -> tuple[int, float, float] | None:
    """Where two runs may be joined though time goes on: sample, jump [m], times the top speed.

    A place where x moves SPEEDS times faster than anywhere else for one step, and then goes on from
    there: what returns at once is a spike.
    """
    worst, speed = -1, 0.0
    with np.errstate(all="ignore"):
        for begin in range(0, t.size - 1, _BLOCK):
            part = slice(begin, min(begin + _BLOCK + 1, t.size))
            fast = np.abs(np.diff(x[part]) / np.diff(t[part]))
            inner = starts[(starts > part.start) & (starts < part.stop)] - part.start - 1
            fast[inner] = 0.0
            at = int(fast.argmax())
            if fast[at] > speed:
                worst, speed = begin + at + 1, float(fast[at])
    if worst < FEWEST or t.size - worst < FEWEST:
        return None
    near = slice(max(0, worst - _BLOCK), min(t.size, worst + _BLOCK))
    with np.errstate(all="ignore"):  # times that do not grow are found elsewhere
        rest = np.abs(np.diff(x[near]) / np.diff(t[near]))
    rest[worst - near.start - 1] = 0.0
    top = float(rest.max())
    if not 0.0 < top < speed / SPEEDS:
        return None
    return worst, float(x[worst] - x[worst - 1]), speed / top


def runs(
    t: Array, x: Array, starts: Index, stem: str, place: Place, say: Callable[[str], None]
) -> tuple[Index, tuple[str, ...]]:
    """Records by the joins of runs that follow one another, and names for them.

    A new start of time is clear and divides; a jump of x alone is said and divides nothing.
    """
    found = restarts(t)
    if found is not None:
        return found, names_of_runs(found, stem, place, say)
    place_of_join = suspected(t, x, starts)
    if place_of_join is not None:
        at, jump, times = place_of_join
        say(
            f"row {place.row_of(at)}: x jumps by {jump * 1e3:.4g} mm, {times:.0f} times as fast as"
            " anywhere else; if two runs were joined there, tell them apart in a column 'record'"
        )
    return starts, ()


def names_of_runs(
    starts: Index,
    stem: str,
    place: Place,
    say: Callable[[str], None],
    named: str = "a column 'record' would name them",
) -> tuple[str, ...]:
    """Names for runs told apart by their time, which is said; named : what names them."""
    names = tuple(f"{stem}:{i}" for i in range(1, len(starts)))
    rows = ", ".join(str(place.row_of(int(i))) for i in starts[1:-1][:5].tolist())
    more = "" if len(starts) <= 7 else ", ..."
    say(
        f"time begins anew in row {rows}{more}; taken as {len(names)} records, {names[0]} to"
        f" {names[-1]}; {named}"
    )
    return names
