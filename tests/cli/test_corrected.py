"""The commands on a corrected parameter file of every effect, written and read back."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pandas as pd
import pytest
from rig import TRUTH, campaign

from erdctl.cli.app import build
from erdctl.effects import catalogue, get
from erdctl.io.parameters import to_document
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.parameters import Estimate, Parameters

CATALOGUE = catalogue()


def corrected(path: Path, *chosen: Effect) -> Path:
    """A parameter file with effects at the values where a fit begins."""
    model = Model(chosen)
    values = TRUTH | {e.key(q.symbol): q.start for e in chosen for q in e.quantities}
    estimates = {
        name: Estimate(value=values[name], unit=q.unit) for name, q in model.quantities.items()
    }
    path.write_bytes(msgspec.json.encode(to_document(Parameters(model=model, estimates=estimates))))
    return path


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    r = campaign(200.0, 6.0).select([2])
    path = tmp_path_factory.mktemp("log") / "drive.csv"
    frame = {name: getattr(r, name) for name in ("t", "x", "xdot", "duty", "force")}
    pd.DataFrame(frame).to_csv(path, index=False)
    return path


@pytest.mark.few(20)
@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_simulate_validate_and_mimic(
    effect: Effect, log: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    params = corrected(tmp_path / "corrected.json", effect)
    out, pwm = tmp_path / "out.csv", tmp_path / "pwm.csv"
    app = build(["simulate", "validate", "mimic"])

    def call(*arguments: object) -> None:
        app([str(a) for a in arguments], standalone_mode=False)

    call("simulate", params, log, "-o", out)
    modelled = pd.read_csv(out)["force_model"].to_numpy()
    assert np.isfinite(modelled).all()
    capfd.readouterr()
    call("validate", params, log, "--json")
    score = json.loads(capfd.readouterr().out)
    measured = pd.read_csv(log)["force"].to_numpy()
    assert score["rms"] == pytest.approx(np.sqrt(np.mean((measured - modelled) ** 2)), rel=1e-6)
    call("mimic", params, log, "--fault", "electrical=0.6@2", "-o", pwm)
    said = capfd.readouterr().err
    frame = pd.read_csv(pwm)
    manifest = json.loads(Path(f"{pwm}.manifest.json").read_text())
    (correction,) = manifest["correction"]
    (entry,) = manifest["emulation"]
    assert correction["nrmse"] <= correction["nrmse_plain"]
    assert entry["nrmse_compensated"] == pytest.approx(correction["nrmse"])
    assert effect.name in said
    assert "without effects" in said
    # What it predicts is what a simulation of the written sequence gives.
    call("simulate", params, pwm, "-o", out)
    again = pd.read_csv(out)["force_model"].to_numpy()
    assert again == pytest.approx(frame["force_expected"].to_numpy(), abs=1e-6)


def test_effects_that_exclude_each_other_are_refused(log: Path, tmp_path: Path) -> None:
    chosen = (get("fluid_compressibility"), get("mount_compliance"))
    params = corrected(tmp_path / "corrected.json", *chosen)
    for command in (["simulate"], ["validate"], ["mimic", "--fault", "oil=0.5"]):
        line = [sys.executable, "-m", "erdctl", *command, str(params), str(log)]
        run = subprocess.run(line, capture_output=True, text=True)
        assert run.returncode == 3
        assert "fluid_compressibility, mount_compliance together" in run.stderr
        assert "Traceback" not in run.stderr
