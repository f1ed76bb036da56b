"""Strokes whose force is another one by the same motion and the same duty.

Motion and control cannot tell them apart, so that no regression finds them and no law is true of
them: what they have of their own counts as noise. But a log in which the same stroke under the same
duty has one force at some times and another at others lacks what made the difference: a setting
that was turned, a supply that sagged, a temperature.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from erdctl.core.messages import plain
from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.residual.alike_strokes import Split, groups
from erdctl.diagnose.residual.localisation import Region, said
from erdctl.model.effect import Variable


@dataclass(frozen=True, eq=False)
class Unlogged:
    """Strokes of a record with a force of their own.

    record : its number;  compression : their direction, None for both
    begin, end : of the first and the last [s]
    count, others : how many they are, and how many are like them but for the force
    returns : whether there are others before them and behind
    part : (3,) force of theirs beyond that of the others, over it, by thirds of the way [1]
    scatter : of the others and of theirs among themselves [1]
    rows, change : samples of theirs (k,), and what is their own of the force there [N]
    """

    record: int
    compression: bool | None
    begin: float
    end: float
    count: int
    others: int
    returns: bool
    part: Array
    scatter: float
    rows: Index
    change: Array

    @property
    def way(self) -> str:
        """Their direction in words."""
        return {True: "compression", False: "release", None: "both directions"}[self.compression]


def unlogged(best: Hypothesis, *, stays: bool = True) -> tuple[Unlogged, ...]:
    """All of them, in the order of the log; stays : also those behind which no others are."""
    force = best.model.force(best.problem.block.signals, best.values)
    splits = [g.split() for g in groups(best, force)]
    out = []
    for alike in (True, False):
        own = [s for s in splits if s.of.alike == alike]
        out += [_of(best, s, force) for s in _seldom(own) if not _is_a_zero(s, splits)]
    out.sort(key=lambda u: int(u.rows[0]))
    return tuple(u for u in out if stays or u.returns)


def _seldom(own: Sequence[Split]) -> Iterator[Split]:
    """Those of some splits that chance does not make; what the others scatter by is the least."""
    if not own:
        return
    usual = np.median([s.scatter for s in own], axis=0)
    degrees = sum(s.degrees for s in own)
    tried = thresholds.UNLOGGED_PARTS * sum(len(s.own) ** 2 / 2.0 for s in own)
    yield from (s for s in own if s.seldom(usual, degrees, tried))


def _is_a_zero(s: Split, splits: Sequence[Split]) -> bool:
    """Whether the strokes the other way in that time have as much more force, not more damping.

    A zero that wanders does that, and noise with a long memory. What acts in the damper turns over
    with the motion, or acts one way.
    """
    if s.of.compression is None:  # both ways, which a zero makes unlike
        return False
    first, end = (int(s.of.thirds[s.own].ravel()[at]) for at in (0, -1))
    own = s.of.beyond[s.own].mean() - s.of.beyond[s.others].mean()
    for other in splits:
        if other.of.record != s.of.record or other.of.compression is not (not s.of.compression):
            continue
        inside = (other.of.thirds[:, -1] > first) & (other.of.thirds[:, 0] < end)
        if inside.any() and not inside.all():
            there = other.of.beyond[inside].mean() - other.of.beyond[~inside].mean()
            if there * own > thresholds.UNLOGGED_ZERO * own**2:
                return True
    return False


def without(recording: Recording, told: Sequence[Unlogged]) -> Recording:
    """The recording, of which fits and scores leave these strokes out."""
    if not told:
        return recording
    known = recording.excluded
    out = np.zeros(len(recording), np.bool_) if known is None else known.copy()
    for strokes_apart in told:
        out[strokes_apart.rows] = True
    return replace(recording, excluded=out)


def regions(told: Sequence[Unlogged], best: Hypothesis, misfit: float) -> list[Region]:
    """Where they are, those with most of the misfit first.

    best : what is fitted to all others, with a misfit [N rms] of its own
    """
    own = [float(np.dot(u.change, u.change)) for u in told]
    samples = len(best.residual)
    total = sum(own) + misfit**2 * (samples - sum(len(u.rows) for u in told))
    found = []
    for u, square in zip(told, own, strict=True):
        share, time = square / max(total, 1e-300), len(u.rows) / samples
        name = best.problem.recording.names[u.record]
        where = f"in {u.way} from {plain(u.begin, 4)} to {plain(u.end, 4)} s in record {name!r}"
        text = said(share, time, f"{where}, where the log does not tell why")
        found.append(Region(Variable.TIME, u.begin, u.end, share, time, text))
    return sorted(found, key=lambda r: -r.share)[: thresholds.REGIONS]


def _of(best: Hypothesis, s: Split, force: Array) -> Unlogged:
    t, at = best.problem.recording.t, np.flatnonzero(s.own)
    # With those that are changed in part.
    in_part = np.flatnonzero(~(s.own | s.others))
    at = np.union1d(at, in_part[(in_part >= at[0] - 1) & (in_part <= at[-1] + 1)])
    thirds, beyond = s.of.thirds[at], s.of.part[at] - s.of.part[s.others].mean(axis=0)
    # All the way from turn to turn, of which thirds are compared.
    way = best.problem.recording.xdot > 0.0
    turns = np.flatnonzero(np.diff(way, prepend=not way[0], append=not way[-1]))
    turns = np.union1d(turns, best.problem.recording.starts)
    begins = turns[np.searchsorted(turns, thirds[:, 0], "right") - 1]
    ends = turns[np.searchsorted(turns, thirds[:, -1] - 1, "right")]
    edges = np.column_stack([begins, thirds[:, 1:-1], ends])
    pieces = [np.arange(a, b) for one in edges for a, b in pairwise(one.tolist())]
    rows, part = np.concatenate(pieces), np.repeat(beyond.ravel(), [len(p) for p in pieces])
    if s.of.compression is None:  # with the short strokes between them
        whole = np.arange(rows[0], rows[-1] + 1)
        rows, part = whole, np.interp(whole, rows, part)
    return Unlogged(
        record=s.of.record,
        compression=s.of.compression,
        begin=float(t[edges[0, 0]]),
        end=float(t[edges[-1, -1] - 1]),
        count=len(at),
        others=int(np.count_nonzero(s.others)),
        returns=s.returns,
        part=s.shift,
        scatter=float(s.scatter.max()),
        rows=rows,
        change=part * force[rows],
    )
