"""A flexible regression of a residual on the state of the damper, always on groups left out."""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.model.learned.coordinates import Memory, along


def cross_predicted(weight: Array, inputs: Array, group: Index, target: Array, seed: int) -> Array:
    """(n,) target as predicted from inputs (n, m) by regressions that have not seen its group."""
    from sklearn.ensemble import HistGradientBoostingRegressor
    from sklearn.model_selection import GroupKFold, cross_val_predict
    from threadpoolctl import threadpool_limits

    used = np.flatnonzero(weight > 0)
    learn = np.zeros(len(target), dtype=np.bool_)
    learn[used[:: max(1, len(used) // thresholds.REGRESSION_SAMPLES)]] = True
    count = min(thresholds.FOLDS, len(np.unique(group)))
    folds = GroupKFold(count, shuffle=True, random_state=seed)
    splits = [(train[learn[train]], test) for train, test in folds.split(inputs, groups=group)]
    machine = HistGradientBoostingRegressor(
        max_iter=thresholds.TREES, learning_rate=thresholds.RATE,
        max_leaf_nodes=thresholds.LEAVES, max_bins=thresholds.BINS,
        min_samples_leaf=thresholds.LEAF,
        l2_regularization=thresholds.PENALTY, early_stopping=False, random_state=0,
    )  # fmt: skip
    # Its threads wait for each other in busy loops: on a shared machine that takes minutes.
    with threadpool_limits(1):
        return np.asarray(cross_val_predict(machine, inputs, target, cv=splits))


def features(s: Signals) -> tuple[Array, Array]:
    """(n, m) motion, control and a little past; (n, 2) time and distance travelled in the record.

    All that a damper's force may depend on, as far as it is in a log.
    """
    longest, farthest = thresholds.LONGEST_SINCE, thresholds.FARTHEST_SINCE
    start = np.repeat(s.starts[:-1], np.diff(s.starts))
    index = np.arange(len(s))
    columns = [
        s.x, s.xdot, s.xddot, s.duty, s.sign,
        np.minimum(s.since_reversal, longest), np.minimum(s.since_duty_step, longest),
        np.minimum(s.path_since_reversal, farthest), s.sign * np.sqrt(s.duty),
    ]  # fmt: skip
    for lag in thresholds.LAGS:
        before = np.maximum(_earlier(s, lag, index), start)
        columns += [s.xdot[before], s.duty[before]]
    columns += [along("late_duty", s, Memory(tau)) for tau in thresholds.MEMORIES]
    total = np.concatenate([[0.0], np.cumsum(s.path[0][:-1])])
    slow = [s.t - s.t[start], total - total[start]]
    return np.column_stack(columns), np.column_stack(slow)


def _earlier(s: Signals, lag: float, index: Index) -> Index:
    """(n,) the sample a time [s] before each, perhaps of another record; one before it at least."""
    if s.common_step is not None:
        return np.asarray(index - max(1, round(lag / (s.typical_step or 1.0))))
    clock = np.concatenate([[0.0], np.cumsum(s.step[:-1])])
    return np.minimum(np.searchsorted(clock, clock - lag, side="right") - 1, index - 1)
