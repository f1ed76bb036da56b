"""Kinds of cases that are drawn only when asked for: crowded and sparse."""

from __future__ import annotations

import json
from functools import partial
from itertools import combinations

import numpy as np
import pytest
from plant_rig import KNOWN, effect

from erdctl.diagnose.forward_step import DISTINCT
from erdctl.effects import get
from erdctl.plant import key, log
from erdctl.plant.draw import draw as draw_of
from erdctl.plant.plan import ASKED, KIND_SHARES, KINDS, STREAMS, CasePlan
from erdctl.plant.plan import draw_plan as draw_plan_of
from erdctl.plant.simulate import rides, simulate

draw = partial(draw_of, known=KNOWN)
draw_plan = partial(draw_plan_of, known=KNOWN)


@pytest.fixture(scope="module")
def crowds() -> list[CasePlan]:
    return [draw_plan(s, kind="crowded") for s in range(120)]


@pytest.fixture(scope="module")
def few() -> list[CasePlan]:
    return [draw_plan(s, kind="sparse") for s in range(300)]


def test_they_are_not_among_what_a_seed_draws_by_itself() -> None:
    assert {draw_plan(s).kind for s in range(300)} == set(KINDS)
    assert len(KINDS) == len(KIND_SHARES)
    assert not set(KINDS) & set(ASKED)
    # A stream is known by its place: new ones come last, or every seed's case changes.
    assert STREAMS[-2:] == ASKED


def test_a_crowd_is_one_strong_effect_among_two_to_four_faint_ones(crowds: list[CasePlan]) -> None:
    assert {len(p.effects) for p in crowds} == {3, 4, 5}
    assert all(4.0 <= p.levels[0] <= 10.0 for p in crowds)
    assert all(0.3 <= level <= 1.5 for p in crowds for level in p.levels[1:])
    assert len({p.effects[0].name for p in crowds}) > 20
    assert draw_plan(3, kind="crowded", level=5.0).levels[0] == 5.0


def test_one_damper_can_have_all_of_a_crowd(crowds: list[CasePlan]) -> None:
    """In the plant, and in the model that is fitted: no slot that holds one effect has two."""
    for plan in crowds:
        for a, b in combinations(plan.effects, 2):
            assert a.goes_with(b)
            assert b.goes_with(a)
            assert b.name not in a.equivalents
            assert b.name not in get(a.name).equivalents
        slots = [type(get(e.name).slot) for e in plan.effects]
        taken = [s for s in slots if s in DISTINCT]
        assert len(taken) == len(set(taken)), [e.name for e in plan.effects]


def test_a_crowd_needs_three_that_go_together() -> None:
    with pytest.raises(ValueError, match="no crowd among backlash, coulomb_friction"):
        draw_plan(0, kind="crowded", effects=["backlash", "coulomb_friction"])


def test_a_crowded_case() -> None:
    names = ["coulomb_friction", "quadratic_damping", "fluid_inertia"]
    case = draw(8, kind="crowded", effects=names, motion="exact")
    k = key(case)
    assert json.loads(json.dumps(k)) == k
    assert k["strong"] == case.truth[0].name
    assert sorted(e["name"] for e in k["effects"]) == sorted(names)
    assert case.truth[0].alone == pytest.approx(case.truth[0].wanted, rel=0.12)
    assert max(t.alone for t in case.truth[1:]) < case.truth[0].alone
    records = case.campaign.records
    force = log(case)["force"].to_numpy()
    clean = [simulate(case.plant, r) for r in records]
    left = force - np.concatenate(
        [g * f + z for g, z, f in zip(case.gains, case.zeros, clean, strict=True)]
    )
    assert np.std(left) == pytest.approx(case.force_noise.rms, rel=0.05)
    assert len(set(case.gains)) == len(set(case.zeros)) == len(records)


def test_gains_and_zeros_of_a_crowd_scatter_as_on_a_bench(crowds: list[CasePlan]) -> None:
    """By a hundredth, and by 0.3 N of 75 N: standard deviations, of some 1,300 records."""
    assert np.std([g for p in crowds for g in p.gains]) == pytest.approx(0.01, rel=0.12)
    assert np.std([z for p in crowds for z in p.zeros]) == pytest.approx(0.004, rel=0.1)


def test_a_sparse_log_shows_little(few: list[CasePlan]) -> None:
    counts, duties, speeds = set(), set(), set()
    for plan in few:
        records = plan.campaign.records
        counts.add(len(records))
        duties.add(len({level for r in records for level in r.duty.levels}))
        speeds.add(len({(r.motion.amplitudes, r.motion.frequencies) for r in records}))
        assert 2_990 <= sum(r.samples for r in records) <= 8_010
        for r in records:
            slowest = min(r.motion.frequencies)
            assert r.samples / r.rate * slowest > 1.9
            assert plan.campaign.rate / max(r.motion.frequencies) > 20
    assert counts == {1, 2, 3}
    assert duties == {1, 2}
    assert speeds == {1, 2, 3}


def test_a_third_of_the_sparse_cases_hide_nothing(few: list[CasePlan]) -> None:
    hiding = [p for p in few if p.effects]
    assert len(hiding) / len(few) == pytest.approx(2 / 3, abs=0.07)
    assert {len(p.effects) for p in hiding} == {1}
    assert min(p.levels[0] for p in hiding) >= 1.0
    assert max(p.levels[0] for p in hiding) <= 10.0
    asked = [draw_plan(s, kind="sparse", effects=["backlash"]) for s in range(20)]
    assert {e.name for p in asked for e in p.effects} == {"backlash"}


def test_sparse_cases() -> None:
    rub = draw(2, kind="sparse", effects=["coulomb_friction"], level=4.0)
    assert rub.level == pytest.approx(4.0, rel=0.12)
    law = key(rub)["law"]
    assert law == {"F_c": rub.truth[0].parameters["F_c"][0]}
    nothing = next(s for s in range(40) if not draw_plan(s, kind="sparse").effects)
    null = draw(nothing, kind="sparse")
    assert null.truth == ()
    assert key(null)["law"] == {}
    assert log(null).num_rows == sum(r.record.samples for r in rides(null.campaign))


def test_what_a_sparse_campaign_cannot_show_is_not_what_it_hides() -> None:
    """At one duty throughout a saturation is another yield force, so the loss is hidden."""
    pool = ["field_saturation", "quadratic_damping"]
    one_duty = (
        s for s in range(200)
        if len((p := draw_plan(s, kind="sparse", effects=pool)).campaign.levels) == 1
        and p.effects[0] is effect("field_saturation")
    )  # fmt: skip
    case = draw(next(one_duty), kind="sparse", effects=pool)
    assert [t.name for t in case.truth] == ["quadratic_damping"]
    assert case.level >= 0.9


@pytest.mark.long
def test_a_crowd_with_another_law_from_a_file_of_its_own_after_one() -> None:
    """The power law of the yield took the parameters of the last such law for its own."""
    names = ["power_law_yield", "gas_thermal_drift", "coulomb_friction"]
    for seed in (8, 9):
        case = draw(seed, kind="crowded", effects=names, motion="exact")
        law = effect("power_law_yield").law
        assert law is not None
        assert law(case.plant)[1] == {"n": case.plant.own_values("power_law_yield")["n"]}
