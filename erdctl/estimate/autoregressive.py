"""The colour of a residual, as an autoregressive model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index


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
        for a, b in pairwise(starts.tolist()):
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
        """Rows (p, n) filtered so that their products are J' C J, C the noise's covariance."""
        if self.coefficients.size == 0:
            return rows * float(np.sqrt(self.innovation))
        from scipy.signal import lfilter

        denominator = np.concatenate([[1.0], -self.coefficients])
        parts = [
            lfilter([np.sqrt(self.innovation)], denominator, rows[:, a:b], axis=1)
            for a, b in pairwise(starts.tolist())
        ]
        return np.asarray(np.concatenate(parts, axis=1))
