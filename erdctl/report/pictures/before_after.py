"""Loops before and after a correction of the model, over the same measured samples."""

from __future__ import annotations

from typing import TYPE_CHECKING

from erdctl.report import draw, style
from erdctl.report.kind import Picture
from erdctl.report.pictures.loops import still
from erdctl.score.nrmse import nrmse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def before_after(figure: Figure, subject: Subject) -> None:
    """The model before in the left column, after in the right; deflection above velocity."""
    assert subject.measured is not None
    assert subject.modelled is not None
    assert subject.before is not None
    measured, after, before = subject.names
    panels = figure.subplots(2, 2, sharey=True, sharex="row")
    for column, (name, force) in enumerate(((before, subject.before), (after, subject.modelled))):
        for row, across in enumerate(("x", "xdot")):
            ax = panels[row, column]
            style.label(ax, across, "force")
            draw.points(ax, subject, across, subject.measured, measured)
            draw.lines(ax, subject, across, force, name)
            if column:
                ax.set_ylabel("")
        missed = nrmse(subject.measured, force)
        panels[0, column].set_title(f"{name}\nNRMSE {missed.nrmse:.4f}, {missed.rms:.3g} N rms")
    key = [draw.mark(measured, **draw.DOTS), draw.mark("model", color=style.INK, lw=1.3)]
    draw.key_of_groups(figure, subject, key)


PICTURE = Picture(
    title="Before and after the correction",
    needs=("measured", "modelled", "before"),
    nothing=still,
    draw=before_after,
    size=(10.0, 7.2),
)
