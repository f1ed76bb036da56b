"""One hypothesis against another, and several ranked, by cross-validated residuals.

Two are compared on the samples to which both give weight: where a force channel makes samples
doubtful for one of them, that one would be spared the worst.

Two tests stand side by side. That of log ratios (`Problem.t_statistics`) counts in how many places
one is better, whatever the size; that of energy (`energy.energy_test`) how much better it is, in
however few.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.energy import EnergyTest, critical_value, energy_columns, energy_test
from erdctl.diagnose.hypothesis import Hypothesis, weighed_as
from erdctl.diagnose.problem import Problem


@dataclass(frozen=True)
class Comparison:
    """How much better one hypothesis is than another on what neither has seen.

    gain : relative reduction of the cross-validated mean square
    t_stretches, t_groups : see `Problem.t_statistics`
    energy : the test of what the two predict differently
    size : root of the reduction over the range of the force
    before, after : the mean squares themselves [N^2]
    settling : mean square of the fits' residuals over all samples, those without weight too, over
        that of the worse one
    scatter : standard error of a mean square from as many groups, over itself
    apart : mean square of what the two fits differ by, over that of what the better one leaves
    few : whether the log has fewer records than can be left out whole
    """

    gain: float
    t_stretches: float
    t_groups: float
    energy: EnergyTest
    size: float
    before: float
    after: float
    settling: float
    scatter: float
    apart: float
    few: bool = False

    @property
    def significant(self) -> bool:
        """Whether the gain is beyond chance, and worth a name.

        What one record has of its own, a gain or a zero, is easily taken by a free parameter, of a
        richer form above all; so the gain must be as steady over records as noise lets it be. And
        a model must not pay for it where records settle, which no fit weighs: a drive does.
        """
        return self.beyond(0.0)

    def beyond(self, critical: float) -> bool:
        """The same, where the best of many was picked, see `energy.critical_value`."""
        if not (self.gain > thresholds.LEAST_GAIN and self.size > thresholds.ROUNDING):
            return False
        if self.pays:
            return False
        many = self.t_stretches > max(thresholds.T_STRETCHES, critical)
        if many and self.t_groups > thresholds.T_GROUPS:
            return self.energy.steady
        # What acts in few places leaves the others as they were; what makes many of them worse for
        # a large gain in some stands in for something else.
        elsewhere = self.t_stretches > thresholds.T_ELSEWHERE
        return elsewhere and self.energy.significant and self.energy.z > critical

    @property
    def pays(self) -> bool:
        """Whether the better one misses far more over all samples, so where nothing is weighed."""
        return self.settling > thresholds.PAYS

    @property
    def tied(self) -> bool:
        """Whether the two cannot be told apart: neither by places, nor by energy, nor by size.

        Nor can two fits that are one force on this log, whatever either loses where it is left out.
        Where they differ in a single place that may be anything which happened there. In a record
        or two the scatter over places is too small where the noise has a long memory: no records
        show it, and more than twice that is asked.
        """
        if min(self.gain, self.apart) < thresholds.LEAST_GAIN:
            return True
        several = self.energy.groups.places >= thresholds.LEAST_PLACES
        beyond = thresholds.Z_ENERGY if self.few else thresholds.T_TIE
        differ = self.t_stretches > beyond or (several and self.energy.z > beyond)
        return not (differ or self.gain > self.scatter)


def compare(problem: Problem, worse: Hypothesis, better: Hypothesis) -> Comparison:
    """The gain of one hypothesis over another."""
    weight = _common_weight(worse, better)
    common = replace(problem, block=problem.block._replace(weight=weight))
    t_stretches, t_groups = common.t_statistics(worse.cross_validated, better.cross_validated)
    before, after = _mean_square(worse, weight), _mean_square(better, weight)
    gain = (before - after) / before if before > 0.0 else 0.0
    size = float(np.sqrt(max(before - after, 0.0))) / float(np.ptp(problem.block.force))
    energy = energy_test(common, worse.cross_validated, better.cross_validated)
    scatter = float(np.sqrt(2.0 / problem.count))
    left = [float(np.mean(h.residual**2)) for h in (worse, better)]
    settling = left[1] / max(left[0], 1e-300)
    missed = (worse.residual - better.residual) ** 2, better.residual**2
    apart, rest = (float(np.dot(weight, m)) for m in missed)
    return Comparison(
        gain, t_stretches, t_groups, energy, size, before, after, settling, scatter,
        apart / max(rest, 1e-300), len(problem.recording.names) < thresholds.LEAST_RECORDS,
    )  # fmt: skip


def compare_alike(problem: Problem, worse: Hypothesis, better: Hypothesis) -> Comparison:
    """The same, with the worse one fitted to the samples that the better one is fitted to.

    A force channel makes samples doubtful where its model is uncertain; a fit that is spared them
    must not owe its gain to that: under a jittering clock they bend the other one's parameters.
    """
    weight = _common_weight(worse, better)
    if not np.array_equal(weight, worse.problem.block.weight):
        worse = weighed_as(worse, weight)
    return compare(problem, worse, better)


def critical_of(problem: Problem, worse: Hypothesis, others: Sequence[Hypothesis]) -> float:
    """The value that the largest statistic of some hypotheses over one exceeds by chance."""
    columns = []
    for other in others:
        weight = _common_weight(worse, other)
        common = replace(problem, block=problem.block._replace(weight=weight))
        columns += energy_columns(common, worse.cross_validated, other.cross_validated)
    return critical_value(np.array(columns)) if columns else 0.0


def is_better(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether one hypothesis ranks before another, see `ranked`."""
    return one.score < other.score


def ranked(hypotheses: Iterable[Hypothesis]) -> list[Hypothesis]:
    """The best first; of equal ones that with fewer parameters to search for.

    Each by its own samples, so that an effect of the force channel, which leaves doubtful samples
    without weight, comes early into the beam. That favours it; on common samples (three ways were
    tried) one real damper was predicted worse, or that effect was missed. The rank says which of
    several significant hypotheses comes first; whether one is significant, `compare` says.
    """
    return sorted(hypotheses, key=lambda h: (h.score, len(h.model.shape)))


def _common_weight(*hypotheses: Hypothesis) -> Array:
    """(n,) weight of samples for all of some hypotheses."""
    weights: Sequence[Array] = [h.problem.block.weight for h in hypotheses]
    return np.asarray(np.minimum.reduce(weights))


def _mean_square(hypothesis: Hypothesis, weight: Array) -> float:
    if not weight.any():
        return float(np.inf)  # the two have no sample in common: neither is the better
    return float(np.average(hypothesis.cross_validated**2, weights=weight))
