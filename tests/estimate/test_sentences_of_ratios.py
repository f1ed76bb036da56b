"""A number without unit has none in a sentence, where documents have the unit 1."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from places import FIXTURES
from rig import campaign, noisy

from erdctl.core.errors import InputProblem
from erdctl.estimate.identify import identify
from erdctl.io.parameters import parse_parameters, read_parameters
from erdctl.model.simulate import remarks


def test_an_exponent_that_nothing_tells() -> None:
    r = noisy(campaign(), 3, rms=100.0)
    reasons = [e.reason for n, e in identify(r).joint.items() if n.endswith("beta") and e.reason]
    assert any("its standard error" in reason for reason in reasons)
    assert not any(" 1)" in reason for reason in reasons)


def test_an_exponent_out_of_bounds() -> None:
    document = json.loads((FIXTURES / "table_2.json").read_bytes())
    document["release"]["beta"]["value"] = 9.0
    with pytest.raises(InputProblem, match=r"release\.beta = 9 is outside 0\.02\.\.4$"):
        parse_parameters(json.dumps(document).encode(), "damper.json")


def test_a_duty_beyond_that_of_the_fit() -> None:
    r = campaign()
    found = read_parameters(str(FIXTURES / "table_2.json"))
    found = replace(found, provenance={"ranges": {"duty": [0.0, 0.1], "x": [-1e-3, 1e-3]}})
    duty, deflection = remarks(found, replace(r, duty=np.full(len(r), 0.3)))
    assert duty.startswith("duty spans 0.3..0.3, but")
    assert " m, but" in deflection
