"""What a parameter file may leave out, and intervals that it may hold."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest
from places import ROOT

from erdctl.core.errors import InputProblem
from erdctl.io.parameters import parse_parameters, to_document

TABLE_2 = json.loads((Path(ROOT) / "fixtures" / "table_2.json").read_text())


def with_fault(parameters: dict[str, Any]) -> bytes:
    effects = [{"effect": "oil_leakage", "parameters": parameters}]
    return json.dumps({**TABLE_2, "effects": effects}).encode()


def test_a_fault_without_a_ramp_sets_in_at_once() -> None:
    """As files say it that were written before faults could ramp."""
    found = parse_parameters(with_fault({"f": 0.5, "t_0": 13.0}), "old.json")
    assert found.values["oil_leakage.t_r"] == 0.0
    assert found.values["oil_leakage.t_0"] == 13.0
    with pytest.raises(InputProblem, match="expected the parameters f, t_0, t_r"):
        parse_parameters(with_fault({"f": 0.5}), "old.json")


def test_an_interval_travels_with_its_unit() -> None:
    given = {"value": 13000.0, "unit": "ms", "interval": [12990.0, 13020.0]}
    found = parse_parameters(with_fault({"f": 0.5, "t_0": given}), "p.json")
    assert found.estimates["oil_leakage.t_0"].interval == pytest.approx((12.99, 13.02))
    again = parse_parameters(msgspec.json.encode(to_document(found)), "p.json")
    assert again.estimates["oil_leakage.t_0"].within == pytest.approx((12.99, 13.02))
    plain = {"value": 13.0, "unit": "s", "stderr": 0.5}
    found = parse_parameters(with_fault({"f": 0.5, "t_0": plain}), "p.json")
    assert found.estimates["oil_leakage.t_0"].interval == pytest.approx((12.02, 13.98))


def test_a_standard_error_below_zero_is_refused() -> None:
    """As in a campaign's table."""
    given = {"value": 13.0, "unit": "s", "stderr": -0.5}
    with pytest.raises(InputProblem, match=r"error of oil_leakage.t_0 is -0.5; expected 0 or more"):
        parse_parameters(with_fault({"f": 0.5, "t_0": given}), "p.json")
