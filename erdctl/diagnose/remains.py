"""What is left in a residual that a flexible regression can still predict on unseen groups.

Measurement noise, white or coloured, cannot be predicted from motion and control; physics left out
can. So the part of the residual that is predicted on groups the regression has not seen is misfit,
whatever its form and whether or not the catalogue knows it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.diagnose.study import Study
from erdctl.recording import Array
from erdctl.signals import Signals

FOLDS = 5
MOST = 20_000  # samples that the regression learns from
REAL = 3.0  # how many times its scatter the predicted part must be


@dataclass(frozen=True, eq=False)
class Remainder:
    """The predictable part of a residual.

    predicted : (n,) [N], by regressions that have not seen the sample's group
    share : part of the mean square that is predicted, 0 if none;  clear : that over its scatter
    noise_rms, misfit_rms : of the unpredictable and of the predictable part [N]
    """

    predicted: Array
    share: float
    clear: float
    noise_rms: float
    misfit_rms: float

    @property
    def real(self) -> bool:
        """Whether anything is left beyond noise."""
        return self.clear > REAL and self.share > 0.01


def examine(study: Study, residual: Array, seed: int = 0) -> Remainder:
    """The predictable part of a residual (n,) [N]."""
    from sklearn.ensemble import HistGradientBoostingRegressor
    from threadpoolctl import threadpool_limits

    inputs = features(study.block.signals)
    weight = study.block.weight
    rng = np.random.default_rng(seed)
    fold_of = rng.permutation(study.count) % min(FOLDS, study.count)
    fold = fold_of[study.group]
    predicted = np.zeros_like(residual)
    used = np.flatnonzero(weight > 0)
    keep = used[:: max(1, len(used) // MOST)]
    for k in range(int(fold_of.max()) + 1):
        learn, tell = keep[fold[keep] != k], np.flatnonzero(fold == k)
        machine = HistGradientBoostingRegressor(
            max_iter=60, learning_rate=0.12, max_leaf_nodes=24, min_samples_leaf=60,
            l2_regularization=10.0, early_stopping=False, random_state=seed,
        )  # fmt: skip
        # Its threads wait for each other in busy loops: on a shared machine that takes minutes.
        with threadpool_limits(1):
            machine.fit(inputs[learn], residual[learn])
            predicted[tell] = machine.predict(inputs[tell])
    # A regression also learns noise; scaled by what holds on unseen groups, that costs nothing.
    cross = study.per_group(residual * predicted)
    power = study.per_group(predicted**2)
    scale = float(np.clip(cross.sum() / max(power.sum(), 1e-300), 0.0, 1.0))
    predicted *= scale
    before = study.per_group(residual**2)
    after = study.per_group((residual - predicted) ** 2)
    ratio = np.log(np.maximum(before, 1e-300) / np.maximum(after, 1e-300))
    scatter = float(ratio.std(ddof=1)) / np.sqrt(len(ratio)) if len(ratio) > 1 else np.inf
    total = float(study.weight_of.sum())
    share = max(0.0, 1.0 - float(after.sum() / max(before.sum(), 1e-300)))
    return Remainder(
        predicted=predicted,
        share=share,
        clear=float(ratio.mean()) / scatter if scatter > 0 else 0.0,
        noise_rms=float(np.sqrt(after.sum() / total)),
        misfit_rms=float(np.sqrt(share * before.sum() / total)),
    )


def features(s: Signals) -> Array:
    """(n, m) what a damper's force may depend on: motion, control, time, energy, a little past."""
    step = s.typical_step or 1.0
    past = [max(1, round(lag / step)) for lag in (0.01, 0.05)]
    start = np.repeat(s.starts[:-1], np.diff(s.starts))
    index = np.arange(len(s))
    columns = [
        s.x, s.xdot, s.xddot, s.duty, s.sign,
        np.minimum(s.since_reversal, 10.0), np.minimum(s.since_duty_step, 10.0),
        np.minimum(s.path_since_reversal, 1.0), s.t - s.t[start], s.sign * np.sqrt(s.duty),
    ]  # fmt: skip
    for lag in past:
        before = np.maximum(index - lag, start)
        columns += [s.xdot[before], s.duty[before]]
    return np.column_stack(columns)
