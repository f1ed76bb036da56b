"""What an effect adds to a real log: the plant on the log's own motion."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from plant_rig import DAMPER, campaign, effect

from erdctl.plant.on_log import Logged, OnLog, stage
from erdctl.plant.simulate import force, rides
from erdctl.plant.twins import every
from erdctl.prove.on_log import with_all


def logged() -> list[Logged]:
    out = []
    for i, r in enumerate(rides(campaign())):
        t, x, v = r.sampled()
        out.append(Logged(f"r{i}", t, x, v, r.duty))
    return out


@pytest.fixture(scope="module")
def on_log() -> OnLog:
    sides = [s._asdict() for s in (DAMPER.compression, DAMPER.release)]
    return stage(logged(), sides)


def test_the_motion_of_the_log_is_the_motion_of_the_plant(on_log: OnLog) -> None:
    for ride, r in zip(on_log.over, logged(), strict=True):
        _, x, v = ride.sampled()
        assert np.abs(v - r.xdot).max() < 1e-9
        assert np.abs(x - r.x).max() < 0.01 * np.ptp(r.x)


@pytest.mark.parametrize("name", ["coulomb_friction", "backlash", "fluid_inertia", "input_delay"])
def test_what_is_added_is_what_the_plant_itself_would(on_log: OnLog, name: str) -> None:
    """The campaign in closed form, and its samples as a log: the same effect, the same force."""
    twin, over = effect(name), rides(campaign())
    shape = {k: 0.5 * (a + b) for k, (a, b) in twin.shape.items()}
    built = twin.build(DAMPER, twin.start, shape, on_log.scales)
    true = np.concatenate([force(built, r) - force(DAMPER, r) for r in over])
    added = on_log.added(twin, twin.start, shape)
    settled = np.concatenate([r.sampled()[0] > 0.3 for r in over])
    assert np.std((added - true)[settled]) < 0.15 * np.std(true[settled])


def test_nothing_of_an_effect_adds_nothing(on_log: OnLog) -> None:
    twin = effect("coulomb_friction")
    assert np.abs(on_log.added(twin, 0.0, {})).max() == 0.0
    assert on_log.parameters(twin, 0.01, {}) == {"F_c": pytest.approx(0.01 * on_log.scales.force)}


def test_gaps_and_jitter_keep_every_sample(on_log: OnLog) -> None:
    r = logged()[1]
    kept = np.flatnonzero(np.arange(len(r.t)) % 97 != 5)
    holed = Logged("holed", r.t[kept], r.x[kept], r.xdot[kept], r.duty[kept])
    sides = [s._asdict() for s in (DAMPER.compression, DAMPER.release)]
    twin = effect("coulomb_friction")
    whole = stage([r], sides).added(twin, 0.05, {})[kept]
    added = stage([holed], sides).added(twin, 0.05, {})
    assert added.shape == kept.shape
    assert np.median(np.abs(added / whole - 1.0)) < 0.05


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("mount_compliance", {"s_m": 2e-6}),
        ("time_skew", {"tau": -0.008}),
        ("coulomb_friction", {"F_c": 300.0}),
        ("backlash", {"g": 4e-4}),
        ("presliding_friction", {"F_c": 117.0, "x_d": 2e-7}),
    ],
)
def test_the_damper_of_a_log_has_what_is_known_of_it(
    on_log: OnLog, name: str, values: dict[str, float]
) -> None:
    """Of the values that a law was found to have, whatever strengths are usually hidden."""
    there = on_log.also_with(effect(name), values)
    law = effect(name).law
    assert there is not None
    assert law is not None
    found = law(there.base)[1]
    for symbol, value in values.items():
        assert found[symbol] == pytest.approx(value, rel=0.05)
    assert np.abs(there.plain - on_log.plain).max() > 0.0


def test_behind_a_soft_mount_an_effect_adds_another_force(on_log: OnLog) -> None:
    soft = on_log.also_with(effect("mount_compliance"), {"s_m": 1e-4})
    assert soft is not None
    twin, other = effect("quadratic_damping"), {}
    before, behind = (s.added(twin, twin.start, other) for s in (on_log, soft))
    assert np.std(behind - before) > 0.05 * np.std(before)


def test_a_law_that_no_twin_has_is_left_out(on_log: OnLog) -> None:
    assert on_log.also_with(effect("gas_polytropic"), {"gamma": 40.0, "a": 1e6}) is None


def test_what_the_force_channel_does_it_does_to_all_that_was_recorded(on_log: OnLog) -> None:
    """Steps that the plain damper has not, as those of a rig, are averaged with the rest."""
    twin = effect("force_smoothing")
    rig = np.concatenate([np.where(np.arange(len(r.t)) % 50 < 25, 20.0, -20.0) for r in logged()])
    force = on_log.plain + rig
    averaged = on_log.with_effect(twin, 0.3, {}, force)
    left = averaged - on_log.plain - on_log.added(twin, 0.3, {})
    assert np.std(left) < 0.5 * np.std(rig)


@pytest.mark.parametrize("name", ["coulomb_friction", "time_skew", "force_offset", "force_drift"])
def test_an_effect_in_a_plain_log_is_what_it_adds_to_a_plain_damper(
    on_log: OnLog, name: str
) -> None:
    twin = effect(name)
    shape = {k: 0.25 * (3 * a + b) for k, (a, b) in twin.shape.items()}
    added = on_log.added(twin, twin.start, shape)
    force = on_log.with_effect(twin, twin.start, shape, on_log.plain)
    assert (
        np.std(force - on_log.plain - added) < 0.3 * np.std(added) + 1e-9
    )  # jumps between samples
    assert np.mean(force - on_log.plain) == pytest.approx(np.mean(added), abs=0.1 * np.ptp(added))


def test_a_channel_of_the_log_is_not_applied_again(on_log: OnLog) -> None:
    """What was recorded late is late already: a drift is all that is new."""
    late = on_log.also_with(effect("time_skew"), {"tau": 0.008})
    assert late is not None
    twin, shape = effect("force_drift"), {k: a for k, (a, _) in effect("force_drift").shape.items()}
    drifted = late.with_effect(twin, twin.start, shape, late.plain)
    assert drifted - late.plain == pytest.approx(late.added(twin, twin.start, shape), abs=1e-6)


@pytest.mark.long
def test_a_damper_has_as_many_effects_as_go_together(on_log: OnLog) -> None:
    """Any that a log may be said to have: what the plant cannot simulate beside others is left."""
    random = np.random.default_rng(7)
    twins = [t for t in every().values() if t.law is not None]
    laws = []
    for twin in twins:
        shape = {k: 0.5 * (a + b) for k, (a, b) in twin.shape.items()}
        _, values = twin.law(twin.build(on_log.base, twin.start, shape, on_log.scales))
        laws.append((twin, values))
    clashes = 0
    for _ in range(60):
        chosen = [laws[k] for k in random.permutation(len(laws))[:3]]
        clashes += any(not a.goes_with(b) for (a, _), (b, _) in combinations(chosen, 2))
        first = on_log.also_with(*chosen[0])
        assert (with_all(on_log, chosen) is on_log) <= (first is None)
    assert clashes > 3


def test_a_log_that_tells_no_lag_and_no_spring_can_hide_all(on_log: OnLog) -> None:
    """As of a real damper at held currents: its diagnosis has T_d = 0, and often k_nom = 0."""
    sides = [s._asdict() | {"T_d": 0.0, "k_nom": 0.0} for s in (DAMPER.compression, DAMPER.release)]
    poor = stage(logged(), sides)
    for name, twin in every().items():
        shape = twin.drawn(np.random.default_rng(3))
        added = poor.added(twin, twin.start, shape)
        assert np.isfinite(added).all(), name
