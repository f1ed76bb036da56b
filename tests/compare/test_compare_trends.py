"""One parameter over time: its form, since when, how fast, and what is no change."""

from __future__ import annotations

import re

import numpy as np
import pytest

from erdctl.compare.history import Series
from erdctl.compare.scan import appears, scan
from erdctl.compare.scatter import extra_scatter, spread
from erdctl.compare.shape import Course
from erdctl.compare.trend import Trend, trend
from erdctl.core.recording import Array
from erdctl.report.changes import trend_text

SURE = 0.02 / 300  # as in a fleet of 20 dampers with 15 parameters
MONTH = 30.4375
T = 18000.0 + MONTH * np.arange(80)
YEARS = (T - T[0]) / 365.25


def series(value: Array, stderr: Array, off: float | None = None, limit: float = np.nan) -> Series:
    n = len(value)
    none = np.full(n, np.nan)
    return Series(
        name="backlash.g", unit="m", at=np.arange(n), t=T[:n], value=value, stderr=stderr, low=none,
        high=none, off=off, limit=np.full(n, limit),
    )  # fmt: skip


def noise(seed: int, scatter: float = 0.5) -> tuple[Array, Array]:
    """Errors that differ by log and are known, scatter that is not, and two outliers."""
    r = np.random.default_rng(seed)
    error = r.choice([0.5, 1.0, 2.0], len(T))
    out = error * r.standard_normal(len(T)) + scatter * r.standard_normal(len(T))
    out[[11, 57]] += [12.0, -15.0]
    return out, error


def found(value: Array, stderr: Array) -> Trend:
    t = trend(series(value, stderr), SURE)
    assert t is not None
    return t


@pytest.mark.parametrize("seed", range(4))
def test_nothing_is_said_of_a_constant(seed: int) -> None:
    rest, error = noise(seed)
    t = found(100.0 + rest, error)
    assert t.form is Course.CONSTANT
    assert abs(t.now[0] - 100.0) < 4 * t.now[1] < 1.5


@pytest.mark.parametrize("shared", [-0.8, 0.8])
def test_an_error_that_all_logs_have_in_common_is_in_the_rate(shared: float) -> None:
    """As a play that falls between samples: logs that agree to 0.02, and say +- 1 each."""
    grown = np.maximum(T - T[0] - 30 * MONTH, 0.0) / 365.25
    rest = 0.02 * np.random.default_rng(5).standard_normal(len(T))
    t = found(100.0 + (3.0 + shared / grown[-1]) * grown + rest, np.ones(len(T)))
    assert t.form is Course.RAMP
    assert t.rate is not None
    assert abs(t.rate[0] - 3.0) < t.rate[1] < 0.3
    assert 0.9 < t.now[1] < 2.0


@pytest.mark.parametrize("seed", range(3))
def test_a_ramp_since_a_date(seed: int) -> None:
    rest, error = noise(seed)
    since = T[0] + 42.5 * MONTH
    t = found(100.0 - 8.0 * np.maximum(T - since, 0.0) / 365.25 + rest, error)
    assert t.form is Course.RAMP
    assert t.since is not None
    assert abs(t.since[0] - since) < 5 * MONTH
    assert t.since[1] - MONTH < since < t.since[2] + MONTH
    assert t.rate is not None
    assert abs(t.rate[0] + 8.0) < 3 * t.rate[1] < 3.0


@pytest.mark.parametrize("seed", range(3))
def test_a_step(seed: int) -> None:
    rest, error = noise(seed)
    t = found(100.0 + 5.0 * (T[29] + 1 < T) + rest, error)
    assert t.form is Course.STEP
    assert t.since is not None
    assert abs(t.since[0] - T[29]) < 2 * MONTH
    assert t.since[1] <= T[30]
    assert t.since[2] >= T[29]
    assert t.rate is None
    assert t.now[0] - t.start[0] == pytest.approx(5.0, abs=1.0)


def test_a_line() -> None:
    rest, error = noise(5)
    t = found(100.0 + 3.0 * YEARS + rest, error)
    assert t.form is Course.LINEAR
    assert t.rate is not None
    assert abs(t.rate[0] - 3.0) < 3 * t.rate[1]
    later = np.array([T[-1] + 365.25])
    low, high = t.band(later)
    assert low[0] < 100.0 + 3.0 * (YEARS[-1] + 1.0) < high[0]
    assert high[0] - low[0] > 3.92 * t.spread


def test_what_falls_falls_by_a_positive_rate() -> None:
    """Both "fell" and a minus sign would say that it rose."""
    rest, error = noise(5)
    for slope, word in ((3.0, "grew"), (-3.0, "fell")):
        t = found(100.0 + slope * YEARS + rest, error)
        assert t.rate is not None
        assert np.sign(t.rate[0]) == np.sign(slope)
        said = re.fullmatch(rf"free play {word} .*, by (\S+) \+- (\S+) mm a year", trend_text(t))
        assert said is not None, trend_text(t)
        assert float(said[1]) == pytest.approx(1e3 * abs(t.rate[0]), rel=0.01)
        assert float(said[2]) == pytest.approx(1e3 * t.rate[1], rel=0.01)


def test_the_same_in_any_unit() -> None:
    rest, error = noise(6)
    value = 100.0 - 9.0 * np.maximum(YEARS - 3.0, 0.0) + rest
    a, b = found(value, error), found(1e-3 * value, 1e-3 * error)
    assert a.since == b.since
    assert b.rate is not None
    assert a.rate is not None
    assert b.rate[0] == pytest.approx(1e-3 * a.rate[0], rel=1e-6)


def test_neighbours_that_are_alike_are_no_change() -> None:
    """Warm and cold months move a parameter up and down, and it comes back."""
    for seed in range(4):
        rest, error = noise(seed, scatter=0.1)
        swing = 2.0 * np.sin(2 * np.pi * YEARS + seed)
        assert found(100.0 + swing + 0.3 * rest, 0.3 * error).form is Course.CONSTANT


def test_play_that_is_named_once_it_is_large() -> None:
    """Before, all that is known is that it would have been named from 0.4 mm on."""
    r = np.random.default_rng(0)
    since = T[0] + 30.0 * MONTH
    play = 0.4e-3 * np.maximum(T - since, 0.0) / 365.25
    seen = play + 3e-5 * r.standard_normal(len(T))
    value = np.where(seen > 0.4e-3, seen, np.nan)
    assert np.isnan(value[:40]).all()
    for limit in (0.4e-3, np.nan):
        t = trend(series(value, np.full(len(T), 2e-5), 0.0, limit), SURE)
        assert t is not None
        assert t.form is Course.RAMP
        assert t.absent_before
        assert t.start == (0.0, 0.0)
        assert t.since is not None
        assert abs(t.since[0] - since) < 2 * MONTH
        assert t.since[1] <= since <= t.since[2]
        assert t.rate is not None
        assert abs(t.rate[0] - 0.4e-3) < 3 * t.rate[1] < 0.1e-3


def test_play_that_earlier_logs_could_not_have_shown() -> None:
    """Named since the logs are better, and no larger than what the others would have missed."""
    value = np.where(np.arange(len(T)) < 40, np.nan, 0.5e-3)
    value = value + 2e-5 * np.random.default_rng(0).standard_normal(len(T))
    poor = trend(series(value, np.full(len(T), 2e-5), 0.0, 3e-3), SURE)
    good = trend(series(value, np.full(len(T), 2e-5), 0.0, 0.1e-3), SURE)
    assert poor is not None
    assert good is not None
    assert poor.form is Course.CONSTANT
    assert good.form is Course.STEP
    assert good.absent_before


def test_an_effect_named_now_and_then_is_no_change() -> None:
    r = np.random.default_rng(2)
    value = np.where(r.random(len(T)) < 0.2, 0.5e-3, np.nan)
    t = trend(series(value, np.full(len(T), 1e-4), 0.0), SURE)
    assert t is not None
    assert t.form is Course.CONSTANT


def test_an_effect_that_vanishes() -> None:
    value = np.where(np.arange(len(T)) < 50, 1e-3, np.nan)
    t = trend(series(value, np.full(len(T), 5e-5), 0.0, 0.3e-3), SURE)
    assert t is not None
    assert t.absent_after
    assert not t.absent_before


def test_few_logs_have_no_trend() -> None:
    assert trend(series(np.arange(5.0), np.ones(5)), SURE) is None


def test_scatter_from_log_to_log() -> None:
    r = np.random.default_rng(4)
    error = r.choice([0.2, 1.0], 4000)
    value = error * r.standard_normal(4000) + 0.7 * r.standard_normal(4000) + np.arange(4000) / 500
    assert extra_scatter(value, error) == pytest.approx(0.7, rel=0.08)
    assert extra_scatter(0.5 * error * r.standard_normal(4000), error) == 0.0


def test_chance_by_counting() -> None:
    """Of no change p is too large rather than too small: how often it lies below 0.05."""
    r = np.random.default_rng(1)
    t = T[:40]
    below = by_count = 0
    for _ in range(200):
        value = r.standard_t(3, 40)
        below += scan(t, value, spread(value, np.full(40, np.nan))).p < 0.05
        by_count += appears(r.random(40) < 0.2) < 0.05
    assert below <= 18
    assert by_count <= 18
