"""How well a model reproduces a recording: NRMSE and its splits, and the colour of the residual."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from erdctl.recording import DIRECTIONS, Array, Index, Recording

MAX_LEVELS = 24  # more distinct duty levels than that are a continuous control, and are binned
BIN = 0.05


class Normalise(str, Enum):
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


def duty_levels(duty: Array) -> Array:
    """(n,) PWM level of each sample: its duty to 0.01, or the middle of a bin of 0.05.

    A log with more than MAX_LEVELS distinct levels has a continuous control; 0 stays its own level.
    """
    rounded = np.round(duty, 2)
    if len(np.unique(rounded)) <= MAX_LEVELS:
        return rounded
    middle = (np.floor(np.minimum(duty, 1.0 - 1e-12) / BIN) + 0.5) * BIN
    return np.where(duty == 0.0, 0.0, np.round(middle, 3))


def validate(
    recording: Recording, modelled: Array, normalise: Normalise = Normalise.RANGE
) -> Validation:
    """Scores of a modelled force on a recording with a measured one."""
    force = recording.force
    if force is None:
        raise ValueError("the recording has no measured force")

    def score(chosen: Array | slice) -> Score:
        return nrmse(force[chosen], modelled[chosen], normalise)

    levels = duty_levels(recording.duty)
    by_duty = {float(v): score(levels == v) for v in np.unique(levels)}
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


@dataclass(frozen=True, eq=False)
class ColouredNoise:
    """An autoregressive model of a residual: r[i] = sum a[k] r[i-k] + e[i], e white.

    autocovariance : (m + 1,) sums over the samples of r[i] r[i+k], from which it is made
    """

    autocovariance: Array
    samples: int
    coefficients: Array
    innovation: float

    @classmethod
    def of(cls, residual: Array, starts: Index, max_order: int = 24) -> ColouredNoise:
        """Model of a residual (n,) [N] of several records (offsets `starts`)."""
        sums = np.zeros(max_order + 1)
        for a, b in zip(starts[:-1], starts[1:], strict=True):
            r = residual[a:b]
            for k in range(min(max_order + 1, len(r))):
                sums[k] += np.dot(r[: len(r) - k], r[k:])
        return cls._solve(sums, int(starts[-1]))

    @classmethod
    def pooled(cls, parts: Sequence[ColouredNoise]) -> ColouredNoise:
        """One model of several residuals."""
        total = np.sum([p.autocovariance for p in parts], axis=0)
        return cls._solve(total, sum(p.samples for p in parts))

    @classmethod
    def _solve(cls, sums: Array, samples: int) -> ColouredNoise:
        """Levinson-Durbin recursion, the order by Akaike's criterion."""
        gamma = sums / max(samples, 1)
        best = (np.empty(0), float(gamma[0]))
        if gamma[0] <= 0.0:
            return cls(sums, samples, best[0], 0.0)
        a, error = np.empty(0), float(gamma[0])
        best_cost = samples * np.log(error)
        for order in range(1, len(gamma)):
            reflection = (gamma[order] - float(np.dot(a, gamma[order - 1 : 0 : -1]))) / error
            if not abs(reflection) < 1.0:
                break
            a = np.concatenate([a - reflection * a[::-1], [reflection]])
            error *= 1.0 - reflection**2
            cost = samples * np.log(error) + 2.0 * order
            if cost < best_cost:
                best, best_cost = (a, error), cost
        return cls(sums, samples, *best)

    def colour(self, rows: Array, starts: Index) -> Array:
        """Rows (p, n) filtered so that their products sum to J' C J for this noise's covariance C."""
        if self.coefficients.size == 0:
            return rows * np.sqrt(self.innovation)
        from scipy.signal import lfilter

        denominator = np.concatenate([[1.0], -self.coefficients])
        parts = [
            lfilter([np.sqrt(self.innovation)], denominator, rows[:, a:b], axis=1)
            for a, b in zip(starts[:-1], starts[1:], strict=True)
        ]
        return np.concatenate(parts, axis=1)
