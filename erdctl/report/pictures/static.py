"""The static and the dynamic model: what the lag T_d makes of the loops."""

from __future__ import annotations

from typing import TYPE_CHECKING

from erdctl.model.simulate import simulate, without_lag
from erdctl.report import draw, style
from erdctl.report.kind import Picture
from erdctl.report.readable import number, scaled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def static(figure: Figure, subject: Subject) -> None:
    """The static law in the left column, with T_d in the right; deflection above velocity."""
    assert subject.parameters is not None
    still = without_lag(subject.parameters)
    models = (
        ("static model", "T_d = 0", simulate(still, subject.recording)),
        ("dynamic model", _lags(subject), simulate(subject.parameters, subject.recording)),
    )
    panels = figure.subplots(2, 2, sharey=True, sharex="row")
    for column, (name, lag, force) in enumerate(models):
        for row, across in enumerate(("x", "xdot")):
            ax = panels[row, column]
            style.label(ax, across, "force")
            if subject.measured is not None:
                draw.points(ax, subject, across, subject.measured, subject.names[0])
            draw.lines(ax, subject, across, force, name)
            if column:
                ax.set_ylabel("")
        panels[0, column].set_title(f"{name}, {lag}")
    key = [draw.mark("model", color=style.INK, lw=1.3)]
    if subject.measured is not None:
        key.insert(0, draw.mark(subject.names[0], **draw.DOTS))
    draw.key_of_groups(figure, subject, key)


def _lags(subject: Subject) -> str:
    assert subject.parameters is not None
    lags = [subject.parameters.values[f"{d}.T_d"] for d in ("compression", "release")]
    factor, unit = scaled("s", max(lags))
    both = dict.fromkeys(number(factor * lag, 3) for lag in lags)
    return f"T_d = {' / '.join(both)} {unit}"


PICTURE = Picture(
    title="Static and dynamic model",
    figures="7, 8",
    needs=("parameters",),
    draw=static,
    size=(10.0, 7.2),
)
