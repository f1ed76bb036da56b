"""The words of a diagnosis on its page are those of its document."""

from __future__ import annotations

import html
import re
from dataclasses import replace
from typing import Any

import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.corrected import baseline, parameters
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.model.composed import Model
from erdctl.model.simulate import simulate
from erdctl.report.page.diagnosis import diagnosis_page
from erdctl.report.page.render import Run

FEW = [get("electrical_fault"), get("oil_leakage"), get("coulomb_friction")]


@pytest.fixture(scope="module")
def weakened() -> Diagnosis:
    """A healthy damper's parameters, and a later log with 0.7 of its yield force."""
    healthy = campaign(100.0, 8.0)
    given = parameters(diagnose(noisy(healthy, seed=1), FEW, limits=False))
    weak = {k: 0.7 * v if k.endswith("sigma") else v for k, v in TRUTH.items()}
    later = replace(healthy, force=Model(()).force(Signals.of(healthy), weak))
    return diagnose(noisy(later, seed=2), FEW, given=given)


def words(found: Diagnosis, **changed: Any) -> str:
    r = found.problem.recording
    before, after = (simulate(p, r) for p in (baseline(found), parameters(found)))
    run = Run(words=["diagnose"], logs=r.sources, labels=r.labels, details=[])
    document = to_json(found) | changed
    page = diagnosis_page(document, r, before=before, after=after, run=run)
    return re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", "", page)))


def test_units_keep_their_capitals(weakened: Diagnosis) -> None:
    """What remains was "0.3 n rms", and a friction of which much would have shown "f_c = 0.2 n"."""
    text = to_json(weakened)["remaining"]["text"]
    assert "F_c = " in text
    assert text[1:] in words(weakened)


def test_what_became_of_given_parameters_is_on_the_page(weakened: Diagnosis) -> None:
    """It said that the model holds, and of the fault that the command warns of not a word."""
    document = to_json(weakened)
    assert document["verdict"] == "adequate"
    assert document["as_fault"]["effect"] == "electrical_fault"
    said = words(weakened)
    assert f"The given parameters do not hold: {document['as_fault']['text']}." in said


def test_what_did_not_earn_a_name_is_not_said_to_improve_nothing(weakened: Diagnosis) -> None:
    """Friction that took 33 % of what was missing was withdrawn, and "improves" nothing."""
    said = words(weakened, withdrawn=["coulomb_friction"])
    assert "No effect was named." in said
    assert "of the effects that were asked for none has earned a name" in said


def test_a_misfit_in_no_one_place_is_not_everywhere_alike(weakened: Diagnosis) -> None:
    """A force that swings with the deflection gathers in no interval of it, and is not even."""
    said = words(weakened, verdict="unexplained", mismatch=[])
    assert "alike" not in said.split("Where does it not?")[1].split("Why?")[0]
    assert "In no one place" in said
