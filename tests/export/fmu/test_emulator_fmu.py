"""The emulator's FMU: the variables of the contract, and a damper's FMU driven by it."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from fmu_built import NUMBERS, Instance, built, damper, table_2

from erdctl.export.emulator.source import write_emulator
from erdctl.export.fmu.emulator import emulator_block
from erdctl.model.faults import FaultKind


@cache
def emulator(number: str) -> Path:
    c = write_emulator(table_2(), prefix="emulator", faults=tuple(FaultKind))
    return built(emulator_block(c, table_2()), number)


@pytest.fixture(params=NUMBERS)
def fmu(request: pytest.FixtureRequest) -> Path:
    return emulator(request.param)


def test_no_findings_and_the_variables_of_the_contract(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []
    variables = read_model_description(str(fmu)).modelVariables
    inputs = {v.name: v.unit for v in variables if v.causality == "input"}
    assert inputs == {
        "x": "m", "xdot": "m/s", "duty": "1", "f_oil": "1", "f_electrical": "1",
        "f_deformation": "1", "temperature": "degC",
    }  # fmt: skip
    outputs = [(v.name, v.type) for v in variables if v.causality == "output"]
    assert outputs[0] in {("duty_out", "Real"), ("duty_out", "Float64")}
    assert outputs[1:] == [("limited", "Boolean"), ("out_of_reach", "Boolean")]


def test_a_healthy_emulator_gives_the_duty_on_and_heat_closes_it(fmu: Path) -> None:
    instance = Instance(fmu).start(x=0.0, xdot=0.1, duty=0.2)
    for i in range(1, 200):
        given = instance.step(1e-3, x=1e-4 * i, xdot=0.1, duty=0.2)
    assert given == pytest.approx(0.2, rel=0.05)
    assert not instance.get("limited")
    assert instance.step(1e-3, temperature=90.0) == 0.0
    assert instance.get("limited")
    assert math.isfinite(instance.step(1e-3, temperature=math.nan, x=math.nan))
    assert instance.get("status") != 0
    instance.close()


def test_a_damper_driven_by_it_acts_as_a_faulty_one(fmu: Path) -> None:
    """Two FMUs and no other model: a healthy damper under duty_out, a faulty one under the duty."""
    number = "3" if fmu.stem.endswith("3") else "2"
    step, n = 1e-3, 3000
    t = step * np.arange(n)
    x, xdot = 0.01 * np.sin(9.0 * t), 0.09 * np.cos(9.0 * t)
    duty = np.where(np.floor(t) % 2 == 0, 0.3, 0.2)
    first, factors = {"x": x[0], "xdot": xdot[0]}, {"f_electrical": 0.7}
    online = Instance(fmu).start(**first, duty=duty[0], **factors)
    driven = Instance(damper(number)).start(**first, duty=online.get("duty_out"))
    faulty = Instance(damper(number)).start(**first, duty=duty[0], **factors)
    healthy = Instance(damper(number)).start(**first, duty=duty[0])
    forces = np.zeros((n, 3))
    for i in range(1, n):
        now = {"x": x[i], "xdot": xdot[i]}
        given = online.step(step, **now, duty=duty[i])
        forces[i] = (
            driven.step(step, **now, duty=given),
            faulty.step(step, **now, duty=duty[i]),
            healthy.step(step, **now, duty=duty[i]),
        )
    error = np.std(forces[200:, 0] - forces[200:, 1]) / np.ptp(forces[:, 1])
    healthy_error = np.std(forces[200:, 2] - forces[200:, 1]) / np.ptp(forces[:, 1])
    assert error < 0.02
    assert error < 0.2 * healthy_error
    for instance in (online, driven, faulty, healthy):
        instance.close()
