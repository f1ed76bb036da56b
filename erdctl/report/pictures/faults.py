"""The damper healthy and with each fault, at one PWM level after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.report import draw, style, thin
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject

COLUMNS = 3


def faults(figure: Figure, subject: Subject) -> None:
    """A column for each level (lowest, middle, highest), deflection above, velocity below."""
    shown = shown_levels(subject)
    panels = figure.subplots(2, len(shown), sharey=True, sharex="row", squeeze=False)
    forces = list(subject.cases.values())
    for column, code in enumerate(shown):
        loops = draw.typical(subject, forces[0], code)
        for row, across in enumerate(("x", "xdot")):
            ax = panels[row, column]
            scale, _ = style.label(ax, across, "force")
            if column:
                ax.set_ylabel("")
            for (name, force), (colour, ls) in zip(
                subject.cases.items(), style.series(len(forces)), strict=True
            ):
                x, y = thin.joined(loops, getattr(subject.recording, across), force)
                ax.plot(x * scale, y, color=colour, ls=ls, label=name)
        panels[0, column].set_title(f"PWM duty {style.percent(subject.levels[code])}")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower left", ncols=4)


def shown_levels(subject: Subject) -> list[int]:
    """The PWM levels that get a column."""
    count = len(subject.levels)
    return sorted(set(np.linspace(0, count - 1, min(count, COLUMNS)).round().astype(int).tolist()))


def no_fault(subject: Subject) -> str | None:
    """Whether no fault changes anything."""
    healthy, *faulty = subject.cases.values()
    if any(not np.array_equal(healthy, force) for force in faulty):
        return None
    return "no fault acts during this log; look at their factors, starts and ends"


PICTURE = Picture(
    title="Healthy and faulty damper",
    figures="14, 15, 17, 18",
    needs=("cases",),
    nothing=no_fault,
    draw=faults,
    size=lambda s: (1.2 + 3.6 * len(shown_levels(s)), 6.4),
)
