"""Parameters of a healthy damper, and drives of the same one damaged: which fault, what is left.

The car of `quarter_car` drives three times healthy and three times with a fault; nothing of the
diagnosis of the second half sees the first, but for the parameters.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import quarter_car

from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.fault_wording import as_fault_text
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.model.parameters import Parameters

CANDIDATES = [*(get(name) for name in quarter_car.FAULTS), get("preyield_viscosity")]


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("car")

    @cache
    def recorded(kind: str, seed: int, left: float) -> tuple[Parameters, Recording, Recording]:
        table = quarter_car.log(
            seed, 200, records=6, seconds=8.0, fault=kind, left=left,
            onsets=(*[np.inf] * 3, *[0.0] * 3),
        )  # fmt: skip
        file = Path(folder) / f"{kind}-{seed}.parquet"
        table.to_parquet(file)
        log = read_logs([str(file)], need_force=True, report=lambda line: None).recording
        healthy, damaged = log.select([0, 1, 2]), log.select([3, 4, 5])
        return parameters(diagnose(healthy, CANDIDATES, limits=False)), healthy, damaged

    return recorded


def answered(given: Parameters, recording: Recording) -> Diagnosis:
    return diagnose(recording, CANDIDATES, given=given, limits=False)


@pytest.mark.parametrize(
    ("kind", "seed", "left"),
    [
        ("oil_leakage", 81, 0.6),
        *(pytest.param(k, 81, 0.6, marks=pytest.mark.long) for k in quarter_car.FAULTS[1:]),
        *(pytest.param(k, 82, 0.85, marks=pytest.mark.long) for k in quarter_car.FAULTS),
    ],
)
def test_the_fault_and_what_is_left(kind: str, seed: int, left: float, halves: Any) -> None:
    given, _, damaged = halves(kind, seed, left)
    found = answered(given, damaged).as_fault
    assert found is not None
    assert kind in (found.effect.name, *found.alike)
    assert found.f == pytest.approx(left, abs=0.02)
    assert found.share > 0.95
    # Oil alone takes a part of all forces, as a load cell that is off does.
    assert found.may_be_a_gain == ("oil_leakage" in (found.effect.name, *found.alike))


@pytest.mark.long
def test_a_load_cell_that_is_off_is_not_ruled_out(halves: Any) -> None:
    given, healthy, _ = halves("electrical_fault", 81, 0.6)
    found = answered(given, replace(healthy, force=0.8 * healthy.force))
    assert found.as_fault is not None
    assert found.as_fault.f == pytest.approx(0.8, abs=0.01)
    assert "a gain of the rig, may look like it" in as_fault_text(found)


@pytest.mark.long
def test_it_is_written_with_its_share(halves: Any) -> None:
    given, _, damaged = halves("electrical_fault", 81, 0.6)
    found = answered(given, damaged)
    written = to_json(found)["as_fault"]
    assert found.as_fault is not None
    assert (written["effect"], written["f"]) == ("electrical_fault", found.as_fault.f)
    assert written["rms"] < 0.3 * found.baseline.overall.rms
    assert written["rms"] == pytest.approx(found.refitted.overall.rms, rel=0.1)
    assert "of the damper with the given parameters electrical_fault" in written["text"]


@pytest.mark.parametrize("seed", [81, pytest.param(82, marks=pytest.mark.long)])
def test_nothing_is_said_of_a_healthy_damper(seed: int, halves: Any) -> None:
    given, healthy, _ = halves("oil_leakage", seed, 0.6 if seed == 81 else 0.85)
    found = answered(given, healthy)
    assert found.as_fault is None
    assert "as_fault" not in to_json(found)


@pytest.mark.long
def test_another_damper_has_no_fault(halves: Any) -> None:
    """Its parameters all differ; no one number makes one of the other."""
    given, *_ = halves("oil_leakage", 81, 0.6)
    _, other, _ = halves("oil_leakage", 82, 0.85)
    found = answered(given, other)
    assert found.baseline.overall.rms > 1.5 * found.refitted.overall.rms
    assert found.as_fault is None


@pytest.mark.long
def test_a_batch_job_that_asks_whether_the_parameters_hold_is_told(tmp_path: Path) -> None:
    """Fitted anew the model is adequate; for the parameters that were given that says nothing."""
    onsets = (*[np.inf] * 2, *[0.0] * 2)
    table = quarter_car.log(
        83, 200, records=4, seconds=8.0, fault="electrical_fault", left=0.6, onsets=onsets
    )
    later = table.record.isin(["r2", "r3"])
    table[~later].to_parquet(tmp_path / "healthy.parquet")
    table[later].to_parquet(tmp_path / "later.parquet")

    def ran(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "erdctl", *words]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)

    tested = ("--effects", "electrical_fault,oil_leakage,preyield_viscosity", "--jobs", "1")
    out = ("-o", "healthy.json")
    assert ran("diagnose", "healthy.parquet", *tested, *out).returncode == 0
    params = json.loads((tmp_path / "healthy.json").read_text())["corrected"]["params"]
    (tmp_path / "params.json").write_text(json.dumps(params))
    ask = (*tested, "--params", "params.json", "--fail-on-mismatch", "-o", "d.json")
    held = ran("diagnose", "healthy.parquet", *ask)
    assert held.returncode == 0, held.stderr
    lost = ran("diagnose", "later.parquet", *ask)
    assert lost.returncode == 1
    written = json.loads((tmp_path / "d.json").read_text())
    assert (written["verdict"], written["as_fault"]["effect"]) == ("adequate", "electrical_fault")
    assert "the given parameters do not hold: of the damper with the given" in lost.stderr
