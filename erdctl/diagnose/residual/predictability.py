"""What is left in a residual that motion and control can still predict: its value, or its size.

Measurement noise, white or coloured, can neither be predicted from motion and control nor is it
louder in some states of the damper than in others; physics left out is one or the other. So what a
flexible regression predicts of the residual on stretches that it has not seen is misfit, and so is
what makes the residual louder than it is in its quietest states, whatever the form and whether or
not the catalogue knows it. Two kinds of physics keep a time of their own, and are looked for by
themselves: a ripple of the yield force, and sudden jumps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.diagnose.problem import Problem, t_statistic
from erdctl.diagnose.residual.impulses import impulse_share
from erdctl.diagnose.residual.spectral_line import SpectralLine, spectral_line

FOLDS = 5
MOST = 12_000  # samples that a regression learns from
REAL = 3.5  # how many times its scatter a difference must be, over stretches of a second
T_GROUPS = 1.5  # the same, over groups
CONTRAST = 3.0  # the same, of the loudness of one state of the damper against another
TAILS = 1.1  # times the scale of the middle half of a residual
QUIET = 0.2  # part of the samples, those where the least is to be expected, that shows the noise
VARIANCE_RATIO = 1.2  # times the noise that the loud half must be at least


@dataclass(frozen=True, eq=False)
class LackOfFit:
    """The misfit in a residual.

    predicted : (n,) the part whose value is predicted, by regressions that have not seen it [N]
    excess : (n,) mean square beyond noise, predicted or only expected in size [N^2]
    noise_rms, misfit_rms : of what is noise, and of the rest [N];  real : whether there is a rest
    hint : whether there is a sign of a rest, real or not, that makes a further search worth while
    ripple : the line that turns over with the motion, if the rest holds one
    jumps : the share of the rest's square that sudden jumps hold, if there are any
    """

    predicted: Array
    excess: Array
    noise_rms: float
    misfit_rms: float
    significant: bool
    hint: bool
    spectral_line: SpectralLine | None
    impulses: float


def lack_of_fit_test(problem: Problem, residual: Array, seed: int = 0) -> LackOfFit:
    """The misfit in a residual (n,) [N]."""
    rng = np.random.default_rng(seed)
    s, weight = problem.block.signals, problem.block.weight
    inputs, since = features(s)
    # Slow states (heat, wear, sediment) show over time or travel, which a regression must not have
    # from next door: noise has a memory too. So those are left out by groups, and states of motion
    # by stretches.
    splits = (
        (np.column_stack([inputs, since]), problem.group),
        (inputs, problem.stretch),
    )
    predicted = np.zeros_like(residual)
    best, hint = 0.0, _heavy_tailed(residual[weight > 0])
    for columns, group in splits:
        found = _predicted(problem, columns, group, residual, rng)
        hint = hint or found.hint
        if found.significant and found.share > best:
            predicted, best = found.values, found.share
    rest = residual - predicted
    total = float(problem.weight_of.sum())
    square = float(np.dot(weight, residual**2)) / total
    expected, noise = _variance(problem, splits[0][0], rest, rng)
    line = spectral_line(problem, rest)
    left = float(np.dot(weight, rest**2)) / total
    excess = predicted**2 + np.maximum(expected - noise, 0.0)
    if line is not None:
        excess += line.share * left
        left *= 1.0 - line.share
    impulses = impulse_share(problem, rest)
    excess += impulses * left
    left *= 1.0 - impulses
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
    )


def _heavy_tailed(residual: Array) -> bool:
    """Whether a residual has rare large values, as an effect leaves that acts in few places."""
    scale = 1.4826 * float(np.median(np.abs(residual))) if residual.size else 0.0
    return float(np.sqrt(np.mean(residual**2))) > TAILS * scale if scale > 0.0 else False


@dataclass(frozen=True, eq=False)
class _Prediction:
    """The part of a residual that was predicted (n,), its share of the square, and its weight."""

    values: Array
    share: float
    t_stretches: float
    t_groups: float

    @property
    def significant(self) -> bool:
        return self.share > 0.01 and self.t_stretches > REAL and self.t_groups > T_GROUPS

    @property
    def hint(self) -> bool:
        return self.share > 0.003 and self.t_stretches > 1.0


def _predicted(
    problem: Problem, inputs: Array, group: Index, residual: Array, rng: np.random.Generator
) -> _Prediction:
    """The predicted part of a residual (n,)."""
    weight = problem.block.weight
    predicted = _regression(weight, inputs, group, residual, rng)
    # A regression also learns noise; scaled by what holds on unseen groups, that costs nothing.
    cross, power = np.dot(weight, residual * predicted), np.dot(weight, predicted**2)
    predicted *= float(np.clip(cross / max(power, 1e-300), 0.0, 1.0))
    t_stretches, t_groups = problem.t_statistics(residual, residual - predicted)
    before, after = (np.dot(weight, r**2) for r in (residual, residual - predicted))
    return _Prediction(predicted, 1.0 - float(after / max(before, 1e-300)), t_stretches, t_groups)


def _variance(
    problem: Problem, inputs: Array, rest: Array, rng: np.random.Generator
) -> tuple[Array, float]:
    """The mean square to be expected at each sample (n,), and that of the noise alone.

    A regression of the logarithm of the square tells where it is large; how large, is the mean over
    samples of which about the same is expected, that the regression has not seen.
    """
    weight, square = problem.block.weight, rest**2
    mean = float(np.dot(weight, square) / weight.sum())
    even = np.full_like(rest, mean)
    if mean <= 0.0:
        return even, mean
    order = _regression(weight, inputs, problem.group, np.log(square + 1e-3 * mean), rng)
    use = weight > 0
    edges = np.quantile(order[use], np.linspace(0, 1, round(1 / QUIET) + 1)[1:-1])
    cell = np.searchsorted(edges, order)
    count = np.bincount(cell, weight, len(edges) + 1)
    level = np.bincount(cell, square * weight, len(edges) + 1) / np.maximum(count, 1e-300)
    middle = float(np.median(order[use]))
    ratio = []
    for g in range(problem.count):
        inside = (problem.group == g) & use
        lower, upper = inside & (order <= middle), inside & (order > middle)
        if min(np.count_nonzero(lower), np.count_nonzero(upper)) > 20:
            ratio.append(float(np.log(square[upper].mean() / max(square[lower].mean(), 1e-300))))
    contrast = np.array(ratio)
    if (
        len(ratio) < 3
        or t_statistic(contrast) <= CONTRAST
        or contrast.mean() < 2.0 * np.log(VARIANCE_RATIO)
    ):
        return even, mean
    return level[cell], float(level[0])


def _regression(
    weight: Array, inputs: Array, group: Index, target: Array, rng: np.random.Generator
) -> Array:
    """(n,) target as predicted from inputs (n, m) by regressions that have not seen its group."""
    from sklearn.ensemble import HistGradientBoostingRegressor
    from threadpoolctl import threadpool_limits

    count = int(group.max()) + 1
    fold = (rng.permutation(count) % min(FOLDS, count))[group]
    used = np.flatnonzero(weight > 0)
    keep = used[:: max(1, len(used) // MOST)]
    out = np.zeros_like(target)
    for k in range(int(fold.max()) + 1):
        learn, tell = keep[fold[keep] != k], np.flatnonzero(fold == k)
        machine = HistGradientBoostingRegressor(
            max_iter=60, learning_rate=0.12, max_leaf_nodes=24, min_samples_leaf=60,
            l2_regularization=10.0, early_stopping=False, random_state=0,
        )  # fmt: skip
        # Its threads wait for each other in busy loops: on a shared machine that takes minutes.
        with threadpool_limits(1):
            machine.fit(inputs[learn], target[learn])
            out[tell] = machine.predict(inputs[tell])
    return out


def features(s: Signals) -> tuple[Array, Array]:
    """(n, m) motion, control and a little past; (n, 2) time and distance travelled in the record.

    All that a damper's force may depend on, as far as it is in a log.
    """
    step = s.typical_step or 1.0
    past = [max(1, round(lag / step)) for lag in (0.01, 0.05)]
    start = np.repeat(s.starts[:-1], np.diff(s.starts))
    index = np.arange(len(s))
    columns = [
        s.x, s.xdot, s.xddot, s.duty, s.sign,
        np.minimum(s.since_reversal, 10.0), np.minimum(s.since_duty_step, 10.0),
        np.minimum(s.path_since_reversal, 1.0), s.sign * np.sqrt(s.duty),
    ]  # fmt: skip
    for lag in past:
        before = np.maximum(index - lag, start)
        columns += [s.xdot[before], s.duty[before]]
    total = np.concatenate([[0.0], np.cumsum(s.path[0][:-1])])
    slow = [s.t - s.t[start], total - total[start]]
    return np.column_stack(columns), np.column_stack(slow)
