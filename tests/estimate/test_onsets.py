"""When something sets in: against least squares by brute force, and intervals against the truth."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from by_hand import signals
from scipy.signal import lfilter

from erdctl.core.blocks import Block
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.estimate.least_squares import fit
from erdctl.estimate.onset_profile import Profile
from erdctl.estimate.onsets import onset_intervals, profile_within
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

STEP = 0.01
FAULTS = [get(name) for name in ("oil_leakage", "electrical_fault", "deformation_fault")]
every = pytest.mark.parametrize("effect", FAULTS, ids=lambda e: e.name)
DAMPER = {
    f"{way}.{symbol}": value
    for way in ("compression", "release")
    for symbol, value in {
        "k_nom": 200.0, "c_vis": 70.0, "T_d": 0.02, "sigma": 20.0, "beta": 0.5,
    }.items()
}  # fmt: skip
HELD = {name: value for name, value in DAMPER.items() if name.endswith(("T_d", "beta"))}


def drive(seconds: float = 8.0) -> Signals:
    """Two tones, so that no time of the record is like another."""
    t = np.arange(round(seconds / STEP)) * STEP
    x = 0.01 * np.sin(2 * np.pi * 0.9 * t) + 0.004 * np.sin(2 * np.pi * 2.3 * t + 1.0)
    xdot = 0.018 * np.pi * np.cos(2 * np.pi * 0.9 * t)
    xdot += 0.0184 * np.pi * np.cos(2 * np.pi * 2.3 * t + 1.0)
    return signals(xdot, x=x, t=t, duty=0.4)


def faulty(s: Signals, effect: Effect, f: float, t_0: float, t_r: float) -> Array:
    """Force of the damper by its equations at constant duty, with one of the three faults."""
    come = np.clip((s.t - t_0) / t_r, 0.0, 1.0) if t_r > 0 else (s.t >= t_0).astype(float)
    left = 1.0 - come * (1.0 - f)
    gas, viscous, ER = 200.0 * s.x, 70.0 * s.xdot, 20.0 * 0.4**0.5 * np.sign(s.xdot)
    match effect.name:
        case "oil_leakage":
            return np.asarray(left * (gas + viscous + ER))
        case "electrical_fault":
            return np.asarray(gas + viscous + left * ER)
        case _:
            return np.asarray(gas + left * (viscous + ER))


def noise(n: int, seed: int, rho: float) -> Array:
    e = np.random.default_rng(seed).standard_normal(n + 500)
    return np.asarray(0.4 * lfilter([np.sqrt(1 - rho * rho)], [1.0, -rho], e)[500:])


def at_first(s: Signals, effect: Effect, force: Array) -> tuple[Model, Block, dict[str, float]]:
    block = Block(s, force, np.ones(len(s)))
    start = {effect.key("f"): 0.7, effect.key("t_0"): 2.0, effect.key("t_r"): 0.0}
    return Model((effect,)), block, DAMPER | start


@every
def test_what_an_onset_leaves_is_what_least_squares_leave(effect: Effect) -> None:
    """For given f, onset and ramp the model is linear in the rest: solved outright."""
    s = drive()
    model, block, values = at_first(s, effect, faulty(s, effect, 0.5, 3.0, 0.0))
    found = profile_within(model, effect, block, values, HELD)
    for f, t_0, t_r in [(0.5, 3.005, 0.0), (0.8, 5.005, 0.0), (0.3, 2.0, 2.5), (0.9, 0.4, 7.0)]:
        p = {effect.key("f"): f, effect.key("t_0"): t_0, effect.key("t_r"): t_r}
        columns = model.columns(s, DAMPER | p)
        rest = np.linalg.lstsq(columns.T, block.force, rcond=None)
        square = float(np.sum((block.force - rest[0] @ columns) ** 2))
        assert found.least(t_0, t_r, f).square <= square * (1 + 1e-9) + 1e-9
        TA, AA = found._sums(t_0, t_r)
        given = found._schur((found.total - (1 - f) * (TA + TA.T) + (1 - f) ** 2 * AA)[None])[0]
        assert given == pytest.approx(square, rel=1e-5, abs=1e-6 * float(block.force @ block.force))


@pytest.mark.few(1)
@every
def test_the_best_is_the_best_of_all_times(effect: Effect) -> None:
    s = drive(4.0)
    force = faulty(s, effect, 0.75, 2.2, 0.0) + noise(len(s), 3, 0.8)
    model, block, values = at_first(s, effect, force)
    found = profile_within(model, effect, block, values, HELD)
    least = np.inf
    for f, edge in product(np.linspace(0.5, 0.95, 19), found.edges[5:-5:2]):
        p = {effect.key("f"): f, effect.key("t_0"): edge, effect.key("t_r"): 0.0}
        columns = model.columns(s, DAMPER | p)
        rest = np.linalg.lstsq(columns.T, force, rcond=None)[0]
        least = min(least, float(np.sum((force - rest @ columns) ** 2)))
    assert found.best().square <= least * (1 + 1e-6)


@every
@pytest.mark.parametrize(("t_0", "t_r"), [(1.3, 0.0), (6.9, 0.0), (2.0, 3.0)])
def test_a_fit_finds_it_from_anywhere(effect: Effect, t_0: float, t_r: float) -> None:
    """From a start at the other end of the record, where no step towards a lower cost leads."""
    s = drive()
    model, block, values = at_first(s, effect, faulty(s, effect, 0.6, t_0, t_r))
    values |= {effect.key("t_0"): 7.5 - t_0}
    found = fit(model, block, start=values, fixed=HELD).values
    assert found[effect.key("f")] == pytest.approx(0.6, abs=2e-3)
    assert found[effect.key("t_0")] == pytest.approx(t_0, abs=2 * STEP)
    assert found[effect.key("t_r")] == pytest.approx(t_r, abs=4 * STEP)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("rho", "used", "loud"),
    [
        (0.0, 1.0, 1.0),
        (0.95, 1.0, 1.0),
        *(pytest.param(*of, marks=pytest.mark.long) for of in ((0.0, 0.25, 1.0), (0.0, 1.0, 8.0))),
    ],
)
def test_intervals_hold_the_truth(rho: float, used: float, loud: float) -> None:
    """Of steps and ramps of all kinds; with 95 % more than six of 48 fail once in 100 times.

    Also where most samples have no weight, as those of a car at rest: they are no noise of 0. And
    where it sets in in the loudest part of a log.
    """
    s, outside, widest = drive(), 0, 0.0
    for seed in range(2000, 2024):
        rng, effect = np.random.default_rng([seed, 7]), FAULTS[seed % 3]
        t_0, t_r = rng.uniform(1.0, 5.0), rng.uniform(0.5, 2.5) * (seed % 2)
        own = noise(len(s), seed, rho) * np.where(np.abs(s.t - t_0 - 0.5 * t_r) < 0.3, loud, 1.0)
        force = faulty(s, effect, 0.5, t_0, t_r) + own
        model, block, values = at_first(s, effect, force)
        block = Block(s, force, (rng.random(len(s)) < used).astype(float))
        fitted = fit(model, block, start=values, fixed=HELD).values
        found = onset_intervals(model, block, fitted, HELD)
        (low, high), ramp = found[effect.key("t_0")], found[effect.key("t_r")]
        outside += (not low <= t_0 <= high) + (not ramp[0] <= t_r <= ramp[1])
        widest = max(widest, high - low)
    assert outside <= 6, outside
    assert widest < 3.0  # and they say something


def test_a_ramp_that_outlasts_the_record_may_be_longer() -> None:
    """How long it would have lasted nobody can say who saw a half of it: f makes up for it."""
    s, effect = drive(), FAULTS[0]
    force = faulty(s, effect, 0.4, 5.0, 6.0) + noise(len(s), 5, 0.0)
    model, block, values = at_first(s, effect, force)
    fitted = fit(model, block, start=values, fixed=HELD).values
    found = onset_intervals(model, block, fitted, HELD)
    assert found[effect.key("t_0")][0] < 5.0 < found[effect.key("t_0")][1]
    assert found[effect.key("t_r")][1] > 4.0


def test_a_late_channel_does_not_delay_the_onset() -> None:
    """What the channel shows 50 ms late set in when it did."""
    s, effect, skew = drive(), FAULTS[0], get("time_skew")
    t = s.t - 0.05
    x = 0.01 * np.sin(2 * np.pi * 0.9 * t) + 0.004 * np.sin(2 * np.pi * 2.3 * t + 1.0)
    xdot = 0.018 * np.pi * np.cos(2 * np.pi * 0.9 * t)
    xdot += 0.0184 * np.pi * np.cos(2 * np.pi * 2.3 * t + 1.0)
    force = faulty(signals(xdot, x=x, t=t, duty=0.4), effect, 0.5, 3.0, 0.0)
    model, block = Model((effect, skew)), Block(s, force, np.ones(len(s)))
    start = {effect.key("f"): 0.7, effect.key("t_0"): 2.0, effect.key("t_r"): 0.0}
    held = HELD | {skew.key(q.symbol): 0.05 for q in skew.quantities}
    found = fit(model, block, start=DAMPER | start | held, fixed=held).values
    assert found[effect.key("t_0")] == pytest.approx(3.0, abs=2 * STEP)


def test_nothing_sets_in_where_nothing_does() -> None:
    """In noise alone no onset is worth much, whatever it is called."""
    s = drive()
    for effect in FAULTS:
        force = faulty(s, effect, 1.0, 0.0, 0.0) + noise(len(s), 11, 0.0)
        model, block, values = at_first(s, effect, force)
        found = profile_within(model, effect, block, values, HELD)
        best = found.best()
        assert best.square > 0.95 * found.square
        assert best.t_r == 0.0


def test_a_log_of_one_time_has_no_onset() -> None:
    s = signals(np.ones(1))
    at = Profile(s, s.t, np.ones((2, 1)), np.ones((2, 1))).best()
    assert (at.f, at.t_r) == (1.0, 0.0)
