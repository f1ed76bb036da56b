"""How well a model reproduces a recording: NRMSE and its splits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.core.cache import parts
from erdctl.core.recording import DIRECTIONS, Array, Index, Recording
from erdctl.core.stretches import Stretch, stretches
from erdctl.score.sums import GroupSums, by, none, over

MAX_LEVELS = 24  # more distinct duty levels than that are a continuous control, and are binned
BIN = 0.05
BINS = np.round((np.arange(102) - 0.5) * BIN, 3)
BINS[0] = 0.0

Codes = npt.NDArray[np.int16]


class Normalise(StrEnum):
    """Denominator of the NRMSE; the paper does not state its own."""

    RANGE = "range"
    STD = "std"
    MEAN = "mean"
    RMS = "rms"

    @property
    def words(self) -> str:
        """What it is of the measured force, in a sentence."""
        # The mean itself is about 0 of a force that goes both ways.
        return "mean size" if self is Normalise.MEAN else self.value


@dataclass(frozen=True)
class Score:
    """Misfit of one group of samples: number, root mean square [N] and NRMSE [1]."""

    samples: int
    rms: float
    nrmse: float


@dataclass(frozen=True)
class Validation:
    """Scores of a model on a recording, in the form of Table 3 and split further."""

    normalise: Normalise
    overall: Score
    by_duty: dict[float, Score]
    by_direction: dict[str, Score]
    by_record: dict[str, Score]

    @property
    def binned(self) -> bool:
        """Whether levels are the middles of bins, none of which is a whole percent."""
        return any(round(100 * level, 6) % 1 for level in self.by_duty)


def nrmse(force: Array, modelled: Array, normalise: Normalise = Normalise.RANGE) -> Score:
    """Root-mean-square error over a measure of the measured force.

    force, modelled : (n,) [N], n >= 1
    NRMSE is 0 for no error and infinite for an error on a force without range.
    Check: force 0, 2 and model 0, 0: rms = sqrt(2) = 1.41421, over the range 2 is 0.70711.
    >>> found = nrmse(np.array([0.0, 2.0]), np.zeros(2))
    >>> round(found.rms, 5), round(found.nrmse, 5)
    (1.41421, 0.70711)
    """
    error = force - modelled
    rms = float(np.sqrt(np.mean(error * error)))
    match normalise:
        case Normalise.RANGE:
            scale = float(force.max() - force.min())
        case Normalise.STD:
            scale = float(force.std())
        case Normalise.MEAN:
            scale = float(np.abs(force).mean())
        case Normalise.RMS:
            scale = float(np.sqrt(np.mean(force * force)))
    if scale == 0.0:
        return Score(len(force), rms, 0.0 if rms == 0.0 else float("inf"))
    return Score(len(force), rms, rms / scale)


def percents(duty: Array) -> tuple[Codes, Index]:
    """The duty of each sample in whole percent (n,), and how many samples have each (101,).

    Check: 0.3, 0, 0.302 is 30, 0, 30 percent, the 30 seen 2 times.
    >>> percent, seen = percents(np.array([0.3, 0.0, 0.302]))
    >>> percent.tolist(), int(seen[30])
    ([30, 0, 30], 2)
    """
    percent = np.empty(len(duty), dtype=np.int16)
    seen = np.zeros(101, dtype=np.intp)
    for part in parts(len(duty)):
        percent[part] = np.rint(duty[part] * 100.0)
        seen += np.bincount(percent[part], minlength=101)
    return percent, seen


def duty_levels(duty: Array) -> tuple[Codes, Array]:
    """Which PWM level each sample belongs to (n,), and the levels (k,) [1], ascending.

    A level is a duty to 0.01. A log with more than MAX_LEVELS of them has a continuous control: a
    level is then the middle of a bin of 0.05, and 0 stays a level of its own.
    Check: 0.3, 0, 0.302 gives levels 0, 0.3 and codes 1, 0, 1.
    >>> codes, levels = duty_levels(np.array([0.3, 0.0, 0.302]))
    >>> levels.tolist(), codes.tolist()
    ([0.0, 0.3], [1, 0, 1])
    """
    percent, seen = percents(duty)
    values, present = levels_of(seen)
    if present is None:
        percent = bins(duty)
        values, present = bins_of(np.bincount(percent, minlength=len(BINS)))
    code = np.zeros(len(BINS), dtype=np.int16)
    code[present] = np.arange(len(present))
    return code[percent], values


def levels_of(seen: npt.NDArray[Any]) -> tuple[Array, Index | None]:
    """Levels (k,) and which of the whole percents they are; None for a continuous control.

    seen : (101,) samples that have each
    """
    present = np.flatnonzero(seen)
    if len(present) > MAX_LEVELS:
        return np.empty(0), None
    return present / 100.0, present


def bins_of(seen: npt.NDArray[Any]) -> tuple[Array, Index]:
    """Middles (k,) of the bins that samples are in, and which they are."""
    present = np.flatnonzero(seen)
    return BINS[present], present


def bins(duty: Array) -> Codes:
    """(n,) the bin of 0.05 that each duty is in, from 1, of which BINS are the middles; 0 for 0.

    Check: 0 has 0, 0.10 to below 0.15 are in bin 3, 0.15 begins bin 4, and 1 is in the last, 20.
    >>> bins(np.array([0.0, 0.10, 0.1499, 0.15, 1.0])).tolist()
    [0, 3, 3, 4, 20]
    """
    # Not from the rounded duty, which crosses the edges of the bins; but 0.15 is one, and its
    # quotient is below 3 by the last digit.
    last = round(1.0 / BIN) - 1
    code = (np.minimum(np.floor(duty / BIN + 1e-9), last) + 1).astype(np.int16)
    code[duty == 0.0] = 0
    return code


class Scoring:
    """The scores of a modelled force over one stretch of a log after the other."""

    def __init__(self, normalise: Normalise = Normalise.RANGE) -> None:
        self.normalise = normalise
        self._all, self._ways = none(1), none(3)
        self._percents, self._bins = none(101), none(len(BINS))
        self._records: list[GroupSums] = []
        self._names: list[str] = []

    def add(self, stretch: Stretch, modelled: Array) -> None:
        """The next stretch and its modelled force (n,) [N]."""
        r = stretch.own
        if r.force is None:
            raise ValueError("the recording has no measured force")
        force, error = r.force, r.force - modelled
        whole = over(np.zeros(1, dtype=np.intp), force, error)
        # In pairs, which rounds less than one after the other.
        whole = whole._replace(squares=np.array([np.sum(error * error)]))
        self._all = self._all.added(np.zeros(1, dtype=np.intp), whole)
        way = np.int8(1) * (r.xdot > 0) + np.int8(2) * (r.xdot < 0)
        self._ways = self._ways.added(*by(way, force, error))
        self._percents = self._percents.added(*by(percents(r.duty)[0], force, error))
        self._bins = self._bins.added(*by(bins(r.duty), force, error))
        records, names = over(r.starts[:-1], force, error), r.names
        if stretch.begun:
            self._records[-1] = self._records[-1].added(
                np.array([len(self._records[-1].samples) - 1]), records
            )
            return
        self._records.append(records)
        self._names += names

    @property
    def peak(self) -> float:
        """The largest measured force, either way [N]."""
        return max(float(self._all.high[0]), -float(self._all.low[0]))

    def found(self) -> Validation:
        """The scores of all of it."""
        levels, present = levels_of(self._percents.samples)
        duties = self._percents
        if present is None:
            (levels, present), duties = bins_of(self._bins.samples), self._bins
        records = [s for part in self._records for s in self._scores(part)]
        ways = dict(zip(DIRECTIONS, self._scores(self._ways)[1:], strict=True))
        by_level = self._scores(duties)
        return Validation(
            normalise=self.normalise,
            overall=self._scores(self._all)[0],
            by_duty={v: by_level[i] for v, i in zip(levels.tolist(), present, strict=True)},
            by_direction={name: s for name, s in ways.items() if s.samples},
            by_record=dict(zip(self._names, records, strict=True)),
        )

    def _scores(self, sums: GroupSums) -> list[Score]:
        rms = np.sqrt(sums.squares / np.maximum(sums.samples, 1.0))
        match self.normalise:
            case Normalise.RANGE:
                scale = sums.high - sums.low
            case Normalise.STD:
                scale = np.sqrt(sums.spread / np.maximum(sums.samples, 1.0))
            case Normalise.MEAN:
                scale = sums.size / np.maximum(sums.samples, 1.0)
            case Normalise.RMS:
                scale = np.sqrt(sums.spread / np.maximum(sums.samples, 1.0) + sums.mean**2)
        return [
            Score(int(n), e, e / s if s != 0.0 else 0.0 if e == 0.0 else float("inf"))
            for n, e, s in zip(sums.samples.tolist(), rms.tolist(), scale.tolist(), strict=True)
        ]


def validate(
    recording: Recording, modelled: Array, normalise: Normalise = Normalise.RANGE
) -> Validation:
    """Scores of a modelled force on a recording with a measured one, where samples are usable."""
    if recording.force is None:
        raise ValueError("the recording has no measured force")
    if recording.excluded is not None:
        rows = np.flatnonzero(~recording.excluded)
        ends = np.searchsorted(rows, recording.starts)
        kept = np.flatnonzero(np.diff(ends))
        names = [recording.names[i] for i in kept]
        usable = recording.take(rows, np.append(ends[kept], ends[-1]), names)
        return validate(replace(usable, excluded=None), modelled[rows], normalise)
    tally = Scoring(normalise)
    for part in stretches(recording):
        tally.add(part, modelled[part.first : part.first + len(part)])
    return tally.found()
