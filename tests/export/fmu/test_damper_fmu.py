"""A damper's FMU, run by FMPy: the standard's rules, the force of `simulate`, states, bad input."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from fmu_built import NUMBERS, Instance, damper, driven, table_2
from places import FIXTURES

from erdctl.core.recording import Array, Recording
from erdctl.io.logs import read_logs
from erdctl.model.simulate import simulate

CLOSE = 1e-9  # of the range of the force
FACTORS = ("f_oil", "f_electrical", "f_deformation")
BAD = (math.nan, math.inf, -math.inf)


@pytest.fixture(scope="module")
def drive() -> Recording:
    path = str(FIXTURES / "schedule_60s.parquet")
    return read_logs([path], need_force=False, report=lambda line: None).recording


@pytest.fixture(params=NUMBERS)
def fmu(request: pytest.FixtureRequest) -> Path:
    return damper(request.param)


def channels(drive: Recording) -> dict[str, Array]:
    return {"x": drive.x, "xdot": drive.xdot, "duty": drive.duty}


def part(drive: Recording, i: int) -> dict[str, float]:
    """The inputs at a sample."""
    return {name: float(values[i]) for name, values in channels(drive).items()}


def off(force: Array, expected: Array) -> float:
    return float(np.max(np.abs(force - expected)) / np.ptp(expected))


def test_no_findings(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []


def test_variables_are_those_of_the_contract_with_units_and_what_was_identified(fmu: Path) -> None:
    description = read_model_description(str(fmu))
    found = {v.name: v for v in description.modelVariables}
    inputs = {n: v.unit for n, v in found.items() if v.causality == "input"}
    faults = dict.fromkeys(FACTORS, "1")
    assert inputs == {"x": "m", "xdot": "m/s", "duty": "1", **faults}
    assert all(float(found[name].start) == 1.0 for name in faults)
    outputs = [(n, v.unit) for n, v in found.items() if v.causality == "output"]
    assert outputs == [("force", "N")]
    for name, value in table_2().values.items():
        assert found[name].variability == "tunable"
        assert float(found[name].start) == value
    units = {u.name: u.baseUnit for u in description.unitDefinitions}
    assert (units["N s/m"].kg, units["N s/m"].m, units["N s/m"].s) == (1, 0, -1)
    assert all(getattr(description.coSimulation, k) for k in (
        "canGetAndSetFMUstate", "canSerializeFMUstate", "canHandleVariableCommunicationStepSize",
    ))  # fmt: skip


def test_force_is_that_of_simulate(fmu: Path, drive: Recording) -> None:
    instance = Instance(fmu)
    force = driven(instance, channels(drive), drive.t)
    instance.close()
    assert off(force, simulate(table_2(), drive)) <= CLOSE


def test_fault_factors_are_inputs(fmu: Path, drive: Recording) -> None:
    """Eqs. 20-23 with factors that are held: F_gas and F_ER fall with the oil."""
    instance = Instance(fmu)
    factors = {"f_oil": 0.5, "f_electrical": 0.8}
    held = {name: np.full(len(drive.t), value) for name, value in factors.items()}
    force = driven(instance, channels(drive) | held, drive.t)
    instance.close()
    wanted = simulate(table_2(), drive, ["oil=0.5", "electrical=0.8"])
    assert off(force, wanted) <= CLOSE


def signals_of(drive: Recording, stop: int) -> Array:
    rows = zip(drive.t[:stop], drive.x, drive.xdot, drive.duty, strict=False)
    return np.array([*rows], dtype=[(n, float) for n in ("time", "x", "xdot", "duty")])


def test_a_master_that_sets_the_beginning_of_a_step_is_one_step_late(
    fmu: Path, drive: Recording
) -> None:
    """FMPy's own loop. The first step then repeats the first sample, which changes nothing here."""
    stop, step = 1000, float(drive.t[1] - drive.t[0])
    result = simulate_fmu(
        str(fmu), stop_time=(stop - 1) * step, output_interval=step, output=["force"],
        input=signals_of(drive, stop), step_size=step,
    )  # fmt: skip
    wanted = simulate(table_2(), drive)[: stop - 1]
    assert off(result["force"][1:stop], wanted) <= CLOSE


def test_input_derivatives_take_that_delay_away(drive: Recording) -> None:
    """The values at the end of a step: those of its beginning, and derivatives times the step."""
    instance, stop, names = Instance(damper("2")), 1000, ("x", "xdot", "duty")
    instance.start(**part(drive, 0))
    force = [instance.get("force")]
    for i in range(1, stop):
        now, then, h = part(drive, i - 1), part(drive, i), float(drive.t[i] - drive.t[i - 1])
        instance.set(**now)
        slopes = [(then[n] - now[n]) / h for n in names]
        instance.slave.setRealInputDerivatives([instance.at[n] for n in names], [1] * 3, slopes)
        force.append(instance.step(h))
    assert off(np.array(force), simulate(table_2(), drive)[:stop]) <= CLOSE
    instance.close()


def test_input_derivatives_hold_for_one_step() -> None:
    instance, k = Instance(damper("2")), table_2().values["compression.k_nom"]
    instance.start(x=0.01)
    instance.slave.setRealInputDerivatives([instance.at["x"]], [1], [2.0])
    assert instance.step(1e-3) == pytest.approx(k * 0.012, rel=1e-12)
    assert instance.step(1e-3) == pytest.approx(k * 0.01, rel=1e-12)
    instance.close()


@pytest.mark.parametrize("serialised", [False, True])
def test_a_state_restored_gives_the_same_force_bit_for_bit(
    fmu: Path, drive: Recording, serialised: bool
) -> None:
    instance = Instance(fmu).start(**part(drive, 0))

    def go(first: int, last: int) -> list[float]:
        return [instance.step(0.005, **part(drive, i)) for i in range(first, last)]

    go(1, 400)
    t, slave = instance.t, instance.slave
    kept = instance.saved()
    state = slave.getFMUState() if instance.three else slave.getFMUstate()
    once = go(400, 800)
    instance.t = t
    if serialised:
        instance.restore(kept)
    else:
        (slave.setFMUState if instance.three else slave.setFMUstate)(state)
    assert instance.get("x") == part(drive, 399)["x"]
    assert go(400, 800) == once
    (slave.freeFMUState if instance.three else slave.freeFMUstate)(state)
    # Another instance, of the same FMU, goes on from there.
    other = Instance(fmu).start()
    other.restore(kept)
    other.t = t
    assert [other.step(0.005, **part(drive, i)) for i in range(400, 800)] == once
    for one in (instance, other):
        one.close()


def test_foreign_bytes_are_no_state(fmu: Path) -> None:
    instance = Instance(fmu).start()
    kept = instance.saved()
    for bytes_ in (b"x" * len(kept), kept[:-8]):
        with pytest.raises(FMICallException):
            instance.restore(bytes_)
    assert math.isfinite(instance.step(1e-3))
    instance.close()


def test_two_instances_do_not_see_each_other(fmu: Path, drive: Recording) -> None:
    alone = Instance(fmu).start(**part(drive, 0))
    wanted = [alone.step(0.005, **part(drive, i)) for i in range(1, 300)]
    alone.close()
    one, other = Instance(fmu), Instance(fmu)
    other.start(x=0.002, xdot=0.1, duty=0.4)
    one.start(**part(drive, 0))
    found = []
    for i in range(1, 300):
        other.step(0.003, x=-0.001 * i, xdot=-0.1, duty=0.1, f_oil=0.3)
        found.append(one.step(0.005, **part(drive, i)))
    assert found == wanted
    for instance in (one, other):
        instance.close()


def test_a_parameter_can_change_while_it_runs(fmu: Path) -> None:
    """k_nom x + c_vis xdot without control: the new stiffness acts at the next sample."""
    instance = Instance(fmu)
    names = ("compression.k_nom", "compression.c_vis")
    k, c = (table_2().values[name] for name in names)
    instance.start(x=0.01, xdot=0.2)
    assert instance.get("force") == pytest.approx(k * 0.01 + c * 0.2, rel=1e-12)
    instance.set(**{"compression.k_nom": 2 * k})
    assert instance.get("force") == pytest.approx(k * 0.01 + c * 0.2, rel=1e-12)
    assert instance.step(1e-3) == pytest.approx(2 * k * 0.01 + c * 0.2, rel=1e-12)
    instance.close()


def test_a_parameter_that_makes_no_sense_is_not_taken(fmu: Path) -> None:
    instance = Instance(fmu).start(x=0.01, xdot=0.2, duty=0.3)
    before = instance.step(1e-3)
    for value in (*BAD, -1.0, 100.0):
        with pytest.raises(FMICallException):
            instance.set(**{"compression.T_d": value})
    assert instance.step(1e-3) == pytest.approx(before, rel=1e-9)
    instance.close()


@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("name", ["x", "xdot", "duty", *FACTORS])
def test_input_that_is_not_finite_never_gives_nan(fmu: Path, name: str, value: float) -> None:
    good = {"x": 0.002, "xdot": 0.1, "duty": 0.3, "f_oil": 0.9}
    instance = Instance(fmu).start(**good | {name: value})
    assert math.isfinite(instance.get("force"))
    assert instance.get("status") != 0
    instance.step(1e-3, **good | {name: good.get(name, 1.0)})
    assert instance.get("status") == 0
    before = instance.get("force")
    force = instance.step(1e-3, **{name: value})
    # A factor beyond its range is limited, of which infinity is a case; all else is held.
    assert math.isfinite(force) if name in FACTORS else force == before
    assert instance.get("status") != 0
    instance.step(1e-3, **{name: good.get(name, 1.0)})
    assert instance.get("status") == 0
    assert math.isfinite(instance.get("force"))
    instance.close()


@pytest.mark.parametrize("h", [0.0, -1e-3, *BAD])
def test_a_step_that_is_none_holds_the_force(fmu: Path, h: float) -> None:
    instance = Instance(fmu).start(x=0.002, xdot=0.1, duty=0.3)
    before = instance.step(1e-3)
    instance.slave.doStep(instance.t, h)
    assert instance.get("force") == before
    assert instance.get("status") != 0
    instance.close()


def test_before_initialisation_an_output_is_that_of_the_values_set_so_far(fmu: Path) -> None:
    """In whatever order inputs, parameters and questions come."""
    instance = Instance(fmu)
    k = table_2().values["compression.k_nom"]
    if instance.three:
        instance.slave.enterInitializationMode()
    else:
        instance.slave.setupExperiment()
        instance.slave.enterInitializationMode()
    instance.set(x=0.01)
    assert instance.get("force") == pytest.approx(k * 0.01, rel=1e-12)
    instance.set(**{"compression.k_nom": 3 * k})
    assert instance.get("force") == pytest.approx(3 * k * 0.01, rel=1e-12)
    instance.set(x=0.02)
    instance.slave.exitInitializationMode()
    assert instance.get("force") == pytest.approx(6 * k * 0.01, rel=1e-12)
    instance.close()


def test_reset_forgets_everything(fmu: Path, drive: Recording) -> None:
    instance = Instance(fmu).start(**part(drive, 0))
    once = [instance.step(0.005, **part(drive, i)) for i in range(1, 50)]
    instance.set(**{"compression.sigma": 1.0, "f_oil": 0.1})
    instance.step(0.005)
    instance.slave.reset()
    instance.start(**part(drive, 0))
    assert [instance.step(0.005, **part(drive, i)) for i in range(1, 50)] == once
    instance.close()


def test_calls_out_of_order_are_errors_not_crashes(fmu: Path) -> None:
    instance = Instance(fmu)
    with pytest.raises(FMICallException):
        instance.slave.doStep(0.0, 1e-3)
    with pytest.raises(FMICallException):
        instance.slave.exitInitializationMode()
    instance.start()
    with pytest.raises(FMICallException):
        instance.set(at_rest=0)
    with pytest.raises(FMICallException):
        instance.set(force=1.0)
    instance.slave.terminate()
    with pytest.raises(FMICallException):
        instance.slave.doStep(0.0, 1e-3)
    instance.slave.freeInstance()


def test_the_token_of_another_fmu_makes_no_instance(fmu: Path) -> None:
    instance = Instance(fmu)
    instance.slave.guid = "{another}"
    with pytest.raises(Exception, match="nstantiate"):
        instance.slave.instantiate()


def test_how_it_begins_can_be_said(fmu: Path) -> None:
    """At rest under control: the yield force is that of the direction that comes first."""
    forces = []
    for first in (True, False):
        instance = Instance(fmu).start(x=0.0, xdot=0.0, duty=0.4, first_compressing=first)
        forces.append(instance.step(1e-3, xdot=1e-6 if first else -1e-6))
        instance.close()
    values = table_2().values
    sides = zip(("compression", "release"), (1.0, -1.0), strict=True)
    wanted = [s * values[f"{w}.sigma"] * 0.4 ** values[f"{w}.beta"] for w, s in sides]
    assert forces == pytest.approx(wanted, rel=1e-4)
