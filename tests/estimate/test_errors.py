"""Errors beyond the paper's model: scatter of records, gaps, steps between samples, profiles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.quantity import Quantity
from erdctl.core.signals import Signals
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.finer import Finer
from erdctl.estimate.identify import identify
from erdctl.estimate.own_levels import OwnLevels, covariance
from erdctl.estimate.profile import interval, parabolic, widened
from erdctl.estimate.record_scatter import RecordSums

ONE = np.array([0, 4000], dtype=np.intp)


def test_samples_without_weight_do_not_thin_the_noise() -> None:
    white = np.random.default_rng(1).standard_normal(4000)
    used = np.arange(4000) >= 400
    found = ColouredNoise.of(np.where(used, white, 0.0), ONE, used=used)
    assert found.innovation == pytest.approx(np.var(white[400:]), rel=0.02)


def test_colouring_is_the_covariance_of_the_noise() -> None:
    """J' C J of AR(1) noise against the covariance matrix written out."""
    n, rho = 60, 0.8
    noise = ColouredNoise(np.empty(0), np.empty(0), np.array([rho]), 1.0 - rho**2)
    rows = np.random.default_rng(2).standard_normal((2, n))
    rows[:, :30] = 0.0  # away from where the filter begins, the process is stationary
    coloured = noise.colour(rows, np.array([0, n], dtype=np.intp)) * np.sqrt(noise.innovation)
    lag = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    assert coloured @ coloured.T == pytest.approx(rows @ rho**lag @ rows.T, rel=1e-4)


def test_records_that_scatter_have_larger_errors() -> None:
    r = noisy(campaign(), seed=3)
    assert r.force is not None
    random = np.random.default_rng(4)
    lengths = np.diff(r.starts)
    gain = np.repeat(1.0 + 0.01 * random.standard_normal(len(lengths)), lengths)
    zero = np.repeat(0.3 * random.standard_normal(len(lengths)), lengths)
    still, scattered = identify(r), identify(replace(r, force=gain * r.force + zero))
    a, b = (f.joint["compression.k_nom"].stderr for f in (still, scattered))
    assert a is not None
    assert b is not None
    assert b > 2.0 * a


def test_signals_between_samples_keep_those_at_them() -> None:
    s = Signals.of(campaign(100.0, 2.0))
    finer = Finer.of(s)
    assert finer.rows is not None
    for name in ("t", "x", "xdot", "duty"):
        assert finer.picked(getattr(finer.signals, name)) == pytest.approx(
            getattr(s, name), rel=1e-12, abs=1e-12
        )
    # 3.1 Hz at 100 Hz: the straight line between samples is off by (w h)^2 / 8 of its amplitude.
    first = slice(0, int(finer.signals.starts[1]))
    exact = np.gradient(finer.signals.x[first], finer.signals.t[first])
    assert np.abs(finer.signals.xdot[first] - exact)[5:-5].max() < 2e-3 * np.abs(exact).max()


Q = Quantity(symbol="g", unit="m", title="", low=0.0, high=10.0, start=1.0)


def test_profile_of_a_parabola_is_the_error() -> None:
    def cost(v: float) -> float:
        return ((v - 2.0) / 0.1) ** 2

    assert parabolic(cost, Q, 2.0, 0.1)
    best, low, high = interval(cost, Q, 2.0, 0.196)
    assert best == 2.0
    assert (low, high) == (pytest.approx(2.0 - 0.196, abs=3e-3), pytest.approx(2.196, abs=3e-3))


def test_profile_of_steps_holds_the_whole_step() -> None:
    """A cost that is flat from 2.0 to 2.5 and high elsewhere says nothing of where within."""

    def cost(v: float) -> float:
        return 0.0 if 2.0 <= v < 2.5 else 50.0

    assert not parabolic(cost, Q, 2.1, 1e-3)
    best, low, high = interval(cost, Q, 2.1, 1e-3)
    assert 2.0 <= best < 2.5
    assert (low, high) == (pytest.approx(2.0, abs=0.02), pytest.approx(2.5, abs=0.02))


def test_profile_at_a_bound_has_one_side() -> None:
    best, low, high = interval(lambda v: (v / 0.1) ** 2, Q, 0.0, 0.01)
    assert (best, low) == (0.0, 0.0)
    assert high == pytest.approx(0.196, abs=5e-3)


def test_a_profile_along_a_bend_is_as_wide_as_the_bend() -> None:
    """Others that follow to first order end it at 2.02; refitted they follow up to 2.5 and 1.6."""
    found = widened(
        lambda v: (1.96 * (v - 2.0) / (0.5 if v > 2.0 else 0.4)) ** 2, Q, 2.0, 1.98, 2.02
    )
    assert found == (pytest.approx(1.6, abs=0.02), pytest.approx(2.5, abs=0.02))
    kept = widened(lambda v: (1.96 * (v - 2.0) / 0.02) ** 2, Q, 2.0, 1.98, 2.02)
    assert kept == (1.98, 2.02)


def test_errors_beside_zeros_of_records() -> None:
    """By hand: one constant over 4 records of 100 samples, noise 1 N, zeros that scatter by s."""
    rows = np.array([1.0, 3.0, 1.0])  # derivative of the force, force, one
    sums = [RecordSums(100 * np.outer(rows, rows), np.zeros(3), 100 * np.outer(rows, rows))] * 4
    none = OwnLevels((1,), np.zeros((1, 4)), np.full((1, 4), 0.1))
    shared, own = covariance(sums, none, np.ones(1))
    assert shared[0, 0] == pytest.approx(1.0 / 400.0)
    assert own[0] == pytest.approx(np.full(4, np.sqrt((1.0 - 0.25) / 100.0)))
    zeros = OwnLevels((1,), np.array([[-3.0, -1.0, 1.0, 3.0]]), np.full((1, 4), 1e-6))
    shared, _ = covariance(sums, zeros, np.ones(1))
    # s^2 = 20 / 3, that of the mean of four a quarter of it, and Student's t of 3 for 1.96.
    assert np.sqrt(shared[0, 0]) == pytest.approx(
        3.1824 / 1.96 * np.sqrt(20 / 12 + 1 / 400), rel=2e-3
    )
