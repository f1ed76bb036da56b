"""What `mimic` says of a sequence is of the one that is sent, and nothing is sent in silence."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from places import FIXTURES
from rig import recording

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Recording
from erdctl.io.parameters import parse_parameters
from erdctl.io.pwm import manifest, table
from erdctl.mimic.sequence import PwmSequence, held_back, idle, sequence, worth
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import parse_fault
from erdctl.score.nrmse import nrmse

DELAY = {"effect": "input_delay", "parameters": {"tau": {"value": 0.03, "unit": "s"}}}


def motion(duty: float = 0.3) -> Recording:
    t = np.arange(1000) / 200
    w = 2 * np.pi * 1.2
    return recording(t, 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t), np.full(len(t), duty))


def planned(
    r: Recording, fault: str, *, effects: tuple[dict[str, Any], ...] = (), static: bool = False,
    **limits: float,
) -> PwmSequence:  # fmt: skip
    document = json.loads((FIXTURES / "table_2.json").read_bytes()) | {"effects": list(effects)}
    given = parse_parameters(json.dumps(document).encode(), "damper.json")
    return sequence(given, r, [parse_fault(fault)], Amplifier(**limits), static=static)


def test_figures_of_a_static_inverse_are_its_own() -> None:
    found = planned(motion(), "oil=0.5@1:3", effects=(DELAY,), static=True)
    (plan,) = found.plans.values()
    sent, at = found.columns(), plan.acting
    own = nrmse(sent["force_ideal"][at], sent["force_expected"][at]).nrmse
    (reach,) = plan.reaches
    assert reach.figures(static=True) == [f"{own:.4f}"]
    assert own > 1.2 * reach.compensated  # which is not sent
    (said,) = worth(found)
    assert "removed" not in said
    assert f"{plan.correction.nrmse:.4f}" not in said
    written = manifest(
        found, amplifier=Amplifier(), parameters_sha256="", faults=[], temperature={}
    )
    assert written["correction"] == []


@pytest.mark.parametrize("duty", [0.11, 0.25, 0.37, 0.43])
def test_a_healthy_duty_at_the_limit_asks_for_no_more(duty: float) -> None:
    found = planned(motion(duty), "electrical=0.8@2:4", duty_max=duty)
    assert held_back(found) == []


def test_a_sequence_that_the_limit_cuts_is_said_to_be() -> None:
    r, fault = motion(0.28), "electrical=0.98@1:4"
    cut, free = (planned(r, fault, effects=(DELAY,), duty_max=limit) for limit in (0.2, 1.0))
    (plan,) = cut.plans.values()
    (said,) = held_back(cut)
    assert said.startswith(f"fl: at {100 * plan.limited:.2g} % of the samples")
    top = cut.duties["fl"] > 0.2 - 1e-9
    assert 0.0 < plan.limited <= np.mean(top & plan.acting)
    assert held_back(free) == []


def test_a_fault_outside_the_log_is_said_to_do_nothing() -> None:
    for fault, does in (("oil=0.5@100:200", False), ("oil=1.0", False), ("oil=0.5@1:3", True)):
        said = idle(planned(motion(), fault))
        assert bool(said) != does
        assert does or "does nothing in this log, from 0 to 4.995 s" in said[0]


def test_the_log_of_an_earlier_run_keeps_its_columns_apart() -> None:
    found = planned(motion(), "oil=0.5@1:3")
    n = np.zeros(1000)
    log = pa.table({"t": found.recording.t, "force_healthy": n + 1.0, "force": n + 2.0})
    out = table(found, log)
    assert len(set(out.column_names)) == len(out.column_names)
    assert out["force_healthy"][0].as_py() == 2.0
    assert out["force_healthy (original)"][0].as_py() == 1.0


@pytest.mark.parametrize("name", ["full_scale", "carrier"])
@pytest.mark.parametrize("value", [np.inf, np.nan, 0.0])
def test_a_scale_is_a_number(name: str, value: float) -> None:
    with pytest.raises(UsageProblem, match="finite"):
        Amplifier(**{name: value})
