"""`simulate` is what the exported block computes, to the last digits."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from c_built import block_of, forces, parameters_of
from c_motion import bench, random_motion
from places import FIXTURES
from typer.testing import CliRunner

import erdctl
from erdctl.cli.app import build
from erdctl.effects import catalogue, get
from erdctl.export.c.source import on_the_vehicle, write_c
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model

LOG = str(FIXTURES / "healthy_campaign.parquet")
PAPER = json.loads((FIXTURES / "table_2.json").read_text())
ON_CAR = [e.name for e in on_the_vehicle(catalogue())[0]]


def damper(folder: Path, *names: str) -> str:
    """A parameter file with effects at their starts, an onset within the log."""
    effects = [
        {"effect": n, "parameters": {
            q.symbol: {"value": 2.0 if q.symbol == "t_0" else q.start, "unit": q.unit}
            for q in get(n).quantities}}
        for n in names
    ]  # fmt: skip
    path = folder / "damper.json"
    path.write_text(json.dumps(PAPER | {"effects": effects}))
    return str(path)


def run(*words: str) -> str:
    done = CliRunner().invoke(build(["simulate"]), ["simulate", *words], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return str(done.stderr)


@pytest.mark.parametrize("name", ON_CAR)
def test_it_is_what_the_block_computes(name: str, tmp_path: Path) -> None:
    """On a vehicle nobody knows the samples ahead, and who simulates is told what comes there."""
    file = damper(tmp_path, name)
    parameters = read_parameters(file)
    s = bench()
    expected = forces(block_of(Model((get(name),)), parameters.values, s), s)
    found = erdctl.simulate(file, LOG).force
    assert np.abs(found - expected).max() <= 1e-9 * np.ptp(expected)


@pytest.mark.parametrize("T_d", [0.0, 0.02])
def test_that_a_block_does_not_know_the_step_ahead_is_said(T_d: float, tmp_path: Path) -> None:
    """Without a lag the force at a sample is that of a duty that still slews in the step ahead."""
    path = Path(damper(tmp_path, "supply_slew", "field_saturation"))
    document = json.loads(path.read_text())
    for way in ("compression", "release"):
        document[way]["T_d"]["value"] = T_d
    path.write_text(json.dumps(document))
    said = run(str(path), LOG, "--causal", "-o", str(tmp_path / "out.csv"))
    header = write_c(read_parameters(str(path)), prefix="damper").header
    assert ("supply_slew: in a block, without T_d" in said) is (T_d == 0.0)
    assert ("supply_slew, in C: without T_d" in header) is (T_d == 0.0)
    assert "field_saturation: in a block" not in said


@pytest.mark.parametrize("spring", ["fluid_compressibility", "mount_compliance"])
def test_a_spring_is_the_same_on_a_road_that_is_faster_than_the_bench(spring: str) -> None:
    """The laws behind it are tabulated: up to the speeds of the bench alone they stood still."""
    effects = tuple(get(name) for name in (spring, "shear_thinning"))
    values = {e.key(q.symbol): q.start for e in effects for q in e.quantities}
    values |= read_parameters(str(FIXTURES / "table_2.json")).values
    s = random_motion()
    model, slow = Model(effects), 0.1 * float(np.abs(s.xdot).max())
    block = write_c(parameters_of(model, values, ranges={"xdot": [-slow, slow]}), prefix="damper")
    expected = model.past_alone().force(s, values)
    assert np.abs(forces(block, s) - expected).max() <= 1e-9 * np.ptp(expected)


def test_with_and_without_the_bench_it_is_the_same_on_the_command_line(tmp_path: Path) -> None:
    file, out = damper(tmp_path, "fluid_inertia", "presliding_friction"), tmp_path / "out.parquet"
    plain = erdctl.simulate(file, LOG).force
    for words in ((), ("--causal",)):
        run(file, LOG, *words, "-o", str(out))
        assert np.array_equal(pd.read_parquet(out)["force_model"].to_numpy(), plain)


def test_the_bench_is_left_out_and_what_a_block_does_otherwise_is_said(tmp_path: Path) -> None:
    file = damper(tmp_path, "force_drift", "coulomb_friction", "input_delay")
    said = run(file, LOG, "--causal", "-o", str(tmp_path / "out.csv"))
    assert "belong to the bench and not to the damper: force_drift" in said
    assert "input_delay: in a block" in said
    both = damper(tmp_path, "coulomb_friction", "input_delay")
    alone = erdctl.simulate(both, LOG).force
    file = damper(tmp_path, "force_drift", "coulomb_friction", "input_delay")
    assert np.array_equal(erdctl.simulate(file, LOG, causal=True).force, alone)
    assert not np.array_equal(erdctl.simulate(file, LOG).force, alone)
