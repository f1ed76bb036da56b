"""The damper healthy and with each fault, at one PWM level after the other."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from erdctl.model.faults import effectiveness, parse_fault
from erdctl.report import draw, style, thin
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Flags, Subject

COLUMNS = 3


def faults(figure: Figure, subject: Subject) -> None:
    """A column for each level (lowest, middle, highest), deflection above, velocity below.

    Over cycles in which the fault acts: in others the faulty damper is a healthy one.
    """
    shown = shown_levels(subject)
    panels = figure.subplots(2, len(shown), sharey=True, sharex="row", squeeze=False)
    looks = dict(zip(subject.cases, style.series(len(subject.cases)), strict=True))
    healthy, *faulty = subject.cases
    for column, code in enumerate(shown):
        loops = {
            name: draw.typical(subject, subject.cases[name], code, when=_acts(name, subject))
            for name in faulty
        }
        acting = any(loops.values())
        loops[healthy] = [piece for own in loops.values() for piece in own] or draw.typical(
            subject, subject.cases[healthy], code
        )
        for row, across in enumerate(("x", "xdot")):
            ax = panels[row, column]
            scale, _ = style.label(ax, across, "force")
            if column:
                ax.set_ylabel("")
            for name, force in subject.cases.items():
                x, y = thin.joined(loops[name], getattr(subject.recording, across), force)
                ax.plot(x * scale, y, color=looks[name][0], ls=looks[name][1], label=name)
        level = f"PWM duty {style.percent(subject.levels[code])}"
        panels[0, column].set_title(level if acting else f"{level}, no fault acts")
    marks = [draw.mark(name, color=colour, ls=ls) for name, (colour, ls) in looks.items()]
    figure.legend(handles=marks, loc="outside lower left", ncols=4)


def _acts(spec: str, subject: Subject) -> Flags:
    """(n,) samples at which a fault acts, as `--fault` describes it."""
    # A leakage by its flow is none at low speeds, and a ramp begins at nothing: the whole of each.
    r, whole = subject.recording, replace(parse_fault(spec), factor=0.0, flow=None, ramp=0.0)
    return effectiveness(whole, r.t, r.xdot, r.starts) < 1.0


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
