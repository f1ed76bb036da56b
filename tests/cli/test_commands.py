"""Commands as users call them: pipes, exit codes, files, help."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from places import FIXTURES, SHARED
from pyarrow import csv
from rig import real
from scipy.io import loadmat
from typer.testing import CliRunner

import erdctl as erdctl_module
from erdctl.cli.app import COMMANDS, build

Run = subprocess.CompletedProcess[bytes]
ERDCTL = [sys.executable, "-m", "erdctl"]
CAMPAIGN = FIXTURES / "healthy_campaign.parquet"
SCHEDULE = FIXTURES / "schedule_60s.csv"
TABLE_2 = FIXTURES / "table_2.json"
FAULTS = ["--fault", "oil=0.5@15:31", "--fault", "electrical=0.8@31:46",
          "--fault", "deformation=0.7@46"]  # fmt: skip


def erdctl(*arguments: object, data: bytes | None = None, code: int = 0) -> Run:
    run = subprocess.run([*ERDCTL, *map(str, arguments)], input=data, capture_output=True)
    assert run.returncode == code, run.stderr.decode()
    assert b"Traceback" not in run.stderr
    return run


@pytest.fixture(scope="module")
def identified(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("p") / "damper.json"
    erdctl("identify", CAMPAIGN, "-o", path)
    return path


def test_identify_writes_what_the_contract_says(identified: Path) -> None:
    document = json.loads(identified.read_text())
    assert document["schema"] == "erdctl.parameters/1"
    assert document["effects"] == []
    for direction in ("compression", "release"):
        assert set(document[direction]) == {"k_nom", "c_vis", "T_d", "sigma", "beta"}
        for p in document[direction].values():
            assert p["stderr"] > 0
            assert p["unit"]
    origin = document["provenance"]
    assert origin["logs"][0]["rows"] == 60_000
    assert len(origin["logs"][0]["sha256"]) == 64
    assert origin["noise_rms"] == pytest.approx(0.3, rel=0.02)
    assert origin["ranges"]["duty"] == [0.0, 0.45]
    assert {"joint", "two_step"} <= set(document["fits"])


def test_the_same_log_gives_the_same_bytes(identified: Path) -> None:
    assert erdctl("identify", CAMPAIGN).stdout == identified.read_bytes()


def test_identify_validate_pipe(identified: Path) -> None:
    run = erdctl("validate", "-", CAMPAIGN, "--json", data=identified.read_bytes())
    document = json.loads(run.stdout)
    assert [level["duty"] for level in document["nrmse_by_duty"]][:3] == [0.0, 0.05, 0.1]
    assert all(level["nrmse"] < 0.02 for level in document["nrmse_by_duty"])
    assert len(document["nrmse_by_record"]) == 24


@pytest.mark.parametrize("format", ["csv", "arrow", "parquet"])
def test_simulate_validate_pipe(format: str) -> None:
    force = erdctl("simulate", TABLE_2, SCHEDULE, "--format", format).stdout
    document = json.loads(erdctl("validate", "-", "--json", data=force).stdout)
    assert document["rms"] == pytest.approx(0.3, rel=0.05)


def test_log_from_stdin(tmp_path: Path) -> None:
    from_file = erdctl("simulate", TABLE_2, SCHEDULE).stdout
    assert erdctl("simulate", TABLE_2, "-", data=SCHEDULE.read_bytes()).stdout == from_file
    table = csv.read_csv(SCHEDULE)
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema) as writer:
        writer.write_table(table)
    again = erdctl("simulate", TABLE_2, "-", data=sink.getvalue().to_pybytes()).stdout
    a, b = (csv.read_csv(pa.BufferReader(out)) for out in (from_file, again))
    assert a["force_model"].equals(b["force_model"])


def test_three_commands_in_a_row() -> None:
    script = (
        '"$0" -m erdctl identify "$1" 2>/dev/null | "$0" -m erdctl simulate - "$2" 2>/dev/null'
        ' | "$0" -m erdctl validate - --json'
    )
    run = subprocess.run(
        ["bash", "-o", "pipefail", "-c", script, sys.executable, str(CAMPAIGN), str(SCHEDULE)],
        capture_output=True, check=True,
    )  # fmt: skip
    assert json.loads(run.stdout)["rms"] < 0.31


@pytest.mark.parametrize("command", ["simulate {p} {l} | head -1", "simulate {p} {l} | true"])
def test_a_closed_pipe_ends_quietly(command: str) -> None:
    line = f"{sys.executable} -m erdctl {command.format(p=TABLE_2, l=SCHEDULE)}"
    script = f"set -o pipefail; {line}"
    run = subprocess.run(["bash", "-c", script], capture_output=True)
    assert run.stderr == b""
    assert run.returncode == 0


def test_both_inputs_from_stdin_are_refused() -> None:
    run = erdctl("simulate", "-", "-", code=2)
    assert b"cannot both be stdin" in run.stderr


def test_a_full_disk_leaves_nothing() -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    run = erdctl("simulate", TABLE_2, SCHEDULE, "-o", "/dev/full", "--format", "csv", code=4)
    assert run.stderr.count(b"\n") == 1


def test_simulate_keeps_other_columns(tmp_path: Path) -> None:
    frame = pd.read_csv(SCHEDULE).assign(operator="ana", gain=3)
    log, out = tmp_path / "in.parquet", tmp_path / "out.parquet"
    frame.to_parquet(log)
    erdctl("simulate", TABLE_2, log, "-o", out)
    found = pd.read_parquet(out)
    assert list(found.columns) == [*frame.columns, "force_model"]
    pd.testing.assert_frame_equal(found[frame.columns.tolist()], frame)


def test_simulate_described_drives() -> None:
    run = erdctl(
        "simulate", TABLE_2, "--drive", "sine:freq=1,amp=0.01,duty=0.2,duration=2",
        "--drive", "bumps:duration=3,duty=0.1|0.3",
    )  # fmt: skip
    frame = pd.read_csv(pd.io.common.BytesIO(run.stdout))
    assert frame.groupby("record").size().to_dict() == {"bumps-2": 3000, "sine-1": 2000}
    assert frame["force_model"].notna().all()


def test_faults_scale_the_groups() -> None:
    healthy = pd.read_csv(pd.io.common.BytesIO(erdctl("simulate", TABLE_2, SCHEDULE).stdout))
    faulty = pd.read_csv(
        pd.io.common.BytesIO(
            erdctl("simulate", TABLE_2, SCHEDULE, "--fault", "oil=0.5@15:31").stdout
        )
    )
    inside = (healthy["t"] >= 15) & (healthy["t"] < 31)
    ratio = faulty["force_model"] / healthy["force_model"]
    assert ratio[inside].to_numpy() == pytest.approx(0.5)
    assert ratio[~inside].to_numpy() == pytest.approx(1.0)


def test_fail_above(identified: Path) -> None:
    erdctl("validate", identified, CAMPAIGN, "--fail-above", "0.05")
    run = erdctl("validate", identified, CAMPAIGN, "--fail-above", "0.001", code=1)
    assert b"NRMSE above 0.001 at PWM level 0:" in run.stderr


def test_mimic_writes_sequence_and_manifest(tmp_path: Path) -> None:
    out = tmp_path / "pwm.csv"
    erdctl("mimic", TABLE_2, SCHEDULE, *FAULTS, "-o", out)
    frame = pd.read_csv(out)
    assert {"t", "duty", "duty_fl", "duty_fr", "duty_rl", "duty_rr"} <= set(frame.columns)
    assert frame["duty"].between(0, 0.45).all()
    assert (frame["duty_rr"] == 0.3).all()
    manifest = json.loads((tmp_path / "pwm.csv.manifest.json").read_text())
    assert manifest["carrier"] == {"value": 25000.0, "unit": "Hz"}
    assert manifest["full_scale"] == {"value": 5000.0, "unit": "V"}
    assert len(manifest["emulation"]) == 3
    for entry in manifest["emulation"]:
        assert entry["nrmse_compensated"] < entry["nrmse_paper"]
    # What it predicts is what a simulation of the written sequence gives.
    again = erdctl("simulate", TABLE_2, out).stdout
    force = pd.read_csv(pd.io.common.BytesIO(again))["force_model"]
    assert force.to_numpy() == pytest.approx(frame["force_expected"].to_numpy(), abs=1e-9)


def test_mimic_for_simulink(tmp_path: Path) -> None:
    out = tmp_path / "pwm.mat"
    erdctl("mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5@15:31,channel=rl", "-o", out)
    found = loadmat(out)
    assert found["pwm"].shape == (5, 12_000)
    assert np.array_equal(found["pwm_ws"], found["pwm"].T)
    assert np.ptp(found["pwm"][1]) == 0.0
    assert np.ptp(found["pwm"][3]) > 0.1


def test_mimic_pipes_into_simulate() -> None:
    sequence = erdctl("mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5").stdout
    assert b"force_model" in erdctl("simulate", TABLE_2, "-", data=sequence).stdout


def test_mimic_refuses_a_hot_damper(tmp_path: Path) -> None:
    out = tmp_path / "pwm.csv"
    hot = FIXTURES / "schedule_hot.csv"
    run = erdctl("mimic", TABLE_2, hot, "--fault", "oil=0.5", "-o", out, code=3)
    assert b"above the limit of 60 degC" in run.stderr
    assert not list(tmp_path.iterdir())
    erdctl("mimic", TABLE_2, hot, "--fault", "oil=0.5", "-o", out, "--force")
    assert out.exists()


def test_derive_pipes_into_simulate() -> None:
    params = erdctl("derive", FIXTURES / "geometry_inove.json").stdout
    document = json.loads(params)
    assert document["compression"]["c_vis"]["value"] == pytest.approx(64.64, rel=1e-3)
    assert document["compression"]["T_d"]["value"] is None
    erdctl("simulate", "-", SCHEDULE, data=params)


def test_map_and_units() -> None:
    maps = ["t=Time[ms]", "x=Defl FL[mm]", "force=F_fl[N]", "duty=PWM[%]"]
    options = [o for m in maps for o in ("--map", m)]
    run = erdctl("validate", TABLE_2, FIXTURES / "foreign.csv", "--json", *options)
    assert json.loads(run.stdout)["nrmse"] < 0.05
    assert b"xdot" in run.stderr  # derived, and said so with its bandwidth
    assert b"Hz" in run.stderr


def test_several_logs(identified: Path, tmp_path: Path) -> None:
    frame = pd.read_parquet(CAMPAIGN)
    names = frame["record"].unique()
    first, second = tmp_path / "a.csv", tmp_path / "b.parquet"
    frame[frame["record"].isin(names[:12])].to_csv(first, index=False)
    frame[frame["record"].isin(names[12:])].to_parquet(second)
    whole = json.loads(identified.read_text())
    parts = json.loads(erdctl("identify", first, second).stdout)
    for symbol in ("k_nom", "c_vis", "sigma"):
        assert parts["release"][symbol]["value"] == pytest.approx(
            whole["release"][symbol]["value"], rel=1e-6
        )
    assert len(parts["provenance"]["logs"]) == 2


def test_the_two_step_fit_on_request() -> None:
    document = json.loads(erdctl("identify", CAMPAIGN, "--method", "two-step").stdout)
    assert document["fits"]["method"] == "two-step"
    steps = document["fits"]["two_step"]["values"]
    assert document["release"]["sigma"]["value"] == steps["release.sigma"]


def test_what_is_printed_of_either_fit_is_its_own() -> None:
    joint, steps = (erdctl("identify", CAMPAIGN, "--method", m) for m in ("joint", "two-step"))
    title, *rows = steps.stderr.decode().splitlines()
    fits = json.loads(steps.stdout)["fits"]
    assert title.endswith(f"by the paper's steps, residual {fits['two_step']['rms']:.4g} N rms")
    assert rows == joint.stderr.decode().splitlines()[1:]
    found = json.loads(joint.stdout)
    assert float(rows[4].split()[2]) == pytest.approx(found["compression"]["sigma"]["value"], 1e-5)
    called = repr(erdctl_module.identify(CAMPAIGN, method="two-step"))
    assert f"residual {fits['two_step']['rms']:.4g} N rms" in called
    assert not [line for line in called.splitlines() if line.endswith(" 1")]


@pytest.mark.real_data
def test_real_recording_end_to_end() -> None:
    log = real("mr_sine.parquet", SHARED)
    run = erdctl("identify", log)
    assert b"not identified: compression.T_d, release.T_d" in run.stderr
    found = json.loads(erdctl("validate", "-", log, "--json", data=run.stdout).stdout)
    by_duty = {level["duty"]: level["nrmse"] for level in found["nrmse_by_duty"]}
    print(by_duty)
    assert set(by_duty) == {0.0, 0.25, 0.5, 0.75, 1.0}
    assert max(v for d, v in by_duty.items() if d > 0) < 0.13


def test_schema_describes_the_document(identified: Path) -> None:
    schema = json.loads(erdctl("schema", "parameters").stdout)
    assert "ParameterFile" in json.dumps(schema)
    assert "compression" in json.dumps(schema)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_examples_and_exit_codes(command: str) -> None:
    text = erdctl(command, "--help").stdout.decode()
    assert "Example" in text
    assert f"erdctl {command}" in text
    assert "Exit codes" in text
    assert "--quiet" in text


def test_no_command_is_undocumented() -> None:
    text = erdctl("--help").stdout.decode()
    readme = (FIXTURES.parent / "README.md").read_text()
    for command in COMMANDS:
        assert command in text
        assert f"erdctl {command}" in readme


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", TABLE_2],
        ["mimic", TABLE_2, SCHEDULE],
        ["mimic", TABLE_2, SCHEDULE, "--fault", "nonsense"],
        ["validate", TABLE_2, "no-such.csv"],
        ["identify", CAMPAIGN, "-o", "/no/such/folder/x.json"],
        ["effects", "phlogiston"],
    ],
)
def test_wrong_usage_is_2(arguments: list[object]) -> None:
    """In this process; that the program ends with the code of a command is tested above."""
    words = [str(a) for a in arguments]
    done = CliRunner().invoke(build([words[0]]), words, catch_exceptions=False)
    assert done.exit_code == 2, done.stderr
    assert "Traceback" not in done.stderr


def test_colour_and_terminal_are_not_needed(identified: Path) -> None:
    env = {**os.environ, "TERM": "dumb", "NO_COLOR": "1"}
    run = subprocess.run(
        [*ERDCTL, "validate", str(identified), str(CAMPAIGN)], capture_output=True, env=env
    )
    assert b"\x1b[" not in run.stderr
    assert pq.read_table(CAMPAIGN).num_rows == 60_000
