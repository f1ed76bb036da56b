"""Record effects: gain and zero of the force that vary from record to record, carried, not named.

    F = g_r m + o_r + noise,   mean g_r = 1,   mean o_r = 0

m : force of the model with shared parameters [N];  g_r, o_r : of record r [1], [N]
Alternating least squares: the model is fitted to (F - o_r) / g_r, then gains and offsets to F. What
the records share stays with the model: a common gain with its amplitudes, a common offset with its
constant forces. Each value is shrunk to the mean by what its error is against the variance of all
(empirical Bayes), and a record that does not determine it keeps the mean.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.normal_equations import SINGULAR
from erdctl.estimate.own_levels import OwnLevels


@dataclass(frozen=True)
class Varying:
    """What may differ from record to record."""

    gain: bool = False
    offset: bool = False

    def __bool__(self) -> bool:
        return self.gain or self.offset


NONE_VARY = Varying()


@dataclass(frozen=True, eq=False)
class RecordEffects:
    """Gain (r,) [1] and offset (r,) [N] of the force in each record, with standard errors.

    An error is infinite where a record does not determine the value.
    """

    gain: Array
    offset: Array
    gain_error: Array
    offset_error: Array

    @classmethod
    def none(cls, records: int) -> RecordEffects:
        """Gain 1 and offset 0 in every record."""
        unknown = np.full(records, np.inf)
        return cls(np.ones(records), np.zeros(records), unknown, unknown)

    def along(self, starts: Index) -> tuple[Array, Array]:
        """(n,) gain and offset of each sample."""
        lengths = np.diff(starts)
        return np.repeat(self.gain, lengths), np.repeat(self.offset, lengths)

    def shared(self, block: Block) -> Block:
        """What the shared model is fitted to: the force less record effects, noise as it was."""
        gain, offset = self.along(block.signals.starts)
        return Block(block.signals, (block.force - offset) / gain, block.weight * gain**2)

    def settled(self, before: RecordEffects) -> bool:
        """Whether it has moved by less than matters."""
        pairs = (
            (self.gain - before.gain, self.gain_error),
            (self.offset - before.offset, self.offset_error),
        )
        return all(
            bool((np.abs(move) <= thresholds.RECORD_SETTLED * error).all()) for move, error in pairs
        )

    def levels(self, free: Varying) -> OwnLevels:
        """The same as the last step of a fit takes it."""
        kinds = tuple(k for k, is_free in enumerate((free.gain, free.offset)) if is_free)
        values, errors = (self.gain - 1.0, self.offset), (self.gain_error, self.offset_error)
        return OwnLevels(kinds, *(np.array([of[k] for k in kinds]) for of in (values, errors)))

    def with_errors(self, free: Varying, errors: Array) -> RecordEffects:
        """With the errors (k, r) that they have beside the shared parameters, relative to a gain.

        What the records share is fitted to their force less offset, over gain.
        """
        new = iter(errors * self.gain)
        unknown = np.full(len(self.gain), np.inf)
        gain = next(new) if free.gain else unknown
        return replace(self, gain_error=gain, offset_error=next(new) if free.offset else unknown)


def estimate(free: Varying, block: Block, modelled: Array, last: RecordEffects) -> RecordEffects:
    """Record effects between a measured and a modelled force (n,) [N]; errors are of noise alone.

    last : those before, for the colour of the noise
    """
    weight, starts = block.weight, block.signals.starts
    gain, offset = last.along(starts)
    rest = (block.force - offset - gain * modelled) * np.sqrt(weight)
    noise = ColouredNoise.of(rest, starts, used=weight > 0.0)
    rows = np.array([modelled, np.ones_like(modelled)])[[free.gain, free.offset]]
    weighted = rows * weight
    coloured = noise.colour(weighted, starts) * np.sqrt(noise.innovation)
    target = block.force - np.where(free.gain, 0.0, modelled)
    normal = _per_record(weighted[:, None] * rows[None], starts)
    right = _per_record(weighted * target, starts)
    meat = _per_record(coloured[:, None] * coloured[None], starts)
    value, error = np.zeros((2, *right.shape))
    for r in range(len(starts) - 1):
        value[:, r], error[:, r] = _solved(normal[:, :, r], right[:, r], meat[:, :, r])
    out = RecordEffects.none(len(starts) - 1)
    new_gain, new_offset, errors = out.gain, out.offset, [out.gain_error, out.offset_error]
    if free.gain:
        new_gain = np.maximum(1.0 + shrunk(value[0], error[0]), thresholds.LEAST_RECORD_GAIN)
        errors[0] = error[0]
    if free.offset:
        left = block.force - np.repeat(new_gain, np.diff(starts)) * modelled
        mass = _per_record(weight, starts)
        value[-1] = _per_record(weight * left, starts) / np.where(mass > 0, mass, 1.0)
        new_offset, errors[1] = shrunk(value[-1], error[-1]), error[-1]
    return RecordEffects(new_gain, new_offset, *errors)


def _per_record(values: Array, starts: Index) -> Array:
    """(..., r) sums of (..., n) values over each record."""
    return np.asarray(np.add.reduceat(values, starts[:-1], axis=-1))


def _solved(normal: Array, right: Array, meat: Array) -> tuple[Array, Array]:
    """Least squares of one record and standard errors; infinite where it determines nothing."""
    scale = np.sqrt(np.diag(normal))
    if not (scale > 0).all() or np.linalg.cond(normal / np.outer(scale, scale)) > 1 / SINGULAR:
        return np.zeros(len(right)), np.full(len(right), np.inf)
    inverse = np.linalg.inv(normal)
    return inverse @ right, np.sqrt(np.diag(inverse @ meat @ inverse))


def shrunk(value: Array, error: Array) -> Array:
    """(r,) deviations from the mean, shrunk to 0 by their errors (r,); they add up to 0.

        d = tau^2 / (tau^2 + e^2) (v - mu),   sum (v - mu)^2 / (tau^2 + e^2) = r - 1

    tau : standard deviation beyond the errors (Paule and Mandel 1982), 0 if there is none
    mu : mean, weighted as the sum is
    Check: v = 1, 3, e = 1, 1: sum = 2 / (tau^2 + 1) = 1, tau = 1, d = -0.5, 0.5.
    >>> shrunk(np.array([1.0, 3.0]), np.ones(2)).round(4).tolist()
    [-0.5, 0.5]
    """
    known = np.isfinite(error)
    out = np.zeros_like(value)
    v, square = value[known], error[known] ** 2
    if len(v) < 2:
        return out

    def spread(tau2: float) -> tuple[float, float]:
        weight = 1.0 / np.maximum(tau2 + square, 1e-300)
        mean = float(np.average(v, weights=weight))
        return float(np.dot(weight, (v - mean) ** 2)), mean

    most = float(np.sum((v - v.mean()) ** 2))
    if most == 0.0 or spread(0.0)[0] <= len(v) - 1:
        return out
    from scipy.optimize import brentq

    tau2 = float(brentq(lambda tau2: spread(tau2)[0] - (len(v) - 1), 0.0, most))
    out[known] = tau2 / (tau2 + square) * (v - spread(tau2)[1])
    return out
