"""Where a misfit lives, on misfits that were put there."""

from __future__ import annotations

import numpy as np
import pytest
from plant_rig import hidden, over, plain, samples

from erdctl.plant.regions import MisfitRegion, near_reversals, overlap, regions, turns, variables
from erdctl.plant.simulate import forces


def found(misfit: np.ndarray) -> dict[str, MisfitRegion]:
    return {r.variable: r for r in regions(samples(), plain(), misfit)}


def test_a_misfit_at_low_speed() -> None:
    v = samples().v
    region = found(np.where(np.abs(v) < 0.01, 1.0, 0.02))["xdot"]
    assert overlap(region, (-0.01, 0.01)) > 0.9
    assert region.share > 0.9


def test_a_misfit_at_the_end_of_the_stroke() -> None:
    region = found(np.maximum(samples().x - 0.009, 0.0))["x"]
    assert overlap(region, (0.009, float(samples().x.max()))) > 0.6


def test_a_misfit_at_high_speed_either_way() -> None:
    """Two intervals, either of which holds less than one must have."""
    v = samples().v
    fast = 0.7 * np.abs(v).max()
    two = [
        r
        for r in regions(samples(), plain(), np.where(np.abs(v) > fast, 1.0, 0.02))
        if r.variable == "xdot"
    ]
    assert sorted(np.sign(r.low + r.high) for r in two) == [-1.0, 1.0]
    for r in two:
        low, high = sorted((np.sign(r.low + r.high) * fast, np.sign(r.low + r.high) * fast / 0.7))
        assert overlap(r, (low, high)) > 0.8
    one_way = regions(samples(), plain(), np.where(v > fast, 1.0, 0.02))
    assert sum(r.variable == "xdot" for r in one_way) == 1


def test_a_misfit_after_events() -> None:
    known = variables(samples(), plain())
    for name, time in (("since_reversal", 0.05), ("since_duty_step", 0.08), ("t", 1.1)):
        value = np.where(np.isfinite(known[name]), known[name], np.inf)
        region = found(np.where(value < time, 1.0, 0.01))[name]
        assert overlap(region, (0.0, time)) > 0.7


def test_a_misfit_at_high_duty() -> None:
    region = found(np.where(samples().duty > 0.3, 1.0, 0.01))["duty"]
    assert overlap(region, (0.35, 0.5)) > 0.6


def test_a_misfit_everywhere_has_no_region() -> None:
    assert found(np.random.default_rng(0).standard_normal(len(plain()))) == {}
    assert regions(samples(), plain(), np.zeros(len(plain()))) == ()


def test_the_tightest_region_comes_first() -> None:
    effect = forces(hidden("end_stop", 1.0), over()) - plain()
    listed = regions(samples(), plain(), effect)
    assert "x" in {r.variable for r in listed}
    tight = [r.share - r.time for r in listed]
    assert tight == sorted(tight, reverse=True)


def test_time_and_energy_restart_with_each_record() -> None:
    known = variables(samples(), plain())
    starts = samples().starts[:-1]
    assert (known["t"][starts] == 0).all()
    assert (known["dissipated_energy"][starts] < 1e-2).all()
    assert np.isnan(known["since_reversal"][starts]).all()
    assert (np.diff(known["dissipated_energy"][: starts[1]]) >= 0).all()


def test_overlap_by_hand() -> None:
    region = MisfitRegion("x", 0.0, 2.0, 1.0, 0.1, 0.1)
    assert overlap(region, (1.0, 3.0)) == pytest.approx(1 / 3)
    assert overlap(region, (4.0, 5.0)) == 0.0


def test_near_reversals_counts_two_samples_on_either_side() -> None:
    v = samples().v
    first = np.flatnonzero(turns(v[: samples().starts[1]]))
    at = np.zeros(len(v))
    at[first] = 1.0
    assert near_reversals(samples(), at) == 1.0
    assert near_reversals(samples(), np.roll(at, 1)) == 1.0
    assert near_reversals(samples(), np.roll(at, 2)) == 0.0
    assert near_reversals(samples(), np.roll(at, -2)) == 1.0
    assert near_reversals(samples(), np.roll(at, -3)) == 0.0
