"""What a fit ends at is what is written: no value that others make up for is moved to a bound."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rig import TRUTH, campaign, noisy
from seeded import known_before

from erdctl.core.errors import InputProblem
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate.covariance import estimates
from erdctl.estimate.identify import identify
from erdctl.estimate.last_step import assess
from erdctl.io.logs import read_logs
from erdctl.model.composed import Model
from erdctl.model.slots import Values
from erdctl.plant import draw, log
from erdctl.score.nrmse import validate


def rms(r: Recording, model: Model, values: Values) -> float:
    return validate(r, model.force(Signals.of(r), values)).overall.rms


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", [1594002, 1594079, 1600014, 1600081])
def test_a_log_of_two_records_is_simulated_as_it_was_fitted(seed: int, tmp_path: Path) -> None:
    """In the first two the parameters make up for the zero of each record: its scatter, of which
    nothing is left, was 1e16 N, and yield forces of 1 to 3 kN were written as 0."""
    file = tmp_path / "log.parquet"
    pq.write_table(log(draw(seed, kind="sparse", known=known_before("deflection_offset"))), file)
    r = read_logs([str(file)], need_force=True, report=lambda line: None).recording
    found = identify(r)
    written = {name: e.used for name, e in found.joint.items()}
    fitted = rms(r, found.model, found.fit.values)
    assert rms(r, found.model, written) == pytest.approx(fitted, rel=1e-3)
    assert r.force is not None
    for way in ("compression", "release"):
        assert found.fit.stderr[f"{way}.sigma"] < 1e4 * np.ptp(r.force)


@pytest.mark.long
def test_heat_that_is_never_lost_is_written_so() -> None:
    """A time constant at its upper bound has an error beyond all bounds; it was written at the
    lower one, 1 s."""
    r, fade = campaign(100.0, 12.0), get("thermal_fade")
    model = Model((fade,))
    values = TRUTH | {"thermal_fade.a_v": 5e-3, "thermal_fade.a_y": 5e-3, "thermal_fade.tau": 1e6}
    log = noisy(replace(r, force=model.force(Signals.of(r), values)), seed=3)
    found = assess(model, [prepare(log).block], values, threads=1)
    assert found.stderr["thermal_fade.tau"] > 1e9
    written = {name: e.used for name, e in estimates(found, {}).items()}
    assert written["thermal_fade.tau"] == pytest.approx(1e6, rel=1e-3)
    assert rms(log, model, written) == pytest.approx(rms(log, model, found.values), rel=1e-3)


def test_only_a_move_that_changes_nothing_ends_at_a_bound() -> None:
    tau = Quantity(
        symbol="tau", unit="s", title="", low=1.0, high=1e6, start=100.0, scale=Scale.LOG
    )
    assert tau.bound_at(1e6, 1e11) == 1e6
    assert tau.bound_at(300.0, 1e9) is None
    assert tau.bound_at(1.0005, 77.0) == 1.0
    lag = Quantity(symbol="T_d", unit="s", title="", low=0.0, high=1.0, start=0.05)
    assert lag.bound_at(0.2, 1e9) is None
    assert lag.bound_at(1e-5, 0.1) == 0.0
    yields = Quantity(symbol="s", unit="N", title="", low=0.0, high=1e9, start=1.0, linear=True)
    assert yields.bound_at(2635.0, 1e17, 2.0) is None
    assert yields.bound_at(0.05, 1e3, 2.0) == 0.0


def some_log(seed: int) -> Recording:
    """A few records of a damper of any size, at duties of their own or with steps, and a model that
    does or does not hold."""
    g = np.random.default_rng(seed)
    whole = campaign(100.0, 6.0)
    chosen = g.choice(len(whole.names), int(g.integers(1, 5)), replace=False)
    r = whole.select(sorted(chosen.tolist()))
    counts, size, stroke = np.diff(r.starts), 10 ** g.uniform(-1, 3), 10 ** g.uniform(-0.5, 1)
    x, xdot, duty = r.x * stroke, r.xdot * stroke, r.duty
    if g.random() < 0.5:
        duty = np.repeat(g.choice(g.uniform(0, 1, int(g.integers(1, 4))), len(counts)), counts)
    values = dict(TRUTH)
    for way in ("compression", "release"):
        for symbol in ("k_nom", "c_vis", "sigma"):
            values[f"{way}.{symbol}"] *= size * 10 ** g.uniform(-1, 1)
        values[f"{way}.beta"] = g.uniform(0.2, 1.5)
        values[f"{way}.T_d"] = g.choice([0.0, g.uniform(0, 0.06)])
    force = Model().force(Signals(r.t, x, xdot, duty, r.step, r.starts), values)
    span = np.ptp(force)
    missing = g.integers(0, 4)
    if missing == 1:
        force = force + 0.1 * span * np.tanh(xdot / 0.01)
    elif missing == 2:
        force = force + np.repeat(g.normal(0, 0.05 * span, len(counts)), counts)
    elif missing == 3:
        force = force * (1.0 + 0.3 * np.abs(x) / np.abs(x).max())
    log = replace(r, x=x, xdot=xdot, duty=duty, force=force)
    return noisy(log, seed, rms=span * 10 ** g.uniform(-4, -1), correlation=g.choice([0.0, 0.9]))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
@example(1)
@example(32)
@example(46)
@example(89)
def test_any_log_is_written_as_it_was_fitted(seed: int) -> None:
    """In the examples the zero of one record of several is made up for, and only rounding was left
    of it: errors of 1e9 N s/m."""
    r = some_log(seed)
    try:
        found = identify(r)
    except InputProblem:
        return  # of which nothing can be told
    written = {name: e.used for name, e in found.joint.items()}
    assert rms(r, found.model, written) == pytest.approx(
        rms(r, found.model, found.fit.values), 1e-3
    )
    assert r.force is not None
    largest = {"k_nom": np.ptp(r.force) / np.ptp(r.x), "c_vis": np.ptp(r.force) / np.ptp(r.xdot)}
    for name, error in found.fit.stderr.items():
        symbol = name.split(".")[1]
        if symbol in largest:
            assert error < 1e3 * largest[symbol], name


def test_scatter_of_which_nothing_is_left_is_none() -> None:
    """Two records of one motion, at two duties: both yield forces are free to take both zeros."""
    r = campaign(100.0, 6.0)
    two = r.select([i for i, name in enumerate(r.names) if name.startswith("0.7Hz")])
    duty = np.where(two.duty == 0.0, 0.3, 0.45)
    values = TRUTH | {"compression.T_d": 0.0, "release.T_d": 0.0}
    s = Signals.of(two).with_duty(duty)
    log = noisy(replace(two, duty=duty, force=Model().force(s, values)), seed=5)
    for name, error in identify(log).fit.stderr.items():
        assert error < 1e4 * max(abs(values[name]), 1.0), name
