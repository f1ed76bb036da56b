"""Pictures as commands draw them, caught as figures before they become pixels."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from places import ROOT

from erdctl.cli.app import build
from erdctl.report import picture


@contextmanager
def caught(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Figure]]:
    """The figures that are drawn meanwhile; files are written all the same."""
    found: list[Figure] = []
    write = picture.write

    def keep(out: Figure, stream: BinaryIO, format: str) -> None:
        found.append(out)
        write(out, stream, format)

    monkeypatch.setattr(picture, "write", keep)
    yield found


def run(command: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> list[Figure]:
    """The figures of one command line, run in an empty folder."""
    words = shlex.split(command)
    assert words[0] == "erdctl"
    arguments = [f"{ROOT}/{w}" if w.startswith("fixtures/") else w for w in words[1:]]
    monkeypatch.chdir(folder)
    with caught(monkeypatch) as found:
        assert not build([arguments[0]])(arguments, standalone_mode=False)
    return found


def command_of(figure: str) -> str:
    """The command that CONTRIBUTING gives for a figure of the paper."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    for row in re.findall(r"^\| Figs?\. .*$", text, re.MULTILINE):
        cells = [c.strip() for c in row.strip("|").split(" | ")]
        if figure in re.findall(r"\d+", cells[0].split("(")[0]):
            return re.findall(r"`(erdctl [^`]+)`", cells[3])[0]
    raise AssertionError(f"no row for Fig. {figure}")


def panels(figure: Figure) -> list[Axes]:
    """The panels without colour bars."""
    return [ax for ax in figure.axes if ax.get_label() != "<colorbar>"]


def line(ax: Axes, label: str) -> tuple[np.ndarray, np.ndarray]:
    """The data of the one line with that label, without the gaps."""
    found = [a for a in ax.get_lines() if a.get_label() == label]
    assert len(found) == 1, [a.get_label() for a in ax.get_lines()]
    x, y = np.asarray(found[0].get_xdata(), float), np.asarray(found[0].get_ydata(), float)
    drawn = np.isfinite(x) & np.isfinite(y)
    return x[drawn], y[drawn]


def labels(ax: Axes) -> set[str]:
    """The labels of the lines that mean something."""
    return {str(a.get_label()) for a in ax.get_lines() if not str(a.get_label()).startswith("_")}


def units(figure: Figure) -> list[str]:
    """The axis labels of all panels that have one."""
    out: list[Any] = []
    for ax in figure.axes:
        out += [ax.get_xlabel(), ax.get_ylabel()]
    return [label for label in out if label]
