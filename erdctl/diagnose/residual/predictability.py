"""Lack of fit: what motion and control still predict of a residual, its value or its variance.

Measurement noise, white or coloured, cannot be predicted from motion and control, and its variance
does not depend on the state of the damper; physics left out changes one or the other. So what a
flexible regression predicts of the residual on groups that it has not seen is misfit, and so is
variance beyond that of the states where it is smallest, or of other records, whatever the form and
whether or not the catalogue knows it. Some physics keeps a phase of its own, and is looked for by
itself: a ripple of the yield force (a spectral line), teeth of one length (a line over travel), and
impulses.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem, t_statistic
from erdctl.diagnose.residual.impulses import impulse_share
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.loud_parts import loud_parts
from erdctl.diagnose.residual.record_levels import records_apart
from erdctl.diagnose.residual.regression import cross_predicted, features
from erdctl.diagnose.residual.spectral_line import spectral_lines
from erdctl.diagnose.residual.travel_line import travel_line


# Search, look-alikes and laws ask in turn for the same few.
@lru_cache(maxsize=8)
def lack_of_fit_of(hypothesis: Hypothesis, seed: int = 0) -> LackOfFit:
    """The misfit in what a hypothesis leaves."""
    problem, residual = hypothesis.problem, hypothesis.residual
    if apart := records_apart(hypothesis):
        scatter, own = apart
        return _of_records(scatter, lack_of_fit_test(problem, own.residual, seed), own, residual)
    first = _predicted_by_groups(hypothesis, seed)
    return lack_of_fit_test(problem, residual, seed, first)


def _of_records(scatter: float, within: LackOfFit, own: Hypothesis, residual: Array) -> LackOfFit:
    """The misfit within records, and that between them."""
    levels, weight = residual - own.residual, own.problem.block.weight
    between = float(np.average(levels**2, weights=weight))
    return replace(
        within,
        predicted=within.predicted + levels,
        excess=within.excess + levels**2,
        misfit_rms=float(np.sqrt(within.misfit_rms**2 + between)),
        significant=True,
        hint=True,
        records=scatter,
    )


def misfit_is_left(hypothesis: Hypothesis, seed: int = 0) -> bool:
    """`lack_of_fit_of(...).significant`, which the first of its regressions mostly settles."""
    return (
        _predicted_by_groups(hypothesis, seed).significant
        or lack_of_fit_of(hypothesis, seed).significant
    )


def search_is_worthwhile(hypothesis: Hypothesis, seed: int = 0) -> bool:
    """`lack_of_fit_of(...).hint`, as far as needed to say so."""
    weight = hypothesis.problem.block.weight
    return (
        _heavy_tailed(hypothesis.residual[weight > 0])
        or _predicted_by_groups(hypothesis, seed).hint
        or lack_of_fit_of(hypothesis, seed).hint
    )


def lack_of_fit_test(
    problem: Problem, residual: Array, seed: int = 0, first: _Prediction | None = None
) -> LackOfFit:
    """The misfit in a residual (n,) [N].

    first : what the first of the regressions has predicted, where that is known
    """
    by_groups, by_stretches, by_variance = _seeds(seed)
    s, weight = problem.block.signals, problem.block.weight
    inputs, since = features(s)
    everything = np.column_stack([inputs, since])
    # Slow states (heat, wear, sediment) show over time or travel, which a regression must not have
    # from next door: noise has a memory too. So those are left out by groups, and states of motion
    # by stretches.
    predictions = (
        first or _predicted(problem, everything, problem.group, residual, by_groups),
        _predicted(problem, inputs, problem.stretch, residual, by_stretches),
    )
    predicted = np.zeros_like(residual)
    measures: dict[str, float] = {}
    best, hint = 0.0, _heavy_tailed(residual[weight > 0])
    for found in predictions:
        hint = hint or found.hint
        if found.t_stretches > measures.get("T_PREDICTED", 0.0):
            measures |= {
                "T_PREDICTED": found.t_stretches, "T_PREDICTED_GROUPS": found.t_groups,
                "SHARE_PREDICTED": found.share,
            }  # fmt: skip
        if found.significant and found.share > best:
            predicted, best = found.values, found.share
    rest = residual - predicted
    total = float(problem.weight_of.sum())
    square = float(np.dot(weight, residual**2)) / total
    beyond, noise = _variance(problem, everything, rest, by_variance, measures)
    line, hum = spectral_lines(problem, rest)
    left = float(np.dot(weight, rest**2)) / total
    quick = _third_differences(rest, s.starts)
    pieces = np.append(np.flatnonzero(np.diff(problem.stretch, prepend=-1)), len(rest))
    loud, quiet = loud_parts(rest, quick, weight, s.starts, thresholds.LOUD)
    once, calm = loud_parts(rest, quick, weight, pieces, thresholds.LOUD_STRETCH)
    for alone, least in ((loud, quiet), (once, calm)):
        noise = min(noise, least) if alone.any() else noise  # the same, but for its last digits
    excess = predicted**2 + np.maximum(beyond, np.maximum(loud, once))
    part = 0.0 if line is None else line.share
    impulses = impulse_share(problem, rest)
    # A line in time is one over travel, too, where the speed is the same throughout.
    teeth = travel_line(problem, rest) if line is None and hum is None else None
    swings = 1.0 - (1.0 - part) * (1.0 - impulses) * (1.0 - (teeth.share if teeth else 0.0))
    excess += swings * rest**2  # it is where the rest is large
    left *= 1.0 - swings
    noise = min(noise, left)
    misfit = max(square - noise, 0.0)
    return LackOfFit(
        predicted=predicted,
        excess=excess,
        noise_rms=float(np.sqrt(noise)),
        misfit_rms=float(np.sqrt(misfit)),
        significant=misfit > 0.0,
        hint=hint or misfit > 0.0,
        spectral_line=line,
        impulses=impulses,
        hum=hum,
        travel_line=teeth,
        loud=loud,
        measures=measures,
    )


def _heavy_tailed(residual: Array) -> bool:
    """Whether a residual has rare large values, as an effect leaves that acts in few places."""
    scale = 1.4826 * float(np.median(np.abs(residual))) if residual.size else 0.0
    return (
        float(np.sqrt(np.mean(residual**2))) > thresholds.HEAVY_TAILS * scale
        if scale > 0.0
        else False
    )


@dataclass(frozen=True, eq=False)
class _Prediction:
    """The predicted part of a residual (n,), its share of the square, and t statistics of that."""

    values: Array
    share: float
    t_stretches: float
    t_groups: float

    @property
    def significant(self) -> bool:
        t = (
            self.t_stretches > thresholds.T_PREDICTED
            and self.t_groups > thresholds.T_PREDICTED_GROUPS
        )
        return t and self.share > thresholds.SHARE_PREDICTED

    @property
    def hint(self) -> bool:
        return self.share > thresholds.SHARE_HINT and self.t_stretches > thresholds.T_HINT


@lru_cache(maxsize=8)
def _predicted_by_groups(hypothesis: Hypothesis, seed: int) -> _Prediction:
    """The first regression of `lack_of_fit_test`."""
    problem = hypothesis.problem
    columns = np.column_stack(features(problem.block.signals))
    return _predicted(problem, columns, problem.group, hypothesis.residual, _seeds(seed)[0])


def _seeds(seed: int) -> list[int]:
    """Of the folds of each regression."""
    rng = np.random.default_rng(seed)
    return [int(rng.integers(2**31)) for _ in range(3)]


def _predicted(
    problem: Problem, inputs: Array, group: Index, residual: Array, seed: int
) -> _Prediction:
    """The predicted part of a residual (n,)."""
    weight = problem.block.weight
    predicted = cross_predicted(weight, inputs, group, residual, seed)
    # A regression also learns noise; scaled by what holds on unseen groups, that costs nothing.
    cross, power = np.dot(weight, residual * predicted), np.dot(weight, predicted**2)
    predicted *= float(np.clip(cross / max(power, 1e-300), 0.0, 1.0))
    t_stretches, t_groups = problem.t_statistics(residual, residual - predicted)
    before, after = (np.dot(weight, r**2) for r in (residual, residual - predicted))
    return _Prediction(predicted, 1.0 - float(after / max(before, 1e-300)), t_stretches, t_groups)


def _variance(
    problem: Problem,
    inputs: Array,
    rest: Array,
    seed: int,
    measures: dict[str, float],
) -> tuple[Array, float]:
    """The mean square beyond noise to be expected at each sample (n,), and the noise's own.

    A regression of the logarithm of the square tells where it is large; how large, is the mean over
    samples of which about the same is expected, that the regression has not seen. Noise that grows
    with the force, say, is large there from one sample to the next as well, and misfit is not: it
    lasts. So noise is taken to grow as third differences do.
    measures : receives the statistics
    """
    weight, square = problem.block.weight, rest**2
    mean = float(np.dot(weight, square) / weight.sum())
    nothing = np.zeros_like(rest)
    if mean <= 0.0:
        return nothing, mean
    logarithm = np.log(square + thresholds.LOG_FLOOR * mean)
    order = cross_predicted(weight, inputs, problem.group, logarithm, seed)
    use = weight > 0
    cells = round(1 / thresholds.NOISE_PART)
    edges = np.quantile(order[use], np.linspace(0, 1, cells + 1)[1:-1])
    cell = np.searchsorted(edges, order)
    middle = float(np.median(order[use]))
    quick = _third_differences(rest, problem.block.signals.starts)
    quick[~use] = np.nan
    ratios, grown = [], []
    for g in range(problem.count):
        inside = (problem.group == g) & use
        lower, upper = inside & (order <= middle), inside & (order > middle)
        if min(np.count_nonzero(lower), np.count_nonzero(upper)) > thresholds.STATE_SAMPLES:
            ratios.append(float(np.log(square[upper].mean() / max(square[lower].mean(), 1e-300))))
            grown.append(_growth(quick[upper], quick[lower]))
    if len(ratios) < thresholds.STATE_GROUPS:
        return nothing, mean
    ratio = np.array(ratios) - np.maximum(np.mean(grown), 0.0)
    measures["T_VARIANCE"] = t_statistic(ratio)
    measures["VARIANCE_RATIO"] = float(np.exp(ratio.mean() / 2.0))
    if measures["T_VARIANCE"] <= thresholds.T_VARIANCE or ratio.mean() < 2.0 * np.log(
        thresholds.VARIANCE_RATIO
    ):
        return nothing, mean
    count = np.bincount(cell, weight, cells)
    level = np.bincount(cell, square * weight, cells) / np.maximum(count, 1e-300)
    growth = [_growth(quick[use & (cell == c)], quick[use & (cell == 0)]) for c in range(cells)]
    noise = np.minimum(level, level[0] * np.exp(np.maximum(growth, 0.0)))
    return (level - noise)[cell], float(np.dot(weight, noise[cell]) / weight.sum())


def _third_differences(values: Array, starts: Index) -> Array:
    """(n,) squares of third differences of (n,) values, nan where they would span two records."""
    out = np.full_like(values, np.nan)
    out[1:-2] = np.diff(values, 3) ** 2
    for a in starts.tolist():
        out[max(a - 2, 0) : a + 1] = np.nan
    return out


def _growth(upper: Array, lower: Array) -> float:
    """Logarithm of the ratio of the medians of two samples, which a few jumps do not change."""
    if np.isnan(upper).all() or np.isnan(lower).all():
        return 0.0
    above, below = float(np.nanmedian(upper)), float(np.nanmedian(lower))
    return float(np.log(above / below)) if above > 0.0 and below > 0.0 else 0.0
