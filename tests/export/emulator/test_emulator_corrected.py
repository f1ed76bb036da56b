"""The emulator of a damper with effects: its own exported C is what it looks ahead with."""

from __future__ import annotations

import copy
import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from emulators import COMPILERS, NONSENSE, STRICT, Compiled, rows, sanitized, write
from places import FIXTURES
from roads import factors_over, road

from erdctl.core.signals import Signals
from erdctl.effects import get, names
from erdctl.export.emulator.model_part import dead_time
from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters
from erdctl.mimic.plan import mimic
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import parse_fault
from erdctl.model.parameters import Parameters
from erdctl.score.nrmse import nrmse

pytestmark = pytest.mark.skipif(not COMPILERS, reason="no C compiler")

PAPER = json.loads((FIXTURES / "table_2.json").read_text())
FAULT = ("deformation=0.7@1",)


def with_effect(*chosen: str) -> Parameters:
    """Table 2 with effects at the values where a fit of them starts."""
    document = copy.deepcopy(PAPER)
    document["effects"] = [
        {
            "effect": name,
            "parameters": {
                q.symbol: {"value": q.start, "unit": q.unit} for q in get(name).quantities
            },
        }
        for name in chosen
    ]
    return parse_parameters(json.dumps(document).encode(), "corrected.json")


@pytest.mark.parametrize("name", names())
def test_every_effect_compiles_within_the_emulator(name: str, tmp_path: Path) -> None:
    """Also: no name of an effect's C is one of the emulator's."""
    write(write_emulator(with_effect(name), prefix="fl"), tmp_path)
    for compiler in COMPILERS:
        for real in ((), ("-DERDCTL_FLOAT",)):
            subprocess.run(
                [compiler, *STRICT, "-fsyntax-only", *real, "fl.c"], cwd=tmp_path, check=True
            )


def errors(name: str, folder: Path) -> dict[str, float]:
    """NRMSE of the corrected damper's force to the ideal faulty one on a rough road."""
    corrected, r = with_effect(name), road(0, step=0.001, duration=5.0)
    given = rows(r.t, r.x, r.xdot, r.duty, **factors_over(r, FAULT))
    found = {}
    for what, parameters in (("online", corrected), ("by the paper", with_effect())):
        prefix = what.replace(" ", "_")
        emulator = Compiled.of(write_emulator(parameters, prefix=prefix), folder)
        found[what] = emulator.run(emulator.state(), given).duty
    plan = mimic(corrected, r, [parse_fault(f) for f in FAULT], Amplifier())
    found |= {"offline": plan.duty, "static": plan.duty_paper}
    at = plan.acting

    def force(v: Any) -> Any:
        return corrected.model.force(Signals.of(r).with_duty(v), corrected.values)

    return {what: nrmse(plan.ideal[at], force(v)[at]).nrmse for what, v in found.items()}


@pytest.mark.parametrize("name", ["field_threshold", "field_viscosity", "shear_thinning"])
def test_effects_are_worth_what_they_cost(name: str, tmp_path: Path) -> None:
    e = errors(name, tmp_path)
    assert e["online"] < 0.6 * e["by the paper"]
    assert e["online"] < 1.3 * e["offline"]


@pytest.mark.parametrize("name", ["input_delay", "mount_compliance", "coulomb_friction"])
def test_effects_between_duty_and_force(name: str, tmp_path: Path) -> None:
    e = errors(name, tmp_path)
    assert e["online"] < 1.15 * e["by the paper"]
    assert e["online"] < 1.5 * e["offline"]
    assert e["online"] < 0.5 * e["static"]


def test_without_a_fault_the_duty_comes_through(tmp_path: Path) -> None:
    emulator = Compiled.of(write_emulator(with_effect("input_delay"), prefix="fl"), tmp_path)
    r = road(3, step=0.001, duration=2.0, switched=True)
    given = rows(r.t, r.x, r.xdot, r.duty)
    assert np.array_equal(emulator.run(emulator.state(), given).duty, r.duty)


@pytest.mark.parametrize("name", ["input_delay", "backlash"])
def test_nonsense_stays_within_the_limits(name: str, tmp_path: Path) -> None:
    emulator = Compiled.of(write_emulator(with_effect(name), prefix="fl"), tmp_path)
    rng = np.random.default_rng(4)
    odd = np.array([np.nan, np.inf, 0.0, 1e6, -1e6, 5e-324, -1e308, 1.0, 0.3, 0.01, 0.1])
    given = rng.choice(odd, (20_000, 8))
    out = emulator.run(emulator.state(), given)
    assert np.isfinite(out.duty).all()
    assert ((out.duty >= 0.0) & (out.duty <= 0.45)).all()


@pytest.mark.parametrize("name", ["input_delay", "mount_compliance"])
def test_sanitizers_find_nothing(name: str, tmp_path: Path) -> None:
    write(write_emulator(with_effect(name), prefix="e"), tmp_path)
    (tmp_path / "main.c").write_text(NONSENSE.replace("PREFIX", "e"))
    ran = sanitized(COMPILERS[0], tmp_path)
    assert (ran.returncode, ran.stdout.strip()) == (0, "ok"), ran.stderr


def test_parameters_of_effects_are_members_too() -> None:
    block = write_emulator(with_effect("backlash"), prefix="fl")
    paths = {m.path for m in block.parameters}
    assert {"damper.compression_sigma", "damper.backlash.g", "dead_time", "duty_max"} <= paths
    functions = re.findall(r"^(?!static|typedef|/|#| )[\w ]+[ *](\w+)\(", block.source, re.M)
    assert all(f.startswith("fl_") for f in functions)


def test_effects_of_the_bench_are_left_out() -> None:
    block = write_emulator(with_effect("force_drift"), prefix="fl")
    assert "force_drift" in block.left_out[0]
    assert "force_drift" in block.header
    assert "compression_sigma" in {m.path for m in block.parameters}, "inverted by formula"


def test_dead_time_is_that_of_the_model() -> None:
    assert dead_time(with_effect()) == 0.0
    assert dead_time(with_effect("coulomb_friction")) == 0.0
    tau = with_effect("input_delay").values["input_delay.tau"]
    assert dead_time(with_effect("input_delay")) == pytest.approx(tau, abs=3e-4)
