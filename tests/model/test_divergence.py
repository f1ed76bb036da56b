"""A simulation that diverged ends the command that asked for it; it never becomes a number."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.bench.drive import drives
from erdctl.cli.app import build
from erdctl.core.errors import ComputationProblem, ErdctlError
from erdctl.effects import catalogue, get
from erdctl.model.composed import Model
from erdctl.model.divergence import ABSURD, CALM, diverged, reach, refuse_diverged
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import simulate

LOG = str(FIXTURES / "healthy_noisy_motion.csv")
DRIVES = [
    drives([f"{kind}duration=2,duty=0.2"])
    for kind in ("sine:amp=0.01,freq=1,", "sweep:amp=0.01,", "noise:", "bumps:")
]


def random_parameters(rng: np.random.Generator, decades: float) -> Parameters:
    """A damper with one to three effects, its values that many decades about their starts."""
    model = Model(tuple(rng.choice(np.array(catalogue()), rng.integers(1, 4), replace=False)))
    values = {}
    for name, q in model.quantities.items():
        size = (abs(q.start) or 1.0) * 10 ** rng.uniform(-decades, decades)
        sign = -1.0 if q.low < 0.0 and rng.random() < 0.5 else 1.0
        values[name] = float(np.clip(sign * size, q.low, q.high))
    for way in ("compression", "release"):
        values |= {f"{way}.k_nom": 10 ** rng.uniform(0, 5), f"{way}.c_vis": 10 ** rng.uniform(0, 4),
                   f"{way}.sigma": 10 ** rng.uniform(0, 4)}  # fmt: skip
    estimates = {n: Estimate(value=v, unit=model.quantities[n].unit) for n, v in values.items()}
    return Parameters(model=model, estimates=estimates)


@pytest.mark.parametrize("seed", range(4))
def test_whatever_the_parameters_a_force_is_sane_or_refused(seed: int) -> None:
    rng = np.random.default_rng(seed)
    codes = []
    for _ in range(60):
        parameters, drive = random_parameters(rng, 6.0), DRIVES[rng.integers(len(DRIVES))]
        try:
            force = simulate(parameters, drive)
        except ErdctlError as error:
            codes.append(int(error.exit_code))
            continue
        top = np.abs(force).max()
        assert top <= max(CALM, ABSURD * reach(parameters.model, parameters.values, drive))
    assert set(codes) <= {3, 4}
    assert codes.count(4) < 30  # it is the exception


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 2e18, -2e18])
def test_what_is_no_force(bad: float) -> None:
    drive = DRIVES[0]
    values = {n: q.start for n, q in Model().quantities.items()} | {"compression.c_vis": 50.0}
    force = 50.0 * drive.xdot
    assert not diverged(force, Model(), values, drive)
    force[700] = bad
    assert diverged(force, Model(), values, drive)
    with pytest.raises(ComputationProblem, match=r"t = 0.7 s.*the simulation diverged") as caught:
        refuse_diverged(force, Model(), values, drive)
    assert caught.value.exit_code == 4
    assert drive.names[0] in str(caught.value)


def test_reach_check_value() -> None:
    drive = DRIVES[0]
    values = {f"{d}.{s}": v for d in ("compression", "release")
              for s, v in (("k_nom", 100.0), ("c_vis", 50.0), ("sigma", 20.0))}  # fmt: skip
    expected = 100.0 * np.abs(drive.x).max() + 50.0 * np.abs(drive.xdot).max() + 20.0
    assert reach(Model(), values, drive) == pytest.approx(expected)
    loud = replace(drive, force=0 * drive.x + 900.0)
    assert reach(Model(), values, loud) == pytest.approx(900.0)
    friction = Model((get("coulomb_friction"),))
    assert reach(friction, {**values, "coulomb_friction.F_c": 5e4}, drive) == pytest.approx(5e4)


def wild(path: Path) -> str:
    """A parameter file whose stop is as stiff as a wall, in the middle of the stroke."""
    document = json.loads((FIXTURES / "table_2.json").read_text())
    stop = {"k_c": 1e9, "k_r": 1e9, "x_stop": 1e-4}
    document["effects"] = [{"effect": "end_stop", "parameters": stop}]
    path.write_text(json.dumps(document))
    return str(path)


@pytest.mark.parametrize(
    "words",
    [
        ["simulate", "P", LOG, "-o", "o.csv"],
        ["simulate", "P", "--drive", "sine:freq=1", "-o", "o.csv"],
        ["validate", "P", LOG],
        ["validate", "P", LOG, "--report", "v.html"],
        ["diagnose", LOG, "--params", "P", "--effects", "backlash", "-o", "d.json"],
        ["plot", LOG, "--params", "P", "-o", "a.png"],
        ["plot", LOG, "--params", str(FIXTURES / "table_2.json"), "--before", "P", "--kind",
         "before-after", "-o", "a.png"],
        ["mimic", "P", str(FIXTURES / "schedule_60s.csv"), "--fault", "oil=0.5", "-o", "o.csv"],
    ],
    ids=lambda words: " ".join(words[:1] + words[3:4]),
)  # fmt: skip
def test_every_command_says_so_and_writes_nothing(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    wild(tmp_path / "P")
    done = CliRunner().invoke(build([words[0]]), words)
    assert done.exit_code == 4, done.output
    assert "the simulation diverged" in done.stderr
    assert "end_stop" in done.stderr
    assert re.search(r"record '\S+' at t = [\d.]+ s", done.stderr)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["P"]
