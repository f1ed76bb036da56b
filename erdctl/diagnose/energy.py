"""The energy test: does what one hypothesis predicts otherwise lie in what the other one misses?

    d = e_1 - e_2,   u = sum w d e_1,   p = sum w d^2,   slope = u / p,   z = u / sqrt(var u)

e_1, e_2 : (n,) cross-validated residuals of two hypotheses [N], so d is the difference of what they
predict of samples that neither has seen;  w : weights

If the first is right, d is noise of a fit that has not seen e_1, and u is 0 on average; if the
second is, the slope is 1. This is the test of forecast encompassing, of which the reduction of the
square, 2 u - p, is a part. It is as strong in a single place as in all together: only noise is in
the variance, taken from the rest e_1 - slope d as its autocovariance, or as the sums over stretches
where those scatter more. Because a misfit that one record has alone would pass for noise of the
right size elsewhere, the slope must also be the same in the groups, and in the records, in which
the two differ (a t statistic over clusters with as many degrees of freedom as there are places).

Source: D. I. Harvey, S. J. Leybourne, P. Newbold, J. Business and Economic Statistics 16 (1998)
254-259; clusters: C. A. Carter, K. T. Schnepel, D. G. Steigerwald, Rev. Econ. Stat. 99 (2017).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.estimate.autoregressive import ColouredNoise


@dataclass(frozen=True)
class Clusters:
    """A slope over clusters: its t statistic, and the effective number of clusters."""

    t: float
    places: float


@dataclass(frozen=True)
class EnergyTest:
    """z over noise, the slope, and its steadiness over groups and over records.

    over_noise : gives z, which takes longer than all else and is often not asked for
    """

    over_noise: Callable[[], float] = field(compare=False, repr=False)
    slope: float
    groups: Clusters
    records: Clusters

    @cached_property
    def z(self) -> float:
        """The sum u over its standard error."""
        return self.over_noise()

    @property
    def significant(self) -> bool:
        """Whether one is better beyond chance, in however few places."""
        return (
            self.groups.places >= thresholds.LEAST_PLACES
            and self.groups.t > thresholds.T_PLACES
            and self.z > thresholds.Z_ENERGY
            and self.steady
        )

    @property
    def steady(self) -> bool:
        """Whether the slope is the same in the records, as far as noise lets it be.

        (z / t)^2 is the scatter of the records over that of the noise, which is about chi^2 / k,
        with k = places - 1, if they are alike. Where they are not, t itself must be large.
        """
        records, freedom = self.records, self.records.places - 1.0
        if records.places < thresholds.LEAST_PLACES or records.t > thresholds.T_PLACES:
            return True
        if records.t <= 0.0:
            return False
        from scipy.special import chdtri

        most = float(chdtri(freedom, thresholds.UNLIKE_RECORDS)) / freedom
        return self.z**2 < most * records.t**2


def energy_test(problem: Problem, worse: Array, better: Array) -> EnergyTest:
    """The test of two cross-validated residuals (n,) [N], on the problem's weights."""
    weight, starts = problem.block.weight, problem.block.signals.starts
    d = worse - better
    u, p = weight * d * worse, weight * d * d
    power = float(p.sum())
    if not power > 0.0:
        return EnergyTest(float, 0.0, Clusters(0.0, 0.0), Clusters(0.0, 0.0))
    slope = float(u.sum()) / power
    record = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    over_noise = partial(_over_noise, problem, worse, better, slope)
    return EnergyTest(over_noise, slope, _clusters(u, p, problem.group), _clusters(u, p, record))


def _over_noise(problem: Problem, worse: Array, better: Array, slope: float) -> float:
    """z, with the variance of what the slope leaves."""
    weight, starts = problem.block.weight, problem.block.signals.starts
    d = worse - better
    rest = worse - slope * d
    noise = ColouredNoise.of(rest * np.sqrt(weight), starts, used=weight > 0.0)
    flat = noise.innovation * float(np.sum(noise.colour((weight * d)[None], starts) ** 2))
    uneven = float(np.sum(np.bincount(problem.stretch, weight * d * rest) ** 2))
    return float(np.dot(weight * d, worse)) / float(np.sqrt(max(flat, uneven, 1e-300)))


def energy_columns(problem: Problem, worse: Array, better: Array) -> list[Array]:
    """(k,) log ratios of squares, and (k,) sums of u, of all stretches: what both tests rest on."""
    d = worse - better
    (before, weight), (after, _) = (problem.per_stretch(r**2) for r in (worse, better))
    use = (before > 0) & (after > 0) & (weight > 0)
    ratio = np.where(use, np.log(np.where(use, before, 1.0) / np.where(use, after, 1.0)), 0.0)
    return [ratio, np.bincount(problem.stretch, problem.block.weight * d * worse)]


def critical_value(columns: Array) -> float:
    """The value that the largest of some statistics (m, k), k stretches, exceeds by chance.

        max_c  sum_s e_s a_cs / sqrt(sum_s a_cs^2),   e_s = +-1 at random, the same for all c

    If nothing is there, each stretch is as likely to speak for as against, and the signs of all
    candidates turn over together, as they see the same noise: so alike ones count as one, and a
    catalogue of 300 asks for more than one of 30, by what it holds.

    Source: J. P. Romano, M. Wolf, Econometrica 73 (2005) 1237-1282, of the maximum statistic.
    """
    size = np.sqrt(np.einsum("ms,ms->m", columns, columns))
    unit = columns[size > 0] / size[size > 0, None]
    if not len(unit):
        return 0.0
    rng = np.random.default_rng(0)
    signs = rng.choice([-1.0, 1.0], (thresholds.FLIPS, unit.shape[1]))
    largest = (signs @ unit.T).max(axis=1)
    return float(np.quantile(largest, 1.0 - thresholds.FALSE_ALARMS))


def _clusters(u: Array, p: Array, of: Index) -> Clusters:
    """The slope's t statistic over clusters, those counted by how much the two differ in them."""
    sums, power = np.bincount(of, u), np.bincount(of, p)
    total = float(power.sum())
    places = total**2 / float(np.sum(power**2))
    slope = float(sums.sum()) / total
    if places <= 1.0:
        return Clusters(0.0, places)
    scatter = float(np.sum((sums - slope * power) ** 2)) * places / (places - 1.0)
    return Clusters(slope * total / float(np.sqrt(max(scatter, 1e-300))), places)
