"""Logs as they are read by a project: its columns where a log has them, the log as it is else."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from erdctl.core.errors import ErdctlError, InputProblem
from erdctl.io.convert import read_converted
from erdctl.io.logs import Log, read_logs
from erdctl.io.project.file import parse_project
from erdctl.io.project.labels import Labels
from erdctl.io.project.reading import ProjectReading, read_labels

N = 200
T = np.arange(N) * 1e-3
X = 0.01 * np.sin(40.0 * T)
FORCE = 40.0 * np.cos(40.0 * T)
LAB = {"Zeit": 1e3 * T, "Weg": 1e3 * X, "PWM": np.full(N, 20.0), "Kraft": FORCE}
COLUMNS = '[columns]\nt = "Zeit[ms]"\nx = "Weg[mm]"\nduty = "PWM[%]"\nforce = "Kraft[N]"\n'
PLAIN = {"t": T, "x": X, "duty": np.full(N, 0.3), "force": FORCE}
Write = Callable[..., str]


class Reads:
    """Reads by a project, and keeps what it changed and what was said."""

    def __init__(self, folder: Path, text: str, **chosen: str) -> None:
        self.project = parse_project(text.encode(), str(folder / "erdctl.toml"))
        self.used: list[str] = []
        self.said: list[str] = []
        self.by = ProjectReading(self.project, used=self.used.append, **chosen)

    def __call__(self, *paths: str, **options: Any) -> Log:
        given = {"need_force": True, **options}
        return read_logs(paths, project=self.by, report=self.said.append, **given)


@pytest.fixture
def reads(tmp_path: Path) -> Callable[..., Reads]:
    return lambda text, **chosen: Reads(tmp_path, text, **chosen)


def test_columns_are_those_of_map(reads: Callable[..., Reads], write: Write) -> None:
    path = write(LAB)
    maps = ["t=Zeit[ms]", "x=Weg[mm]", "duty=PWM[%]", "force=Kraft[N]"]
    by_map = read_logs([path], maps=maps, need_force=True, report=lambda line: None).recording
    read = reads(COLUMNS)
    log = read(path)
    for name in ("t", "x", "xdot", "duty", "force"):
        assert np.array_equal(getattr(log.recording, name), getattr(by_map, name))
    assert read.used == ["columns t, x, duty, force"]
    assert log.recording.labels == {}


def test_a_log_with_none_of_the_columns_is_read_as_it_is(
    reads: Callable[..., Reads], write: Write
) -> None:
    """As in a pipe: what erdctl writes has its own names."""
    read = reads(COLUMNS)
    assert np.array_equal(read(write(PLAIN)).recording.duty, PLAIN["duty"])
    assert read.used == []


def test_the_command_line_wins_column_by_column(reads: Callable[..., Reads], write: Write) -> None:
    path = write(LAB | {"Kraft2": 2.0 * FORCE})
    read = reads(COLUMNS)
    log = read(path, maps=["force=Kraft2[N]"])
    assert np.array_equal(log.recording.force, 2.0 * FORCE)
    assert np.array_equal(log.recording.duty, np.full(N, 0.2))
    assert read.used == ["columns t, x, duty"]


@pytest.mark.parametrize("missing", ["Weg", "Kraft", "PWM"])
def test_a_log_of_the_lab_must_have_what_is_needed(
    reads: Callable[..., Reads], write: Write, missing: str
) -> None:
    """A duty that is not found would be taken as no control."""
    path = write({k: v for k, v in LAB.items() if k != missing})
    with pytest.raises(InputProblem, match=f"no column '{missing}.*erdctl.toml names"):
        reads(COLUMNS)(path)


def test_a_drive_needs_no_force_and_a_temperature_may_be_missing(
    reads: Callable[..., Reads], write: Write
) -> None:
    read = reads(COLUMNS + 'temperature = "Oel[degC]"\n')
    path = write({k: v for k, v in LAB.items() if k != "Kraft"})
    assert read(path, need_force=False).recording.force is None
    assert any("'Oel[degC]' (temperature)" in line for line in read.said)


def test_another_unit_in_the_log_is_never_converted_by_the_project(
    reads: Callable[..., Reads], write: Write
) -> None:
    """`Weg (m)` is not the project's `Weg` in mm."""
    other = {"Zeit": LAB["Zeit"], "Weg (m)": X, "PWM": LAB["PWM"], "Kraft": FORCE}
    with pytest.raises(InputProblem, match="no column 'Weg"):
        reads(COLUMNS)(write(other))
    same = {"Zeit": LAB["Zeit"], "Weg (mm)": 1e3 * X, "PWM": LAB["PWM"], "Kraft": FORCE}
    assert np.allclose(reads(COLUMNS)(write(same)).recording.x, X, atol=1e-15)


def test_logs_says_which_files_are_meant(reads: Callable[..., Reads], write: Write) -> None:
    """Then names of erdctl's may be in other units, and nothing else is read by them."""
    text = 'logs = ["raw_*.csv"]\n[columns]\nx = "x[mm]"\n'
    raw, own = write(PLAIN | {"x": 1e3 * X}, "raw_1.csv"), write(PLAIN, "own.csv")
    read = reads(text)
    assert np.allclose(read(raw).recording.x, X, atol=1e-15)
    assert np.array_equal(read(own).recording.x, X)


def test_text_is_for_what_is_no_plain_csv(
    reads: Callable[..., Reads], write: Write, tmp_path: Path
) -> None:
    read = reads('[text]\nseparator = "semicolon"\ndecimal = "comma"\n')
    assert np.array_equal(read(write(PLAIN)).recording.t, T)
    assert read.used == []
    samples = zip(T, X, FORCE, strict=True)
    rows = [f"{t:.3f};{x:.6f};0,3;{f:.4f}".replace(".", ",") for t, x, f in samples]
    lab = tmp_path / "lab.txt"
    lab.write_text("\n".join(["t;x;duty;force", *rows]))
    assert np.allclose(read(str(lab)).recording.t, T)
    assert read.used == ["text separator, decimal"]
    # The command line wins key by key: a wrong sign there is a wrong sign.
    with pytest.raises(ErdctlError):
        read(str(lab), text=["decimal=point"])


CAR = {
    "Time": T, "x_fl": X, "x_fr": 2.0 * X, "F_fl": FORCE, "F_fr": 2.0 * FORCE,
    "PWM": np.full(N, 0.1),
}  # fmt: skip
CORNERS = (
    '[columns]\nt = "Time"\nduty = "PWM"\n'
    '[corner.fl.columns]\nx = "x_fl"\nforce = "F_fl"\n'
    '[corner.fr.columns]\nx = "x_fr"\nforce = "F_fr"\n'
)


def test_a_car_is_read_by_corner(reads: Callable[..., Reads], write: Write) -> None:
    path = write(CAR, "car.parquet")
    log = reads(CORNERS, corner="fr")(path)
    assert np.array_equal(log.recording.force, 2.0 * FORCE)
    assert log.recording.labels == {"corner": "fr"}
    with pytest.raises(InputProblem, match=r"corners fl, fr.*choose one: --corner fl"):
        reads(CORNERS)(path)
    # A log of one corner needs no choice.
    one = write({k: v for k, v in CAR.items() if "_fr" not in k}, "fl.parquet")
    assert reads(CORNERS)(one).labels == Labels(corner="fl")


def test_convert_keeps_all_corners(
    reads: Callable[..., Reads], write: Write, tmp_path: Path
) -> None:
    read = reads(CORNERS)
    table = read_converted(write(CAR, "car.parquet"), project=read.by, say=read.said.append)
    assert table.column_names == ["t", "x_fl", "x_fr", "F_fl", "F_fr", "duty"]


def test_columns_of_a_damper_by_its_path(reads: Callable[..., Reads], write: Write) -> None:
    text = COLUMNS + (
        "[labels]\npath = '(?P<damper>[A-Z]\\d)_'\n[damper.B2.columns]\nforce = \"-Kraft[N]\"\n"
    )
    read = reads(text)
    a, b = read(write(LAB, "A1_x.csv")), read(write(LAB, "B2_x.csv"))
    assert np.array_equal(a.recording.force, -b.recording.force)
    assert b.recording.labels == {"damper": "B2"}
    chosen = reads(text, damper="B2")(write(LAB, "A1_x.csv"))
    assert np.array_equal(chosen.recording.force, b.recording.force)
    # Together each is read by its own, and both are said.
    both = read(write(LAB, "A1_x.csv"), write(LAB, "B2_x.csv"))
    assert both.recording.labels == {}
    assert any("of 2 dampers by" in line for line in read.said)


@pytest.mark.parametrize("name", ["log.csv", "log.parquet"])
def test_labels_of_columns(reads: Callable[..., Reads], write: Write, name: str) -> None:
    text = (
        '[labels]\ncolumns = { damper = "Prüfling", date = "Tag", rig = "Rig", ambient = "T" }\n'
        '[damper.A07.columns]\nforce = "Kraft[N]"\n'
    )
    stated = {"Prüfling": ["A07"] * N, "Tag": ["2024-05-01"] * N, "Rig": ["3"] * N}
    path = write({"t": T, "x": X, "Kraft": FORCE, **stated, "T": np.arange(N)}, name)
    read = reads(text)
    log = read(path)
    assert log.labels == Labels("A07", None, "2024-05-01", {"rig": "3"})
    assert np.array_equal(log.recording.force, FORCE)
    assert any("'T' holds more than 20 values" in line for line in read.said)
    assert read_labels(read.project, path) == log.labels


def test_rows_of_one_damper(reads: Callable[..., Reads], write: Write) -> None:
    damper = np.repeat(["FL", "FR"], N // 2).tolist()
    path = write(PLAIN | {"damper": damper})
    text = '[corner.fr.where]\ndamper = "FR"\n[corner.fl.where]\ndamper = "FL"\n'
    read = reads(text, corner="fr")
    assert np.array_equal(read(path).recording.t, T[N // 2 :])
    assert read.used == ["where damper"]
    # The command line wins.
    assert np.array_equal(read(path, where=["damper=FL"]).recording.t, T[: N // 2])


def test_a_wrong_unit_is_said_with_the_project(reads: Callable[..., Reads], write: Write) -> None:
    with pytest.raises(ErdctlError, match=r'erdctl.toml, columns "force=Kraft\[mm\]"'):
        reads(COLUMNS.replace("Kraft[N]", "Kraft[mm]"))(write(LAB))
