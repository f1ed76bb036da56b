"""How well a model reproduces a recording: NRMSE and its splits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from erdctl.core.cache import parts
from erdctl.core.recording import DIRECTIONS, Array, Index, Recording

MAX_LEVELS = 24  # more distinct duty levels than that are a continuous control, and are binned
BIN = 0.05

Codes = npt.NDArray[np.int16]


class Normalise(StrEnum):
    """Denominator of the NRMSE; the paper does not state its own."""

    RANGE = "range"
    STD = "std"
    MEAN = "mean"
    RMS = "rms"


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
    values = np.arange(101) / 100.0
    if np.count_nonzero(seen) > MAX_LEVELS:
        # Not from the rounded duty, which crosses the edges of the bins.
        percent[:] = np.floor(np.minimum(duty, 1.0 - 1e-12) / BIN) + 1
        percent[duty == 0.0] = 0
        values = np.round((np.arange(102) - 0.5) * BIN, 3)
        values[0] = 0.0
        seen = np.bincount(percent, minlength=102)
    present = np.flatnonzero(seen)
    code = np.zeros(len(seen), dtype=np.int16)
    code[present] = np.arange(len(present))
    return code[percent], values[present]


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
    force = recording.force

    def score(chosen: npt.NDArray[np.bool_] | slice) -> Score:
        return nrmse(force[chosen], modelled[chosen], normalise)

    codes, levels = duty_levels(recording.duty)
    by_duty = {v: score(codes == i) for i, v in enumerate(levels.tolist())}
    moving = {DIRECTIONS[0]: recording.xdot > 0, DIRECTIONS[1]: recording.xdot < 0}
    return Validation(
        normalise=normalise,
        overall=score(slice(None)),
        by_duty=by_duty,
        by_direction={name: score(m) for name, m in moving.items() if m.any()},
        by_record={
            name: score(part) for name, part in zip(recording.names, recording.slices, strict=True)
        },
    )
