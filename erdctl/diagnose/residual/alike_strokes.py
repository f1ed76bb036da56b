"""Strokes that are alike in their motion and their duty, and which of them differ in their force.

They are held against each other a third of their way after the other, and the ones in a row whose
force differs most from that of all others are found. What a stroke has of its force it has of its
past and not of where it ends, so that they are alike as far as the shortest of them goes.

In a random motion no strokes are alike. There all are one group, and those in a row are apart only
where their motion and their duty lie among those of the others, so that no law of these tells them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, product

import numpy as np
import numpy.typing as npt
from scipy.stats import t as student

from erdctl.bench.strokes import Strokes, strokes
from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis


@dataclass(frozen=True, eq=False)
class AlikeStrokes:
    """Strokes of one record and direction that are alike, or of both that are not.

    thirds : (k, 4) samples at which the thirds of their way begin, and its end
    part : (k, 3) their force beyond the model's, over it;  beyond : (k,) mean of that [N]
    settling : whether the first of them is the first one of the record
    motion, duty : (k, m) what they differ in, if they are not alike, see `groups`
    """

    record: int
    compression: bool | None
    thirds: Index
    part: Array
    beyond: Array
    settling: bool
    motion: Array
    duty: Array

    @property
    def alike(self) -> bool:
        """Whether their motion is one."""
        return self.compression is not None

    def split(self) -> Split:
        """Those in a row whose force is most unlike that of the others.

        A change within a stroke is in a part of it: one such stroke at either end is passed over
        where the others are far more apart so.
        """
        i, j = self._farther(*self._ends())
        k, at = len(self.part), np.arange(len(self.part))
        inside = (at >= i) & (at < j)
        begins = (-1, i - 1, i) if i > 0 else (-1,)
        ends = (-1, j - 1, j) if j < k else (-1,)
        sure = [(at != b) & (at != e) for b, e in product(begins, ends)]
        some = [Split(self, inside & these, ~inside & these) for these in sure]
        apart = [split for split in some if split.enough() and split.apart.any()]
        return max(apart, key=Split.worth, default=some[0])

    def _ends(self) -> tuple[int, int]:
        """Ends of those in a row whose own mean leaves the least."""
        k, fewest = len(self.part), thresholds.UNLOGGED_FEWEST
        part = self.part - self.part.mean(axis=0)
        sums = np.vstack([np.zeros(thresholds.UNLOGGED_PARTS), np.cumsum(part, axis=0)])
        taken, ends = 0.0, (k - fewest, k)
        for i in range(int(self.settling), k):
            j = np.arange(i + fewest, min(k, k - fewest + i) + 1)
            # Their sum is that of the others with the other sign, since the mean of all is 0.
            own = np.sum((sums[j] - sums[i]) ** 2, axis=1) * (1.0 / (j - i) + 1.0 / (k - j + i))
            if len(j) and own.max() > taken:
                taken, ends = float(own.max()), (i, int(j[own.argmax()]))
        return ends

    def _farther(self, i: int, j: int) -> tuple[int, int]:
        """Those in a row or, where they end with the record or begin it, the others, whichever is
        farther from the model, which is that of all strokes.
        """
        k = len(self.part)
        if i == 0:
            other = j, k
        elif j == k and not self.settling:
            other = 0, i
        else:
            return i, j
        return max((i, j), other, key=lambda e: float(np.mean(self.part[slice(*e)] ** 2)))


@dataclass(frozen=True, eq=False)
class Split:
    """Strokes (k,) that have a force of their own, and others; the rest is in part of either."""

    of: AlikeStrokes
    own: npt.NDArray[np.bool_]
    others: npt.NDArray[np.bool_]

    def enough(self) -> bool:
        """Whether either are enough: one more of those that are not alike."""
        fewest = thresholds.UNLOGGED_FEWEST + (not self.of.alike)
        return bool(min(np.count_nonzero(self.own), np.count_nonzero(self.others)) >= fewest)

    @cached_property
    def apart(self) -> npt.NDArray[np.bool_]:
        """(3,) in which thirds all of the ones are beyond all others, by more than any two
        neighbours among them differ; in none where a law of their motion can be why.
        """
        if not self._of_like_motion():
            return np.zeros(thresholds.UNLOGGED_PARTS, np.bool_)
        a, b = self.of.part[self.own], self.of.part[self.others]
        gap = np.maximum(a.min(axis=0) - b.max(axis=0), b.min(axis=0) - a.max(axis=0))
        steps = np.sort(np.diff(np.sort(np.vstack([a, b]), axis=0), axis=0), axis=0)
        return np.asarray((gap >= steps[-1]) & (gap > thresholds.UNLOGGED_GAP * steps[-2]))

    @property
    def returns(self) -> bool:
        """Whether there are others before those with a force of their own and behind."""
        at = np.flatnonzero(self.own)
        return bool(self.others[: at[0]].any() and self.others[at[-1] :].any())

    def _of_like_motion(self) -> bool:
        """Whether no law of the motion or of the duty holds the ones apart from the others.

        The middle one of either lies among the others in all that their motion differs in; of one
        that grows or quickens, and is no other before and behind, it need not be so of the others:
        a law of it would have to come and go at once. And most have the duty of some other, or some
        others have duties between theirs.
        """
        if self.of.alike:
            return True
        own, others = (self.of.motion[which] for which in (self.own, self.others))
        among = _among(own, others) and (self.returns or _among(others, own))
        duty = self.of.duty[self.own][:, None], self.of.duty[self.others]
        nearest = np.abs(duty[0] - duty[1]).max(axis=2).min(axis=1)
        level, other = (self.of.duty[which].mean(axis=1) for which in (self.own, self.others))
        between = int(np.count_nonzero((other > level.min()) & (other < level.max())))
        met = bool(np.median(nearest) < thresholds.ONE_DUTY)
        return among and (met or between >= thresholds.UNLOGGED_FEWEST)

    @cached_property
    def shift(self) -> Array:
        """(3,) force of the ones beyond that of the others, over it."""
        part = self.of.part
        return np.asarray(part[self.own].mean(axis=0) - part[self.others].mean(axis=0))

    @property
    def degrees(self) -> int:
        """Of freedom that two means leave."""
        return int(np.count_nonzero(self.own | self.others)) - 2

    @cached_property
    def scatter(self) -> Array:
        """(3,) standard deviation of the ones and of the others about their means."""
        rest = (self.of.part[which] for which in (self.own, self.others))
        square = sum(np.sum((r - r.mean(axis=0)) ** 2, axis=0) for r in rest)
        return np.asarray(np.sqrt(square / max(self.degrees, 1)))

    def over(self, usual: Array | float = 0.0) -> Array:
        """(3,) shift over its error, by their own scatter or a usual one that is larger; 0 where
        they are not apart by what matters.
        """
        counts = np.count_nonzero(self.own), np.count_nonzero(self.others)
        error = np.maximum(self.scatter, usual) * np.sqrt(1.0 / counts[0] + 1.0 / counts[1])
        large = self.apart & (np.abs(self.shift) >= thresholds.UNLOGGED_PART)
        return np.asarray(np.where(large, np.abs(self.shift), 0.0) / np.maximum(error, 1e-300))

    def worth(self) -> float:
        """How far apart they are, less for each stroke that is passed over."""
        passed = np.count_nonzero(~(self.own | self.others))
        return float(self.over().max()) / thresholds.UNLOGGED_EDGE**passed

    def seldom(self, usual: Array, degrees: int, tried: float) -> bool:
        """Whether they are apart by more than chance would ever make them."""
        over = self.over(usual)
        much = np.abs(self.shift) >= thresholds.UNLOGGED_PART_ALONE
        alone = bool((over[much] >= thresholds.UNLOGGED_ALONE).any())
        clear = alone or np.sort(over)[-2] >= thresholds.UNLOGGED_SIGMAS
        chance = 2.0 * float(student.sf(over.max(), degrees))
        return self.enough() and bool(clear) and tried * chance < thresholds.UNLOGGED_CHANCE


def groups(best: Hypothesis, force: Array) -> Iterator[AlikeStrokes]:
    """The strokes of each record that are alike in where they begin, their speed, their duty and
    that of the stroke before, each in parts of the record's range; and all others, if enough.
    """
    recording = best.problem.recording
    found = strokes(recording)
    if not len(found):
        return
    duty = np.column_stack([found.highest(recording.duty), found.lowest(recording.duty)])
    way = found.highest(recording.x) - found.lowest(recording.x)
    motion = _motion(recording, found)
    parts = thresholds.UNLOGGED_BEGIN, thresholds.UNLOGGED_ALIKE
    levels = np.hstack([duty, np.roll(duty, 1, axis=0)]) / thresholds.ONE_DUTY
    features = np.hstack([motion / parts, levels])
    for record in range(len(recording.names)):
        begun = int(np.searchsorted(found.record, record))
        for own, compression in _sorted(found, record, features):
            alike = compression is not None
            own = own[way[own] > thresholds.UNLOGGED_WAY * np.median(way[own])]
            if len(own) < _fewest(alike=alike):  # strokes of one sample go no way
                continue
            ways = np.full(len(own), way[own].min()) if alike else way[own]
            ends = [_thirds(recording, found, k, w) for k, w in zip(own, ways, strict=True)]
            part = np.array([_part(best, force, at) for at in ends])
            kept = np.isfinite(part).all(axis=1)
            if np.count_nonzero(kept) < _fewest(alike=alike):
                continue
            own, thirds = own[kept], np.array(ends)[kept]
            yield AlikeStrokes(
                record=record,
                compression=compression,
                thirds=thirds,
                part=part[kept],
                beyond=np.array([best.residual[a[0] : a[-1]].mean() for a in thirds]),
                settling=bool(own[0] == begun),
                motion=np.column_stack([motion[own], way[own]]),
                duty=duty[own],
            )


def _among(ones: Array, others: Array) -> bool:
    """Whether the middle one of (k, m) lies among (l, m) in all."""
    middle = np.median(ones, axis=0)
    return bool(((others.min(axis=0) <= middle) & (middle <= others.max(axis=0))).all())


def _sorted(
    found: Strokes, record: int, features: Array
) -> Iterator[tuple[Index, bool | None]]:  # fmt: skip
    """Strokes of a record that are alike, group by group, with their direction, and at last those
    of either direction that are like too few.
    """
    rest = [np.empty(0, dtype=np.intp)]
    for compression in (True, False):
        left = np.flatnonzero((found.record == record) & (found.compression == compression))
        while len(left):
            apart = np.abs(features[left] - features[left[len(left) // 2]]).max(axis=1)
            own = left[apart < 1.0]
            left = np.setdiff1d(left, own)
            if len(own) >= _fewest(alike=True):
                yield own, compression
            else:
                rest.append(own)
    unlike = np.sort(np.concatenate(rest))
    if len(unlike) >= _fewest(alike=False):
        yield unlike, None


def _fewest(*, alike: bool) -> int:
    """Strokes of a group."""
    return 2 * thresholds.UNLOGGED_FEWEST + 1 if alike else thresholds.UNLOGGED_UNLIKE


def _motion(recording: Recording, found: Strokes) -> Array:
    """(k, 2) where strokes begin and their speed, in parts of their record's range."""
    x, speed = recording.x, np.abs(recording.xdot)
    first = recording.starts[:-1]
    span = np.maximum.reduceat(x, first) - np.minimum.reduceat(x, first)
    fastest = np.maximum.reduceat(speed, first)
    span, fastest = (np.maximum(v, 1e-300)[found.record] for v in (span, fastest))
    begin = np.where(found.compression, found.lowest(x), -found.highest(x))
    return np.column_stack([begin / span, found.highest(speed) / fastest])


def _thirds(recording: Recording, found: Strokes, k: int, way: float) -> list[int]:
    """Samples at which the thirds of a way [m] begin in a stroke, and at which it ends."""
    a, b = int(found.first[k]), int(found.end[k])
    x = recording.x[a:b]
    gone = np.maximum.accumulate(np.abs(x - x[0]))
    at = np.searchsorted(gone, np.linspace(0.0, way, thresholds.UNLOGGED_PARTS + 1)[1:])
    return [a, *np.minimum(a + at, b).tolist()]


def _part(best: Hypothesis, force: Array, thirds: list[int]) -> list[float]:
    """(3,) force of a stroke beyond the model's, over it, by thirds of its way; nan if not told."""
    out = []
    for a, b in pairwise(thirds):
        w, m = best.problem.block.weight[a:b], force[a:b]
        power = float(np.dot(w, m * m))
        told = np.count_nonzero(w) >= thresholds.UNLOGGED_SAMPLES and power > 0.0
        out.append(float(np.dot(w, best.residual[a:b] * m)) / power if told else np.nan)
    return out
