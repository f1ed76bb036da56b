"""The emulator of a damper with effects: its own exported C is what it looks ahead with."""

from __future__ import annotations

import copy
import json
import re
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from emulators import COMPILERS, NONSENSE, STRICT, Compiled, rows, sanitized, write
from places import FIXTURES
from roads import factors_over, road

from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.effects import get, names
from erdctl.export.emulator.model_part import dead_time, sweep_time, turns_first
from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters
from erdctl.mimic.plan import mimic
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import parse_fault
from erdctl.model.parameters import Parameters
from erdctl.model.simulate import simulate
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


@cache
def knowing(name: str, folder: Path) -> Compiled:
    """The emulator that knows an effect, or, without a name, that of the paper's model alone."""
    parameters = with_effect(*([name] if name else []))
    return Compiled.of(write_emulator(parameters, prefix=name or "paper"), folder)


def duties(name: str, r: Recording, faults: tuple[str, ...], folder: Path) -> dict[str, Any]:
    """(n,) duty of the emulator that knows the effect, and of that of the paper's model alone."""
    given = rows(r.t, r.x, r.xdot, r.duty, **factors_over(r, faults))
    both = {"online": knowing(name, folder), "by the paper": knowing("", folder)}
    return {what: e.run(e.state(), given).duty for what, e in both.items()}


def missed(name: str, r: Recording, found: dict[str, Any], ideal: Any, at: Any) -> dict[str, float]:
    """NRMSE of the corrected damper's force to the ideal faulty one, under each duty."""
    corrected, s = with_effect(name), Signals.of(r)
    force = {w: corrected.model.force(s.with_duty(v), corrected.values) for w, v in found.items()}
    return {what: nrmse(ideal[at], f[at]).nrmse for what, f in force.items()}


def errors(name: str, folder: Path) -> dict[str, float]:
    """Online and offline on a rough road."""
    r = road(0, step=0.001, duration=5.0)
    plan = mimic(with_effect(name), r, [parse_fault(f) for f in FAULT], Amplifier())
    found = duties(name, r, FAULT, folder) | {"offline": plan.duty, "static": plan.duty_paper}
    return missed(name, r, found, plan.ideal, plan.acting)


# What hides the yield force for a while: a void, play, a spring that loads, a flow before yield.
HIDING = ("cavitation", "backlash", "mount_compliance", "fluid_compressibility",
          "yield_hysteresis", "preyield_viscosity", "preyield_elasticity")  # fmt: skip


@pytest.mark.few(3)
@pytest.mark.parametrize("name", HIDING)
def test_to_know_an_effect_that_hides_the_yield_force_is_no_worse(
    name: str, tmp_path: Path
) -> None:
    for seed, fault in ((0, "deformation=0.7@1"), (4, "electrical=0.8@1"), (4, "oil=0.5@1")):
        r = road(seed, step=0.001, duration=4.0)
        ideal = simulate(with_effect(name), r, [fault])
        e = missed(name, r, duties(name, r, (fault,), tmp_path), ideal, r.t >= 1.0)
        # Duties are looked for until they are near enough: 1e-4 of the range of the force.
        assert e["online"] < 1.02 * e["by the paper"] + 1e-4


def test_a_duty_that_slews_is_not_sent_to_and_fro(tmp_path: Path) -> None:
    r = road(0, step=0.001, duration=5.0)
    ideal = simulate(with_effect("supply_slew"), r, FAULT)
    found = duties("supply_slew", r, FAULT, tmp_path)
    e = missed("supply_slew", r, found, ideal, r.t >= 1.0)
    assert e["online"] < 0.55 * e["by the paper"]


def test_what_an_effect_makes_of_a_step_of_the_duty() -> None:
    slewing = with_effect("supply_slew")
    assert sweep_time(slewing) == pytest.approx(slewing.values["supply_slew.T_full"], abs=5e-4)
    assert sweep_time(with_effect("input_delay")) == 0.0
    assert sweep_time(with_effect()) == 0.0
    # More duty is a slower yielding first and more yield force later.
    assert turns_first(with_effect("preyield_field_dependence"))
    assert not any(map(turns_first, map(with_effect, ("preyield_viscosity", "field_viscosity"))))


@pytest.mark.parametrize("tau", [0.0004, 0.005, 0.0503, 0.4])
def test_looks_ahead_leave_the_past_as_it_is(tau: float, tmp_path: Path) -> None:
    """They share the ring of past duties; with copies of the whole the output is the same."""
    block = write_emulator(with_effect("input_delay"), prefix="shared")
    copies = replace(
        block, prefix="copied", header=block.header.replace("shared", "copied"),
        source=re.sub(r"offsetof\(.*?\)\)", "sizeof *copy)", block.source)
        .replace("step_with(copy, of,", "step_with(copy, copy,").replace("shared", "copied"),
    )  # fmt: skip
    assert copies.source.count("sizeof *copy") == 1
    assert copies.source.count("step_with(copy, copy,") == 1
    r = road(3, step=0.001, duration=3.0)
    rng = np.random.default_rng(1)
    duty = np.clip(0.2 + 0.1 * rng.standard_normal(len(r.t)), 0.0, 0.45)
    given = rows(np.cumsum(rng.uniform(3e-4, 2e-3, len(r.t))), r.x, r.xdot, duty, deformation=0.7)
    out = []
    for each in (block, copies):
        emulator = Compiled.of(each, tmp_path)
        state = emulator.state(**{"damper.input_delay.tau": tau, "dead_time": tau})
        out.append(emulator.run(state, given).duty)
    assert np.array_equal(*out)
    assert len(np.unique(out[0])) > 100


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
