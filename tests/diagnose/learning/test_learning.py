"""What no effect of the catalogue explains is learned, and only that."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, gas_that_warms, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.learning.closed_forms import closed_forms
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.parameters import parse_parameters
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.simulate import simulate

FEW = ["coulomb_friction", "fluid_inertia", "quadratic_damping"]
STIFFNESS, TAU = 600.0, 0.25  # N/m, s, of a gas that warms and cools as it is compressed


def found(r: Recording) -> Diagnosis:
    return diagnose(r, [get(n) for n in FEW], limits=False)


@pytest.fixture(scope="module")
def warmed() -> Diagnosis:
    return found(noisy(gas_that_warms(campaign(100.0, 8.0), STIFFNESS, TAU), seed=31))


def test_the_law_is_said_as_an_equation(warmed: Diagnosis) -> None:
    assert warmed.verdict is Verdict.UNEXPLAINED
    assert warmed.learned is not None
    (law,) = warmed.learned.laws
    assert (law.law.slot, law.law.curve.coordinate) == ("force", "fresh_x")
    assert law.law.curve.form == "line"
    assert law.tau == pytest.approx(TAU, rel=0.05)
    (z,) = law.z
    slope = (law.f[-1] - law.f[0]) / (z[-1] - z[0])
    assert slope == pytest.approx(STIFFNESS, rel=0.05)
    assert not warmed.lack_of_fit.significant


def test_its_errors_hold(warmed: Diagnosis) -> None:
    estimates = parameters(warmed).estimates
    assert warmed.learned is not None
    (law,) = warmed.learned.laws
    tau = estimates[law.finding.effect.key("tau")]
    assert tau.interval is not None
    low, high = tau.interval
    assert low - (high - low) < TAU < high + (high - low)  # of one log: three standard errors


def test_it_is_told_with_the_values_that_are_written(warmed: Diagnosis) -> None:
    """Curve and time constant were those of the search, a step before the parameters beside."""
    assert warmed.learned is not None
    (law,) = warmed.learned.laws
    key, (z,) = law.finding.effect.key, law.z
    size, tau = (parameters(warmed).estimates[key(s)].value for s in ("a", "tau"))
    assert law.tau == tau
    assert size is not None
    assert law.f == pytest.approx(size * z / np.abs(z).max(), rel=1e-9, abs=1e-12)


def test_the_document_holds_what_the_contract_asks_for(warmed: Diagnosis) -> None:
    document = json.loads(json.dumps(to_json(warmed)))
    assert document["verdict"] == "unexplained"
    (law,) = document["learned"]
    assert law["slot"] == "force"
    (z,) = law["coordinates"]
    assert z["name"] == "fresh_x"
    assert z["unit"] == "m"
    assert z["low"] < 0.0 < z["high"]
    assert law["heldout"]["nrmse_after"] < 0.5 * law["heldout"]["nrmse_before"]
    assert len(law["curve"]["z"]) == len(law["curve"]["f"])
    assert "the data say" in document["remaining"]["text"]
    assert "none of the " in document["remaining"]["text"]
    assert "is noise" in document["remaining"]["text"]


def test_what_it_writes_is_simulated_and_right_where_it_was_not_fitted(warmed: Diagnosis) -> None:
    written = json.dumps(to_json(warmed)["corrected"]["params"]).encode()
    fresh = gas_that_warms(campaign(100.0, 5.0), STIFFNESS, TAU)
    corrected = simulate(parse_parameters(written, "corrected"), fresh)
    base = to_json(warmed)["baseline"]["params"]
    paper = simulate(parse_parameters(json.dumps(base).encode(), "paper"), fresh)
    assert fresh.force is not None
    errors = [float(np.std(fresh.force - f)) for f in (paper, corrected)]
    assert errors[1] < 0.1 * errors[0]


def test_where_nothing_is_left_nothing_is_learned() -> None:
    r = noisy(campaign(100.0, 8.0), seed=32)
    assert found(r).learned is None
    assert "learned" not in to_json(found(r))


def test_what_the_catalogue_explains_is_not_learned() -> None:
    r = noisy(campaign(100.0, 8.0), seed=33)
    assert r.force is not None
    log = replace(r, force=r.force + 2.0 * np.sign(r.xdot))
    friction = found(log)
    assert [f.effect.name for f in friction.findings] == ["coulomb_friction"]
    assert friction.learned is None


@pytest.mark.long
@pytest.mark.untraced
def test_an_effect_beside_a_law_keeps_its_name() -> None:
    r = noisy(gas_that_warms(campaign(100.0, 8.0), STIFFNESS, TAU), seed=34)
    assert r.force is not None
    both = found(replace(r, force=r.force + 3.0 * np.sign(r.xdot)))
    assert [f.effect.name for f in both.findings] == ["coulomb_friction"]
    friction = parameters(both).estimates["coulomb_friction.F_c"].value
    assert friction == pytest.approx(3.0, rel=0.05)
    assert both.learned is not None
    assert [law.law.curve.coordinate for law in both.learned.laws] == ["fresh_x"]
    assert both.fit.values["compression.k_nom"] == pytest.approx(
        TRUTH["compression.k_nom"], rel=0.1
    )


def test_closed_forms_of_any_curve_are_numbers() -> None:
    """A bell far narrower than the curve has no value that no size makes up for."""
    rng = np.random.default_rng(4)
    knots = tuple(np.linspace(0.0051, 0.0168, 8).tolist())
    law = Law(LawSlot.FRICTION, Curve("largest_x", knots))
    for _ in range(20):
        values = dict(zip((f"f_{k + 1}" for k in range(8)), rng.standard_normal(8), strict=True))
        strokes = rng.uniform(knots[0], knots[-1], 6)  # one of each record, and nothing between
        z = np.sort(rng.choice(strokes, 400))
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            found = closed_forms(law, values, z)
        assert all(np.isfinite(v) for _, own in found for v in own.values())
