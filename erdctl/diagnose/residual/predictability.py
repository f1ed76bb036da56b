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
from erdctl.diagnose.problem import Study, over_scatter
from erdctl.diagnose.residual.impulses import jumping
from erdctl.diagnose.residual.spectral_line import Ripple, ripple

FOLDS = 5
MOST = 12_000  # samples that a regression learns from
REAL = 3.5  # how many times its scatter a difference must be, over stretches of a second
STEADY = 1.5  # the same, over groups
CONTRAST = 3.0  # the same, of the loudness of one state of the damper against another
TAILS = 1.1  # times the scale of the middle half of a residual
QUIET = 0.2  # part of the samples, those where the least is to be expected, that shows the noise
LOUDER = 1.2  # times the noise that the loud half must be at least


@dataclass(frozen=True, eq=False)
class Remainder:
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
    real: bool
    hint: bool
    ripple: Ripple | None
    jumps: float


def examine(study: Study, residual: Array, seed: int = 0) -> Remainder:
    """The misfit in a residual (n,) [N]."""
    rng = np.random.default_rng(seed)
    s, weight = study.block.signals, study.block.weight
    inputs, since = features(s)
    # Slow states (heat, wear, sediment) show over time or travel, which a regression must not have
    # from next door: noise has a memory too. So those are left out by groups, and states of motion
    # by stretches.
    splits = (
        (np.column_stack([inputs, since]), study.group),
        (inputs, study.stretch),
    )
    predicted = np.zeros_like(residual)
    best, hint = 0.0, _tailed(residual[weight > 0])
    for columns, group in splits:
        told = _predicted(study, columns, group, residual, rng)
        hint = hint or told.hint
        if told.real and told.share > best:
            predicted, best = told.values, told.share
    rest = residual - predicted
    total = float(study.weight_of.sum())
    square = float(np.dot(weight, residual**2)) / total
    expected, noise = _expected(study, splits[0][0], rest, rng)
    swing = ripple(study, rest)
    left = float(np.dot(weight, rest**2)) / total
    excess = predicted**2 + np.maximum(expected - noise, 0.0)
    if swing is not None:
        excess += swing.share * left
        left *= 1.0 - swing.share
    jumps = jumping(study, rest)
    excess += jumps * left
    left *= 1.0 - jumps
    noise = min(noise, left)
    misfit = max(square - noise, 0.0)
    return Remainder(
        predicted=predicted,
        excess=excess,
        noise_rms=float(np.sqrt(noise)),
        misfit_rms=float(np.sqrt(misfit)),
        real=misfit > 0.0,
        hint=hint or misfit > 0.0,
        ripple=swing,
        jumps=jumps,
    )


def _tailed(residual: Array) -> bool:
    """Whether a residual has rare large values, as an effect leaves that acts in few places."""
    scale = 1.4826 * float(np.median(np.abs(residual))) if residual.size else 0.0
    return float(np.sqrt(np.mean(residual**2))) > TAILS * scale if scale > 0.0 else False


@dataclass(frozen=True, eq=False)
class _Told:
    """The part of a residual that was predicted (n,), its share of the square, and its weight."""

    values: Array
    share: float
    clear: float
    steady: float

    @property
    def real(self) -> bool:
        return self.share > 0.01 and self.clear > REAL and self.steady > STEADY

    @property
    def hint(self) -> bool:
        return self.share > 0.003 and self.clear > 1.0


def _predicted(
    study: Study, inputs: Array, group: Index, residual: Array, rng: np.random.Generator
) -> _Told:
    """The predicted part of a residual (n,)."""
    weight = study.block.weight
    told = _regression(weight, inputs, group, residual, rng)
    # A regression also learns noise; scaled by what holds on unseen groups, that costs nothing.
    cross, power = np.dot(weight, residual * told), np.dot(weight, told**2)
    told *= float(np.clip(cross / max(power, 1e-300), 0.0, 1.0))
    clear, steady = study.clearly(residual, residual - told)
    before, after = (np.dot(weight, r**2) for r in (residual, residual - told))
    return _Told(told, 1.0 - float(after / max(before, 1e-300)), clear, steady)


def _expected(
    study: Study, inputs: Array, rest: Array, rng: np.random.Generator
) -> tuple[Array, float]:
    """The mean square to be expected at each sample (n,), and that of the noise alone.

    A regression of the logarithm of the square tells where it is large; how large, is the mean over
    samples of which about the same is expected, that the regression has not seen.
    """
    weight, square = study.block.weight, rest**2
    mean = float(np.dot(weight, square) / weight.sum())
    even = np.full_like(rest, mean)
    if mean <= 0.0:
        return even, mean
    order = _regression(weight, inputs, study.group, np.log(square + 1e-3 * mean), rng)
    use = weight > 0
    edges = np.quantile(order[use], np.linspace(0, 1, round(1 / QUIET) + 1)[1:-1])
    cell = np.searchsorted(edges, order)
    count = np.bincount(cell, weight, len(edges) + 1)
    level = np.bincount(cell, square * weight, len(edges) + 1) / np.maximum(count, 1e-300)
    middle = float(np.median(order[use]))
    ratio = []
    for g in range(study.count):
        inside = (study.group == g) & use
        quiet, loud = inside & (order <= middle), inside & (order > middle)
        if min(np.count_nonzero(quiet), np.count_nonzero(loud)) > 20:
            ratio.append(float(np.log(square[loud].mean() / max(square[quiet].mean(), 1e-300))))
    contrast = np.array(ratio)
    if (
        len(ratio) < 3
        or over_scatter(contrast) <= CONTRAST
        or contrast.mean() < 2.0 * np.log(LOUDER)
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
