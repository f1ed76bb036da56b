"""The samples of the search keep what a spring does, over whatever time a log runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from by_hand import recording
from numba import njit

from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.executor import Task, fitted
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.thin import thinned
from erdctl.effects import get
from erdctl.effects.velocity_noise import velocity_noise
from erdctl.estimate.starts import fresh_start
from erdctl.model.composed import Model

STEP, MOST, COMPLIANCE = 0.005, 6_000, 4e-6


@njit
def _damper(x: Array, v: Array, u: Array, fine: float, s: float) -> Array:
    """(n,) force [N] of a mount of compliance s in series with c p + y tanh(p / p_0), by Euler."""
    force = np.empty(len(x))
    e, y = 0.0, u[0]
    for i in range(len(x)):
        force[i] = e / s
        rest = e / s - 500.0 * (x[i] - e)
        low, high = -2.0, 2.0
        for _ in range(40):
            p = 0.5 * (low + high)
            if 120.0 * p + y * np.tanh(p / 4e-4) < rest:
                low = p
            else:
                high = p
        e += fine * (v[i] - 0.5 * (low + high))
        y += fine / 0.02 * (u[i] - y)
    return force


def mounted(samples: int, every: int = 20) -> Recording:
    """Six sines at held levels of duty, at 5 ms, with a noise of 0.4 N."""
    rng = np.random.default_rng(2)
    n = samples // 6
    t = np.arange(n * every) * STEP / every
    parts = []
    for f in (0.7, 1.3, 2.1, 0.5, 1.7, 2.6):
        w, phase = 2 * np.pi * f, rng.uniform(0.0, 6.0)
        x, v = 0.08 / w * np.sin(w * t + phase), 0.08 * np.cos(w * t + phase)
        duty = rng.permutation([0.05, 0.1, 0.2, 0.35, 0.5])[(t / 2.9).astype(int) % 5]
        force = _damper(x, v, 16.0 * duty**0.6, STEP / every, COMPLIANCE)
        parts.append([c[::every] for c in (t, x, v, duty, force)])
    t, x, v, duty, force = (np.concatenate(c) for c in zip(*parts, strict=True))
    return Recording(
        t=t, x=x, xdot=v, duty=duty, force=force + 0.4 * rng.standard_normal(len(t)),
        starts=np.arange(7) * n, names=tuple("abcdef"),
    )  # fmt: skip


def hypothesis(problem: Problem, base: Hypothesis, name: str, **start: float) -> Hypothesis:
    effect = get(name)
    first = {**base.values, **fresh_start(*thresholds.FRESH_SERIES)}
    first |= {effect.key(symbol): value for symbol, value in start.items()}
    found = fitted(problem, Task("", (effect,), (first,)))
    assert found is not None
    return found


def test_a_spring_in_a_long_log_is_not_taken_for_a_late_channel() -> None:
    problem = thinned(prepare(mounted(30_000)), MOST)
    assert len(problem.recording) < 2 * MOST
    base = fit_hypothesis(problem, (), [fresh_start(*thresholds.FRESH)])
    spring = hypothesis(problem, base, "mount_compliance", s_m=1e-6)
    skew = hypothesis(problem, base, "time_skew", tau=5e-4)
    assert spring.score < 0.25 * skew.score
    assert abs(spring.values["mount_compliance.s_m"] / COMPLIANCE - 1.0) < 0.15


def test_next_to_turns_with_weight_no_step_is_long() -> None:
    whole = prepare(mounted(30_000))
    problem = thinned(whole, MOST)
    s, weight = problem.block.signals, problem.block.weight
    kept = np.isin(_clock(whole.recording), _clock(problem.recording))
    since = whole.block.signals.since_reversal[kept]
    near = (since < 0.8 * thresholds.AFTER) & (weight > 0)
    near[s.starts[:-1]] = False
    assert near.any()
    assert s.step[np.flatnonzero(near) - 1].max() < 1.5 * thresholds.FINE_STEP
    assert s.step.max() > 2 * thresholds.FINE_STEP  # and elsewhere they are


def hopping(seconds: float, hop: float) -> Problem:
    """Four drives over bumps at 200 Hz, of a wheel that hops at 31 to 34 Hz.

    hop : speed of that, over that of the body's motion at 1 Hz
    """
    t = np.arange(round(200 * seconds)) / 200.0
    parts = []
    for k in range(4):
        body, wheel = 2 * np.pi * (1.0 + 0.13 * k), 2 * np.pi * (31.0 + k)
        x = 0.06 * (np.sin(body * t) / body + hop * np.sin(wheel * t + k) / wheel)
        parts.append((x, 0.06 * (np.cos(body * t) + hop * np.cos(wheel * t + k))))
    x, v = (np.concatenate(c) for c in zip(*parts, strict=True))
    force = 200 * x + 60 * v + 10.0 * np.tanh(v / 3e-3)
    starts = np.arange(5) * len(t)
    return prepare(recording(v, x=x, duty=0.1, force=force, t=np.tile(t, 4), starts=starts))


def test_where_the_motion_turns_all_the_time_nothing_is_left_out() -> None:
    """All of it was next to a turn that was not kept, and the search had not one sample."""
    whole = hopping(20.0, 2.0)
    few = thinned(whole, MOST)
    assert np.array_equal(few.block.weight, whole.block.weight)


def test_of_turns_that_follow_at_once_all_are_kept_or_none() -> None:
    """One that was not kept took the time behind it from all others: 2,601 samples had weight."""
    few = thinned(hopping(20.0, 0.3), MOST)
    assert len(few.recording) < 1.2 * MOST
    assert np.count_nonzero(few.block.weight) > 0.75 * len(few.recording)


def test_of_turns_that_follow_at_once_for_long_a_part_is_kept() -> None:
    """A wheel that hops for 5 s behind 15 s of a slow motion, which has most of the energy."""
    t = np.arange(4000) / 200.0
    slow, fast = 2 * np.pi * t, 2 * np.pi * 31.0 * t
    v = np.where(t < 15.0, 0.06 * np.cos(slow), 0.02 * np.cos(fast))
    x = np.where(t < 15.0, np.sin(slow), np.sin(fast) / 93.0) * 0.06 / (2 * np.pi)
    x, v = (np.tile(c, 4) for c in (x, v))
    force = 200 * x + 60 * v + 10.0 * np.tanh(v / 3e-3)
    starts = np.arange(5) * len(t)
    whole = recording(v, x=x, duty=0.1, force=force, t=np.tile(t, 4), starts=starts)
    few = thinned(prepare(whole), MOST)
    assert len(few.recording) < 1.2 * MOST
    hops = few.block.weight * (few.recording.t > 15.0)
    assert np.all(np.add.reduceat(hops, few.recording.starts[:-1]) > 100.0)


def _clock(r: Recording) -> Array:
    """(n,) time with the records one after the other [s]."""
    return r.t + 1e4 * np.repeat(np.arange(len(r.names)), np.diff(r.starts))


def test_a_short_log_is_searched_whole() -> None:
    problem = prepare(mounted(6_000))
    assert thinned(problem, MOST) is problem


def test_every_group_and_stretch_has_a_sample_and_records_stay() -> None:
    whole = prepare(mounted(30_000))
    few = thinned(replace(whole, held={"release.beta": 0.6}), MOST)
    assert few.recording.names == whole.recording.names
    assert few.held == {"release.beta": 0.6}
    for label in (few.group, few.stretch):
        assert np.array_equal(np.unique(label), np.arange(label.max() + 1))
    assert few.count == whole.count


def test_a_velocity_from_the_deflection_is_that_of_all_samples() -> None:
    """Slopes between the samples that are left reach too far, and are not even on both sides."""
    r = mounted(30_000)
    whole = prepare(replace(r, xdot=np.concatenate([r.xdot[:1], r.xdot[:-1]])))
    few = thinned(thinned(whole, 15_000), MOST)
    kept = np.isin(_clock(whole.recording), _clock(few.recording))
    all_, seen = (p.block.signals for p in (whole, few))
    better = [velocity_noise(s, {"w": 1.0}).xdot for s in (all_, seen)]
    assert len(seen) < len(all_) // 2
    assert np.array_equal(better[1], better[0][kept])
    assert np.std(better[0] - r.xdot) < 0.5 * np.std(all_.xdot - r.xdot)


def test_of_a_motion_that_is_fast_for_long_whole_stretches_are_followed() -> None:
    """A car of 160 s at 1 kHz was searched on 61,341 samples for 12,000, five times as long."""
    whole = hopping(60.0, 2.0)
    few = thinned(whole, MOST)
    s, has_weight = few.block.signals, few.block.weight > 0
    assert len(whole.recording) == 48_000
    assert len(few.recording) < 3.5 * MOST
    assert 1.7 * MOST < np.count_nonzero(has_weight) < 2.3 * MOST
    assert np.all(thinned(whole, 1_000).weight_of > 0.0)  # nothing left out in turn is empty
    own = np.unique(few.stretch[has_weight])
    assert np.array_equal(np.bincount(few.stretch)[own], np.bincount(few.stretch[has_weight])[own])
    within = np.flatnonzero(has_weight[1:] & has_weight[:-1]) + 1
    assert np.median(s.step[within - 1]) == pytest.approx(STEP)
    per_record = np.add.reduceat(has_weight.astype(int), s.starts[:-1])
    assert per_record.max() < 1.2 * per_record.min()


def test_of_a_stretch_that_is_followed_all_turns_are() -> None:
    """Of which only a part is kept whole where all stretches have some."""
    t = np.arange(30_000) / 1000.0
    speed = 2 * np.pi * 4.0
    x, v = (np.tile(c, 4) for c in (np.sin(speed * t) * 0.06 / speed, 0.06 * np.cos(speed * t)))
    force = 200 * x + 60 * v + 10.0 * np.tanh(v / 3e-3)
    log = recording(v, x=x, duty=0.1, force=force, t=np.tile(t, 4), starts=np.arange(5) * len(t))
    few = thinned(prepare(log), MOST // 2)
    s, has_weight = few.block.signals, few.block.weight > 0
    near = has_weight & (s.since_reversal < 0.8 * thresholds.AFTER)
    near[s.starts[:-1]] = False
    assert near.sum() > 0.3 * has_weight.sum()
    assert s.step[np.flatnonzero(near) - 1].max() < 1.5 * thresholds.FINE_STEP
    every = np.flatnonzero(has_weight)
    assert every.size > 0.7 * np.isin(few.stretch, few.stretch[every]).sum()


def test_of_records_of_which_some_are_fast_these_are_cut() -> None:
    """Three wheels that hop, and one that does not, of which all is searched."""
    whole = hopping(60.0, 2.0).recording
    t = whole.t[whole.slices[0]]
    x, xdot = whole.x.copy(), whole.xdot.copy()
    x[whole.slices[0]], xdot[whole.slices[0]] = 0.02 * np.sin(t), 0.02 * np.cos(t)
    few = thinned(prepare(replace(whole, x=x, xdot=xdot)), MOST)
    has_weight = few.block.weight > 0
    stretches = [len(np.unique(few.stretch[p][has_weight[p]])) for p in few.recording.slices]
    assert stretches[0] == len(np.unique(few.stretch[few.recording.slices[0]]))
    assert max(stretches[1:]) < 0.5 * stretches[0]


@pytest.mark.parametrize(
    ("name", "near"),
    [
        *((n, 1e-3) for n in ("mount_compliance", "signed_yield_lag", "thermal_fade", "backlash")),
        ("force_smoothing", 0.05),  # over a part of the cycle, which few samples tell less well
    ],
)
def test_what_is_followed_has_forgotten_what_is_left_out(name: str, near: float) -> None:
    """Forces of a damper with a lag, and with what has a memory of its own, are those of all."""
    rng = np.random.default_rng(4)
    log = hopping(60.0, 2.0).recording
    duty = rng.choice([0.05, 0.2, 0.5], len(log) // 60)[np.arange(len(log)) // 60]
    whole = prepare(replace(log, duty=duty))
    few = thinned(whole, MOST)
    model = Model((get(name),))
    values = {n: q.start for n, q in model.quantities.items()}
    for way in ("compression", "release"):
        values |= {f"{way}.T_d": 0.03, f"{way}.sigma": 12.0, f"{way}.beta": 0.5}
    expected = model.force(whole.block.signals, values)[_rows(whole, few)]
    off = (model.force(few.block.signals, values) - expected)[few.block.weight > 0]
    assert np.sqrt(np.mean(off**2)) < near * np.std(expected)


def _rows(whole: Problem, few: Problem) -> Index:
    """Rows of all samples that are those of some."""
    return np.flatnonzero(np.isin(_clock(whole.recording), _clock(few.recording)))
