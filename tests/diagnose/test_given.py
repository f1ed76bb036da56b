"""A diagnosis of given parameters: what they contain is not found again."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.parameters import Estimate, Parameters

FEW = ("coulomb_friction", "quadratic_damping", "time_skew")
ERDCTL = [sys.executable, "-m", "erdctl"]


def rubbing(drag: float = 0.0) -> Recording:
    """Seal friction, and quadratic damping of so much [N s^2/m^2]."""
    r = noisy(campaign(100.0, 6.0), seed=4)
    assert r.force is not None
    return replace(r, force=r.force + 2.0 * np.sign(r.xdot) + drag * r.xdot * np.abs(r.xdot))


def candidates() -> list[Effect]:
    return [get(name) for name in FEW]


def with_friction(amount: float) -> Parameters:
    model = Model((get("coulomb_friction"),))
    values = {**TRUTH, "coulomb_friction.F_c": amount}
    return Parameters(
        model=model,
        estimates={n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()},
    )


def test_a_corrected_model_has_nothing_left_to_find() -> None:
    found = diagnose(rubbing(), candidates(), given=with_friction(1.0), limits=False)
    assert found.verdict is Verdict.ADEQUATE
    assert found.findings == ()
    # The values are wrong by 1 N of friction; the structure is right.
    assert found.baseline.overall.rms == pytest.approx(np.hypot(1.0, 0.3), rel=0.03)
    assert found.refitted.overall.rms == pytest.approx(0.3, rel=0.05)
    document = to_json(found, {"name": "p.json"})
    assert document["provenance"]["params"] == {"name": "p.json", "effects": ["coulomb_friction"]}
    assert "given" in document["baseline"]["of"]
    assert document["baseline"]["params"]["effects"][0]["effect"] == "coulomb_friction"
    assert document["heldout"]["after"]["rms"] == pytest.approx(0.3, rel=0.05)
    (extra,) = document["corrected"]["params"]["effects"]
    assert extra["effect"] == "coulomb_friction"


def test_what_comes_on_top_is_named_alone() -> None:
    found = diagnose(rubbing(drag=400.0), candidates(), given=with_friction(2.0), limits=False)
    assert [f.effect.name for f in found.findings] == ["quadratic_damping"]
    assert {e.name for e in parameters(found).model.effects} == {
        "coulomb_friction", "quadratic_damping",
    }  # fmt: skip


def test_what_the_log_cannot_identify_stays_as_given() -> None:
    r = rubbing()
    held = r.select([i for i, name in enumerate(r.names) if "Hz" in name])
    found = diagnose(held, candidates(), given=with_friction(2.0), limits=False)
    lag = parameters(found).estimates["release.T_d"]
    assert lag.value is None
    assert lag.assumed == TRUTH["release.T_d"]


def test_the_command_prints_what_validate_does(tmp_path: Path) -> None:
    log, params = tmp_path / "log.parquet", tmp_path / "p.json"
    r = rubbing()
    columns = {c: getattr(r, c) for c in ("t", "x", "xdot", "duty", "force")}
    names = np.repeat(r.names, np.diff(r.starts))
    pq.write_table(pa.table({**columns, "record": names}), log)

    def run(*arguments: object, data: bytes | None = None) -> dict[str, object]:
        command = [*ERDCTL, *map(str, arguments)]
        done = subprocess.run(command, input=data, capture_output=True, check=True)
        return json.loads(done.stdout)

    params.write_text(json.dumps(run("identify", log)))
    said = run("validate", params, log, "--json")
    found = run("diagnose", log, "--params", "-", "--effects", "coulomb_friction",
                data=params.read_bytes())  # fmt: skip
    assert found["baseline"]["nrmse"] == pytest.approx(said["nrmse"], rel=1e-9)
    assert found["refitted"]["nrmse"] <= found["baseline"]["nrmse"] * 1.01
    assert found["corrected"]["nrmse"] < found["refitted"]["nrmse"]
    assert found["provenance"]["params"]["name"] == "-"
    both = subprocess.run([*ERDCTL, "diagnose", "-", "--params", "-"], input=b"",
                          capture_output=True)  # fmt: skip
    assert both.returncode == 2
    assert b"cannot both be stdin" in both.stderr
