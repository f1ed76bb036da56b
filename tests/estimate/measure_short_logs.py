"""What `identify` makes of short logs drawn at random, by hand:

    export PYTHONPATH=.:tests:fixtures:tests/estimate
    python tests/estimate/measure_short_logs.py any FIRST END
    python tests/estimate/measure_short_logs.py lags FIRST END

any : one to four records and a model that may not hold (`test_written_as_fitted`): logs that are
    written otherwise than they were fitted, or have errors beyond all that was recorded
lags : the paper's model alone, one duty in each record, lags of 5 to 60 ms: logs said to lack
    something, logs whose lags are free, 95 % intervals that hold
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from rig import TRUTH, campaign, noisy
from test_written_as_fitted import test_any_log_is_written_as_it_was_fitted as written

from erdctl.core.errors import InputProblem
from erdctl.core.recording import DIRECTIONS, Recording
from erdctl.core.signals import Signals
from erdctl.estimate.identify import identify
from erdctl.model.composed import Model


def one_duty_a_record(seed: int) -> tuple[Recording, dict[str, float]]:
    """A log, and the values that made it."""
    g = np.random.default_rng(seed)
    whole = campaign(100.0, 6.0)
    chosen = g.choice(len(whole.names), int(g.integers(1, 6)), replace=False)
    r = whole.select(sorted(chosen.tolist()))
    counts, size, stroke = np.diff(r.starts), 10 ** g.uniform(-1, 3), 10 ** g.uniform(-0.5, 1)
    x, xdot = r.x * stroke, r.xdot * stroke
    duty = np.repeat(g.choice(g.uniform(0, 1, int(g.integers(1, 4))), len(counts)), counts)
    values = dict(TRUTH)
    for way in DIRECTIONS:
        for symbol in ("k_nom", "c_vis", "sigma"):
            values[f"{way}.{symbol}"] *= size * 10 ** g.uniform(-0.5, 0.5)
        values[f"{way}.beta"] = g.uniform(0.2, 1.5)
        values[f"{way}.T_d"] = g.uniform(0.005, 0.06)
    force = Model().force(Signals(r.t, x, xdot, duty, r.step, r.starts), values)
    log = replace(r, x=x, xdot=xdot, duty=duty, force=force)
    noise = np.ptp(force) * 10 ** g.uniform(-4, -1.3)
    return noisy(log, seed, rms=noise, correlation=g.choice([0.0, 0.9])), values


def lags(first: int, end: int) -> None:
    logs = lacking = free = told = held = 0
    for seed in range(first, end):
        log, truth = one_duty_a_record(seed)
        try:
            found = identify(log)
        except InputProblem:
            continue  # of which nothing can be told
        logs += 1
        lacking += any("the model lacks something, and" in line for line in found.warnings)
        free += found.fit.values["release.T_d"] > 0.0
        within = {n: e.interval for n, e in found.joint.items() if e.interval is not None}
        told += len(within)
        held += sum(a <= truth[n] <= b for n, (a, b) in within.items())
    print(f"{logs} logs, {lacking} said to lack something, {free} with lags")
    print(f"{100 * held / told:.1f} % of {told} intervals hold")


def any_(first: int, end: int) -> None:
    wrong = []
    for seed in range(first, end):
        try:
            written.hypothesis.inner_test(seed)
        except AssertionError:
            wrong.append(seed)
    print(f"{end - first} logs, {len(wrong)} wrong: {wrong}")


if __name__ == "__main__":
    {"any": any_, "lags": lags}[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3]))
