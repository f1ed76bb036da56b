"""Several logs in one picture are told apart by colour and named in the legend."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.io.logs import read_logs
from erdctl.report import draw
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
