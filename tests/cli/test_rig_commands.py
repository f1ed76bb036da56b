"""The rig before the physics, on the command line: what is said, what is written, how it ends."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from places import FIXTURES
from rig_errors import ERRORS
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.core.blocks import thinned
from erdctl.io.logs import read_logs
from erdctl.io.tables import table_of, write_table


def run(*words: str | Path) -> Result:
    return CliRunner().invoke(build([str(words[0])]), [str(w) for w in words])


# Effects that would take a reversed force or a late record for themselves.
TEMPTING = (
    "time_skew", "input_delay", "mount_compliance", "backlash", "coulomb_friction", "force_offset",
)  # fmt: skip


def spoiled(name: str, folder: Path, most: int = 12_000) -> Path:
    """A short copy of the good campaign with one error in it."""
    path = str(FIXTURES / "healthy_campaign.parquet")
    good = read_logs([path], need_force=True, report=lambda line: None).recording
    short = thinned(good.select(list(range(0, len(good.names), 2))), most)
    log = folder / "spoiled.parquet"
    write_table(table_of(ERRORS[name].spoil(short, np.random.default_rng(1))), str(log))
    return log


def test_identify_refuses_what_is_wrong_as_a_whole(tmp_path: Path) -> None:
    log, out = spoiled("force reversed", tmp_path), tmp_path / "p.json"
    result = run("identify", log, "-o", out)
    assert result.exit_code == 3
    assert "gives energy back" in result.stderr
    assert '--map "force=-force"' in result.stderr
    assert not out.exists()
    # The remedy that it names is one.
    assert run("identify", log, "-o", out, "--map", "force=-force").exit_code == 0
    assert "rig" not in json.loads(out.read_text())["provenance"]


def test_identify_refuses_a_duty_that_is_inverted(tmp_path: Path) -> None:
    """A fault of the damper was said to set in, and to leave nothing of its field."""
    log, out = spoiled("duty inverted", tmp_path), tmp_path / "p.json"
    result = run("identify", log, "-o", out)
    assert result.exit_code == 3
    assert "active-low PWM" in result.stderr
    assert not out.exists()
    assert run("identify", log, "-o", out, "--accept", "duty_inverted").exit_code == 0


def test_identify_says_what_it_left_out(tmp_path: Path) -> None:
    log, out = spoiled("one record with a gain", tmp_path), tmp_path / "p.json"
    result = run("identify", log, "-o", out, "--strict")
    assert result.exit_code == 1  # the file is there all the same
    assert "record_gain" in result.stderr
    found = json.loads(out.read_text())["provenance"]["rig"]
    assert [f["code"] for f in found] == ["record_gain"]
    accepted = run("identify", log, "-o", out, "--strict", "--accept", "record_gain")
    assert accepted.exit_code == 0
    assert "rig" not in json.loads(out.read_text())["provenance"]


def test_accept_knows_its_codes(tmp_path: Path) -> None:
    result = run("identify", FIXTURES / "late_amplifier.parquet", "--accept", "nonsense")
    assert result.exit_code == 2
    assert "force_sign" in result.stderr


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["force reversed", "one record late", "duty inverted"])
def test_diagnose_names_no_physics_for_it(name: str, tmp_path: Path) -> None:
    log, out = spoiled(name, tmp_path, 8_000), tmp_path / "d.json"
    words = ["--effects", ",".join(TEMPTING), "--strict", "--report", tmp_path / "d.html"]
    result = run("diagnose", log, "-o", out, *words)
    assert result.exit_code == 1, result.output
    found = json.loads(out.read_text())
    assert {f["code"] for f in found["rig"]} == set(ERRORS[name].codes)
    assert all(f["remedy"] for f in found["rig"])
    assert found["findings"] == []
    assert found["verdict"] == ("adequate" if name == "one record late" else "unexplained")
    assert found["rig"][0]["text"] in (tmp_path / "d.html").read_text()


def test_validate_marks_and_counts_all(tmp_path: Path) -> None:
    log, out = spoiled("spikes of force", tmp_path), tmp_path / "p.json"
    assert run("identify", log, "-o", out).exit_code == 0
    result = run("validate", out, log, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert [f["code"] for f in found["rig"]] == ["force_spikes"]
    rows = len(read_logs([str(log)], need_force=True, report=lambda line: None).recording)
    assert found["samples"] == rows
    assert run("validate", out, log, "--strict").exit_code == 1


def test_inspect_lists_them(tmp_path: Path) -> None:
    log = spoiled("x clipped", tmp_path)
    result = run("inspect", log, "--json", "--strict")
    assert result.exit_code == 1
    assert {f["code"] for f in json.loads(result.stdout)["rig"]} == {"x_clipped"}
    assert run("inspect", FIXTURES / "healthy_campaign.parquet", "--strict").exit_code == 0


def test_validate_says_the_error_on_what_fits_take(tmp_path: Path) -> None:
    """The table was of a velocity that is noise, and the note said that another one is taken."""
    log, out = spoiled("noise of the velocity channel", tmp_path), tmp_path / "p.json"
    assert run("identify", log, "-o", out).exit_code == 0
    result = run("validate", out, log)
    words = " ".join(result.stderr.split())
    said = re.search(r"fits take in their place the NRMSE of all samples is ([0-9.]+)", words)
    assert said is not None
    assert float(said[1]) < 0.5 * json.loads(run("validate", out, log, "--json").stdout)["nrmse"]
    accepted = run("validate", out, log, "--accept", "velocity_noise")
    assert "on what fits take in their place" not in accepted.stderr
