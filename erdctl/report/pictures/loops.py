"""Force against deflection and velocity, coloured by PWM level: measured against model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from erdctl.report import draw, style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def loops(figure: Figure, subject: Subject) -> None:
    """Dots are all measured samples, lines typical cycles of the model; either may be missing."""
    measured, modelled, _ = subject.names
    key = []
    panels = figure.subplots(1, 2)
    for ax, across in zip(panels, ("x", "xdot"), strict=True):
        style.label(ax, across, "force")
        if subject.measured is not None:
            draw.points(ax, subject, across, subject.measured, measured)
        if subject.modelled is not None:
            draw.lines(ax, subject, across, subject.modelled, modelled)
    if subject.measured is not None:
        key.append(draw.mark(measured, **draw.DOTS))
    if subject.modelled is not None:
        key.append(draw.mark(modelled, color=style.INK, lw=1.3))
    draw.key_of_groups(figure, subject, key)


def still(subject: Subject) -> str | None:
    """Whether nothing moves."""
    r = subject.recording
    moves = style.spread(r.x) > 0.0 or style.spread(r.xdot) > 0.0
    return None if moves else "the piston never moves; --kind motion shows the log over time"


PICTURE = Picture(
    title="Force against deflection and velocity",
    figures="4, 5, 7, 9, 11, 13",
    needs=("force",),
    nothing=still,
    draw=loops,
)
