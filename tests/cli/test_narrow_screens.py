"""Screens of 80 and 60 columns: every number and every key is there whole, on every command."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from places import FIXTURES
from terminals import on_terminal
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.diagnose import diagnosis

LOG, TABLE_2 = str(FIXTURES / "healthy_noisy_motion.csv"), str(FIXTURES / "table_2.json")
CAMPAIGN, WORN = str(FIXTURES / "healthy_campaign.parquet"), str(FIXTURES / "worn_joint.parquet")
SCHEDULE = str(FIXTURES / "schedule_60s.csv")
COMMANDS = {
    "identify": ["identify", LOG, "-o", "p.json"],
    "inspect": ["inspect", LOG],
    "inspect-campaign": ["inspect", CAMPAIGN],
    "validate": ["validate", TABLE_2, CAMPAIGN],
    "diagnose": ["diagnose", WORN, "--effects", "backlash", "--jobs", "1", "-o", "d.json"],
    "diagnose-given": ["diagnose", WORN, "--effects", "backlash", "--jobs", "1", "--params",
                       TABLE_2, "--record-gains", "--record-offsets", "-o", "d.json"],
    "mimic": ["mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5@15:31", "--fault",
              "electrical=0.8@31:46,channel=rl", "-o", "pwm.csv"],
    "simulate": ["simulate", TABLE_2, LOG, "-o", "out.csv"],
    "derive": ["derive", str(FIXTURES / "geometry_inove.json"), "-o", "g.json"],
    "convert": ["convert", LOG, "out.parquet"],
    "plot": ["plot", LOG, "-o", "a.png"],
    "effects": ["effects"],
    "effect": ["effects", "cavitation"],
    "schema": ["schema", "diagnosis"],
}  # fmt: skip
DRAWN = re.compile(r"[┏┓┗┛┡┩┢┪╇╈┳┻━─│┃└┘┌┐├┤┬┴┼█▏▎▍▌▋▊▉]")
TABLES = ["identify", "inspect", "validate", "mimic"]


def screen(name: str, width: int | None, monkeypatch: pytest.MonkeyPatch, folder: Path) -> str:
    """What a command shows where COLUMNS says so, without a terminal."""
    monkeypatch.chdir(folder)
    if width is None:
        monkeypatch.delenv("COLUMNS", raising=False)
    else:
        monkeypatch.setenv("COLUMNS", str(width))
    words = COMMANDS[name]
    result = CliRunner().invoke(build([words[0]]), words, catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    return result.output


def words(text: str) -> set[str]:
    return set(DRAWN.sub(" ", text).split())


@pytest.mark.few(3)
@pytest.mark.parametrize("name", COMMANDS)
def test_nothing_is_cut(name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found: list[Any] = []

    def once(*given: Any, **options: Any) -> Any:
        """The same diagnosis for every width."""
        if not found:
            found.append(diagnose(*given, **options))
        return found[0]

    diagnose = diagnosis.diagnose
    monkeypatch.setattr(diagnosis, "diagnose", once)
    wide = screen(name, None, monkeypatch, tmp_path)
    for width in (80, 60):
        narrow = screen(name, width, monkeypatch, tmp_path)
        assert words(narrow) == words(wide)
        assert "\u2026" not in narrow
        rows = [line for line in narrow.splitlines() if line.startswith("  ")]
        if name in TABLES:
            assert rows
            assert max(map(len, rows)) <= width


@pytest.mark.few(3)
@pytest.mark.parametrize("name", TABLES)
def test_nothing_is_cut_on_a_terminal(name: str, tmp_path: Path) -> None:
    given = [str(tmp_path / w) if w in ("p.json", "pwm.csv") else w for w in COMMANDS[name]]
    wide, *narrow = (
        re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", on_terminal(*given, COLUMNS=str(w)))
        for w in (200, 80, 60)
    )
    progress = re.compile(r"[\u2800-\u28ff][^\r\n]*")
    for width, text in zip((80, 60), narrow, strict=True):
        shown = progress.sub("", text)
        assert words(shown) == words(progress.sub("", wide))
        for line in shown.replace("\r", "\n").splitlines():
            assert len(line) <= width or len(line.split()) == 1, line


@pytest.mark.parametrize("width", [80, 60])
def test_a_narrow_screen_has_the_numbers_of_the_json(
    width: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    shown = words(screen("validate", width, monkeypatch, tmp_path))
    run = CliRunner().invoke(build(["validate"]), [*COMMANDS["validate"], "--json"])
    document = json.loads(run.stdout)
    for split in ("duty", "direction", "record"):
        for score in document[f"nrmse_by_{split}"]:
            assert f"{score['nrmse']:.4f}" in shown
            assert str(score["samples"]) in shown
            assert split == "duty" or score[split] in shown
    shown = words(screen("identify", width, monkeypatch, tmp_path))
    found = json.loads((tmp_path / "p.json").read_text())
    for direction in ("compression", "release"):
        for symbol, given in found[direction].items():
            assert f"{direction}.{symbol}" in shown
            value = given["value"] * (1e3 if given["unit"] == "s" else 1.0)
            assert f"{value:.6g}" in shown  # T_d in ms
    shown = words(screen("inspect-campaign", width, monkeypatch, tmp_path))
    run = CliRunner().invoke(build(["inspect"]), [*COMMANDS["inspect-campaign"], "--json"])
    for record in json.loads(run.stdout)["records"]:
        assert record["name"] in shown
        assert f"{1e3 * record['speed']:.4g}" in shown


def test_a_bound_is_said_to_be_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """k_nom is not below zero; a log whose force says otherwise presses it there."""
    import numpy as np
    import pandas as pd

    monkeypatch.chdir(tmp_path)
    frame = pd.read_parquet(CAMPAIGN)
    frame["force"] -= 900.0 * frame["x"]
    frame = frame[frame["record"].isin(frame["record"].unique()[:9])]
    rng = np.random.default_rng(3)
    frame["force"] += rng.normal(0.0, 0.1, len(frame))
    frame.to_parquet("soft.parquet")
    run = CliRunner().invoke(build(["identify"]), ["identify", "soft.parquet", "-o", "p.json"])
    assert run.exit_code == 0, run.stderr
    row = next(line for line in run.stderr.splitlines() if "compression.k_nom" in line)
    assert "at its bound" in row
    stored = json.loads((tmp_path / "p.json").read_text())["compression"]["k_nom"]
    assert stored["value"] == 0.0
    assert stored["at_bound"] is True
    assert stored.get("stderr") is None
    for command in (
        ["validate", "p.json", "soft.parquet"],
        ["simulate", "p.json", LOG, "-o", "o.csv"],
    ):
        again = CliRunner().invoke(build([command[0]]), command)
        assert again.exit_code == 0, again.stderr
