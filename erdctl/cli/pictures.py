"""The `--plot` option that several commands share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import kinds_of_plot

if TYPE_CHECKING:
    from erdctl.report.subject import Subject

Plots = Annotated[
    list[str],
    typer.Option(
        "--plot",
        metavar="[KIND:]FILE",
        autocompletion=kinds_of_plot,
        help="Draw a picture: .png, .svg or .pdf. KIND is one of `erdctl plot --help`, e.g."
        " time:force.png. May be repeated.",
    ),
]


@dataclass(frozen=True)
class Wanted:
    """A picture to draw: its kind, where to, and the format."""

    kind: str
    path: str
    format: str


def wanted(plots: Sequence[str], default: str) -> list[Wanted]:
    """What `--plot` asks for; raises UsageProblem before anything is computed."""
    from erdctl.report import pictures
    from erdctl.report.picture import suffix

    out = []
    for plot in plots:
        kind, colon, path = plot.partition(":")
        if not colon or kind not in pictures.names():
            kind, path = default, plot
        out.append(Wanted(kind, path, suffix(path)))
    return out


def wants(asked: Sequence[Wanted], what: str) -> bool:
    """Whether one of the pictures would show something that costs time to find out."""
    from erdctl.report import pictures

    kinds = [pictures.get(w.kind) for w in asked]
    return any(what in (*k.needs, *k.wants) for k in kinds)


def prepare() -> None:
    """Begin to import what draws while the log is read, which waits for the disk."""
    from importlib import import_module
    from threading import Thread

    Thread(target=import_module, args=("matplotlib.figure",), daemon=True).start()


def draw(asked: Sequence[Wanted], subject: Subject) -> None:
    """Draw pictures of one subject, each whole or not at all."""
    from erdctl.io.atomic import output
    from erdctl.report.picture import figure, write

    for picture in asked:
        found = figure(picture.kind, subject)
        with output(picture.path) as stream:
            write(found, stream, picture.format)
