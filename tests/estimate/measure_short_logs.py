"""What `identify` makes of short logs drawn at random, by hand:

    export PYTHONPATH=.:tests:fixtures:tests/estimate
    python tests/estimate/measure_short_logs.py any FIRST END
    python tests/estimate/measure_short_logs.py lags FIRST END
    python tests/estimate/measure_short_logs.py effects FIRST END

any : one to four records and a model that may not hold (`test_written_as_fitted`): logs that are
    written otherwise than they were fitted, or have errors beyond all that was recorded
lags : the paper's model alone, one duty in each record, lags of 5 to 60 ms: logs said to lack
    something, logs whose lags are free, 95 % intervals that hold
effects : the same with no lag, and one effect of the catalogue of 0.3 to 50 % of the force: logs
    said to lack something, logs whose lags are free though there are none
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from rig import TRUTH, campaign, noisy
from test_written_as_fitted import test_any_log_is_written_as_it_was_fitted as written

from erdctl.core.errors import InputProblem
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.core.signals import Signals
from erdctl.effects import get, names
from erdctl.estimate.identify import identify
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.slots import Values


def one_duty_a_record(
    seed: int, effect: Effect | None = None
) -> tuple[Recording, dict[str, float]]:
    """A log, and the values that made it; with an effect there is no lag."""
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
    signals = Signals(r.t, x, xdot, duty, r.step, r.starts)
    if effect is None:
        force = Model().force(signals, values)
    else:
        values |= {f"{way}.T_d": 0.0 for way in DIRECTIONS}
        force = with_effect(effect, signals, values, g)
    log = replace(r, x=x, xdot=xdot, duty=duty, force=force)
    noise = np.ptp(force) * 10 ** g.uniform(-4, -1.3)
    return noisy(log, seed, rms=noise, correlation=g.choice([0.0, 0.9])), values


def with_effect(effect: Effect, signals: Signals, paper: Values, g: np.random.Generator) -> Array:
    """(n,) force with an effect of a random size that shows; of none if 30 draws do not."""
    plain, model = Model().force(signals, paper), Model((effect,))
    for _ in range(30):
        own = {n: q for n, q in model.quantities.items() if n not in paper}
        drawn = {
            n: float(np.clip((abs(q.start) or 1.0) * 10 ** g.uniform(-2, 2), q.low, q.high))
            * (np.ptp(plain) if q.linear and q.unit == "N" else 1.0)
            for n, q in own.items()
        }
        force = model.force(signals, {**paper, **drawn})
        if 0.003 < np.std(force - plain) / np.std(plain) < 0.5:
            return force
    return plain


def effects(first: int, end: int) -> None:
    logs, lacking, free = 0, 0, []
    for seed in range(first, end):
        effect = get(names()[seed % len(names())])
        log, _ = one_duty_a_record(seed, effect)
        try:
            found = identify(log)
        except InputProblem:
            continue
        logs += 1
        lacking += any("the model lacks something, and" in line for line in found.warnings)
        if any(found.fit.values[f"{way}.T_d"] > 0.0 for way in DIRECTIONS):
            free.append((seed, effect.name))
    print(f"{logs} logs, {lacking} said to lack something, {len(free)} with lags: {free}")


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
    {"any": any_, "lags": lags, "effects": effects}[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3]))
