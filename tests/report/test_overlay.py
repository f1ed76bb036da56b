"""Several logs in one picture are told apart by colour and named in the legend."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.io.logs import read_logs
from erdctl.report import draw, style
from erdctl.report.pictures.loops import loops
from erdctl.report.subject import Subject, part
from erdctl.report.subjects import overlay

LOGS = [str(FIXTURES / name) for name in ("worn_joint.parquet", "late_amplifier.parquet")]


def subject(paths: list[str]) -> Subject:
    recording = read_logs(paths, need_force=True, report=lambda line: None).recording
    return Subject(recording=recording, overlay=overlay(recording))


def test_logs_have_colours_of_their_own() -> None:
    both = subject(LOGS)
    told = draw.groups(both)
    assert told.labels == LOGS
    assert len(set(told.colours)) == 2
    first = read_logs(LOGS[:1], need_force=True, report=lambda line: None).recording
    assert np.array_equal(both.recording.force[told.code == 0], first.force)
    figure = Figure()
    loops(figure, both)
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert set(LOGS) <= set(legend)


def test_a_part_keeps_them() -> None:
    some = part(subject(LOGS), window=(0.0, 1.0))
    assert some.overlay is not None
    assert len(some.overlay.code) == len(some.recording)
    assert set(some.overlay.code.tolist()) == {0, 1}


def test_one_log_is_coloured_by_level() -> None:
    assert draw.groups(subject(LOGS[:1])).title == "PWM duty"


def test_the_command(tmp_path: Path) -> None:
    out = tmp_path / "both.png"
    assert CliRunner().invoke(build(["plot"]), ["plot", *LOGS, "-o", str(out)]).exit_code == 0
    assert out.stat().st_size > 10_000


def test_logs_of_one_damper_are_drawn_alike() -> None:
    both = read_logs(LOGS, need_force=True, report=lambda line: None).recording
    told = overlay(both, "damper", ["D1", "D1"])
    assert told is not None
    assert (told.names, told.title) == (("D1",), "damper")
    assert not told.code.any()


def test_dates_are_shades_in_their_order() -> None:
    both = read_logs(LOGS, need_force=True, report=lambda line: None).recording
    told = draw.groups(Subject(recording=both, overlay=overlay(both, "date", ["2024", "2023"])))
    assert told.labels == ["2023", "2024"]
    assert told.code[0] == 1
    assert told.colours == list(style.shades(2))


def test_paths_that_do_not_say_it(tmp_path: Path) -> None:
    out = tmp_path / "both.png"
    for by, said in (("corner", "does not say it"), ("D(", "NAME=PATTERN"), ("d=(", "no pattern")):
        done = CliRunner().invoke(build(), ["plot", *LOGS, "-o", str(out), "--overlay", by])
        assert done.exit_code == 2
        assert said in done.stderr
    assert not out.exists()


def test_the_command_by_a_pattern(tmp_path: Path) -> None:
    out = tmp_path / "both.svg"
    words = ["plot", *LOGS, "-o", str(out), "--overlay", "part=(joint|amplifier)"]
    done = CliRunner().invoke(build(), words)
    assert done.exit_code == 0, done.stderr
    assert all(f">{text}<" in out.read_text() for text in ("joint", "amplifier", "part"))
