"""A case from its seed: what it hides, how strongly, what it hands out."""

from __future__ import annotations

import json
from functools import partial

import numpy as np
import pyarrow as pa
import pytest
from plant_rig import EVERY, KNOWN, UNKNOWN, effect

from erdctl.plant import Case, fresh, key, log
from erdctl.plant.draw import draw as draw_of
from erdctl.plant.plan import draw_plan as draw_plan_of
from erdctl.plant.simulate import forces, rides

draw = partial(draw_of, known=KNOWN)
draw_plan = partial(draw_plan_of, known=KNOWN)

# With the seed of each: such as draw short campaigns where a simulation takes long.
SINGLES = {"mount_compliance": 81, "thermal_fade": 71, "coulomb_friction": 72, "input_delay": 73}
PAIR = 87


@pytest.fixture(scope="module")
def cases() -> dict[str, Case]:
    out = {name: draw(seed, effects=[name], level=3.0) for name, seed in SINGLES.items()}
    out["null"] = draw(80, kind="null")
    out["pair"] = draw(PAIR, kind="pair")
    out["unknown"] = draw(82, kind="unknown")
    out["measured"] = draw(83, effects=["gas_preload"], motion="measured", scatter=True)
    return out


def test_a_seed_decides_everything(cases: dict[str, Case]) -> None:
    again = draw(PAIR, kind="pair")
    assert again == cases["pair"]
    assert log(again).equals(log(cases["pair"]))
    assert fresh(again).equals(fresh(cases["pair"]))
    assert draw(82, kind="pair") != again


def test_strength_is_the_wanted_level(cases: dict[str, Case]) -> None:
    for name in SINGLES:
        case = cases[name]
        truth = case.truth[0]
        assert [t.name for t in case.truth] == [name]
        assert truth.alone == case.level
        assert case.level == pytest.approx(3.0, rel=0.12)
        assert truth.raw >= case.level * 0.999
        assert case.near <= 0.5


def test_the_key_is_json_and_says_what_is_hidden(cases: dict[str, Case]) -> None:
    for case in cases.values():
        k = key(case)
        assert json.loads(json.dumps(k)) == k
        assert [e["name"] for e in k["effects"]] == [t.name for t in case.truth]
        for e in k["effects"]:
            assert e["parameters"]
            for p in e["parameters"].values():
                assert np.isfinite(p["value"])
                assert p["unit"]


def test_the_log_has_the_contracts_columns_and_nothing_else(cases: dict[str, Case]) -> None:
    for case in cases.values():
        for table in (log(case), fresh(case)):
            assert table.column_names == ["t", "x", "xdot", "duty", "force", "record"]
            assert not table.schema.metadata
            assert pa.types.is_string(table.schema.field("record").type)
            record = np.array(table["record"].to_pylist())
            for name in np.unique(record):
                t = table["t"].to_numpy()[record == name]
                assert t[0] == 0.0
                assert (np.diff(t) > 0).all()
            values = np.array([table[c].to_numpy() for c in table.column_names[:-1]])
            assert np.isfinite(values).all()


def test_the_log_is_the_force_plus_noise(cases: dict[str, Case]) -> None:
    case = cases["coulomb_friction"]
    measured = log(case)["force"].to_numpy()
    true = forces(case.plant, rides(case.campaign))
    assert np.std(measured - true) == pytest.approx(case.force_noise.rms, rel=0.05)
    assert case.force_noise.rms / np.ptp(true) == pytest.approx(case.force_noise.fraction, rel=0.5)


def test_fresh_records_are_exact_and_new(cases: dict[str, Case]) -> None:
    case = cases["measured"]
    over = rides(case.fresh)
    table = fresh(case)
    v = np.concatenate([r.sampled()[2] for r in over])
    assert np.array_equal(table["xdot"].to_numpy(), v)
    assert np.array_equal(table["force"].to_numpy(), forces(case.plant, over))
    logged = {r.motion for r in case.campaign.records}
    assert not logged & {r.motion for r in case.fresh.records}


def test_gains_scatter_only_on_request(cases: dict[str, Case]) -> None:
    assert set(cases["pair"].gains) == {1.0}
    assert 0.005 < np.std(cases["measured"].gains) < 0.12
    assert len(cases["measured"].gains) == len(cases["measured"].campaign.records)


def test_kinds(cases: dict[str, Case]) -> None:
    assert cases["null"].truth == ()
    assert cases["null"].level < 0.01
    assert cases["null"].regions == ()
    first, second = cases["pair"].truth
    assert effect(first.name).family != effect(second.name).family
    assert cases["unknown"].truth[0].name in UNKNOWN
    assert not cases["unknown"].truth[0].catalogued
    assert cases["thermal_fade"].concealment == "not_logged"
    assert cases["mount_compliance"].truth[0].equivalent == ("fluid_compressibility",)


def test_an_absorbed_case_looks_good_and_fails_elsewhere() -> None:
    case = draw(3000, kind="single", effects=["field_threshold"], concealment="absorbed")
    assert case.concealment == "absorbed"
    assert case.own_nrmse < 0.1
    assert case.fresh_nrmse > 1.5 * case.own_nrmse


def test_what_was_not_logged_can_be_asked_for() -> None:
    drawn = {
        draw_plan(s, kind="single", concealment="not_logged").effects[0].name for s in range(40)
    }
    faults = {"oil_leakage", "electrical_fault", "deformation_fault"}
    assert drawn == {"thermal_fade", "gas_thermal_drift", *faults}


def test_wishes_that_cannot_be_met_are_refused() -> None:
    with pytest.raises(ValueError, match="kind is 'double'"):
        draw(0, kind="double")
    with pytest.raises(ValueError, match="colour is 'blue'"):
        draw(0, colour="blue")
    with pytest.raises(ValueError, match="hides a temperature"):
        draw(0, effects=["backlash"], concealment="not_logged")
    with pytest.raises(ValueError, match="no such effect"):
        draw(0, effects=["rust"])
    with pytest.raises(ValueError, match="fill the same place"):
        draw(0, kind="pair", effects=["coulomb_friction", "stribeck_friction"])


def test_levels_lie_in_the_bands() -> None:
    singles = [draw_plan(s, kind="single").levels[0] for s in range(300)]
    assert min(singles) >= 0.2
    assert max(singles) <= 10.0
    assert {sum(s > edge for edge in (1.0, 2.0)) for s in singles} == {0, 1, 2}
    clear = [level for s in range(100) for level in draw_plan(s, kind="pair").levels]
    assert min(clear) >= 2.0
    assert draw_plan(1, kind="single", level=0.7).levels == (0.7,)


def test_every_effect_is_drawn() -> None:
    plans = [draw_plan(s) for s in range(600)]
    assert {e.name for p in plans for e in p.effects} == set(EVERY)
    assert {p.kind for p in plans} == {"single", "pair", "null", "unknown"}
