"""Yield force against duty: what the log shows, and the identified law."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.recording import DIRECTIONS
from erdctl.mimic.inverse import laws_of
from erdctl.report import style
from erdctl.report.kind import Picture
from erdctl.score.yield_points import yield_points

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject

MARKERS = ("o", "s")


def yield_force(figure: Figure, subject: Subject) -> None:
    """Marks are means over the settled samples of a level and direction, bars their spread."""
    parameters = subject.parameters
    assert parameters is not None
    ax = figure.subplots()
    scale, _ = style.label(ax, "duty", "force")
    ax.set_ylabel("yield force [N]")
    top = max(float(subject.levels.max()), 0.05)
    duty = np.linspace(0.0, 1.08, 600) ** 2 * top  # steepest where the field sets in
    laws = laws_of(parameters.model, parameters.values)
    if subject.measured is not None:
        for p, direction, marker in zip(
            yield_points(subject.recording, parameters), DIRECTIONS, MARKERS, strict=True
        ):
            colour = style.SERIES[1 + DIRECTIONS.index(direction)][0]
            ax.errorbar(
                p.duty * scale, p.force, yerr=p.spread, ls="none", marker=marker, ms=5,
                color=colour, mfc="white", mew=1.3, elinewidth=0.8, capsize=2.5,
                label=f"{subject.names[0]}, {direction}",
            )  # fmt: skip
    for law, direction in zip(laws, DIRECTIONS, strict=True):
        colour, ls = style.SERIES[1 + DIRECTIONS.index(direction)]
        formula = (
            f"${law.sigma:.4g}\\,v^{{{law.beta:.3g}}}$ N" if law.table is None else "with effects"
        )
        ax.plot(
            duty * scale, law.forces(duty), color=colour, ls=ls,
            label=f"{subject.names[1]}, {direction}: {formula}",
        )  # fmt: skip
    ax.set_xlim(left=-0.02 * top * scale)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.legend(loc="lower right")


def no_field(subject: Subject) -> str | None:
    """Whether the log was recorded without any field."""
    if float(subject.levels.max()) > 0.0:
        return None
    return "the duty is 0 in the whole log; record one under a field"


PICTURE = Picture(
    title="Yield force against duty",
    figures="10",
    needs=("parameters",),
    nothing=no_field,
    draw=yield_force,
    size=(6.4, 4.4),
)
