"""The colour of a residual, as an autoregressive model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class ColouredNoise:
    """An autoregressive model of a residual: r[i] = sum a[k] r[i-k] + e[i], e white.

    autocovariance : (m + 1,) sums of r[i] r[i+k], from which it is made
    pairs : (m + 1,) how many samples are in each sum
    """

    autocovariance: Array
    pairs: Array
    coefficients: Array
    innovation: float

    @classmethod
    def of(
        cls, residual: Array, starts: Index, max_order: int = 24, used: Flags | None = None
    ) -> ColouredNoise:
        """Model of a residual (n,) [N] of several records (offsets `starts`).

        used : (n,) samples that count; the residual is 0 elsewhere
        """
        r = _apart(residual, starts, max_order)
        c = (
            None
            if used is None or used.all()
            else _apart(used.astype(np.float64), starts, max_order)
        )
        lags = range(max_order + 1)
        sums = np.array([np.dot(r[: len(r) - k], r[k:]) for k in lags])
        if c is None:
            length = np.diff(starts)
            pairs = np.array([np.maximum(length - k, 0).sum() for k in lags], dtype=np.float64)
        else:
            pairs = np.array([np.dot(c[: len(c) - k], c[k:]) for k in lags])
        return cls._solve(sums, pairs)

    @classmethod
    def pooled(cls, parts: Sequence[ColouredNoise]) -> ColouredNoise:
        """One model of several residuals."""
        total = np.sum([p.autocovariance for p in parts], axis=0)
        return cls._solve(total, np.sum([p.pairs for p in parts], axis=0))

    @classmethod
    def _solve(cls, sums: Array, pairs: Array) -> ColouredNoise:
        """Levinson-Durbin recursion, the order by Akaike's criterion."""
        gamma, samples = sums / np.maximum(pairs, 1.0), float(pairs[0])
        best = (np.empty(0), float(gamma[0]))
        if gamma[0] <= 0.0:
            return cls(sums, pairs, best[0], 0.0)
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
        return cls(sums, pairs, *best)

    def innovations(self, residual: Array, starts: Index) -> Array:
        """(n,) what is new in each sample of a residual (n,): e of the model."""
        if self.coefficients.size == 0:
            return residual
        from scipy.signal import lfilter

        whitening = np.concatenate([[1.0], -self.coefficients])
        parts = [lfilter(whitening, [1.0], residual[a:b]) for a, b in pairwise(starts.tolist())]
        return np.asarray(np.concatenate(parts))

    def colour(self, rows: Array, starts: Index) -> Array:
        """Rows (p, n) filtered so that J' C J is their product once each sample is multiplied by
        the standard deviation of its innovation, C the noise's covariance.

        C = H D H' with the causal filter H and D of these squares; H' runs backwards in time.
        """
        if self.coefficients.size == 0:
            return np.array(rows)
        from scipy.signal import lfilter

        denominator = np.concatenate([[1.0], -self.coefficients])
        parts = [
            lfilter([1.0], denominator, rows[:, a:b][:, ::-1], axis=1)[:, ::-1]
            for a, b in pairwise(starts.tolist())
        ]
        return np.asarray(np.concatenate(parts, axis=1))


def _apart(values: Array, starts: Index, gap: int) -> Array:
    """Values (n,) of several records with so many zeros after each that none meets the next."""
    record = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    out = np.zeros(len(values) + gap * (len(starts) - 1))
    out[np.arange(len(values)) + gap * record] = values
    return out
