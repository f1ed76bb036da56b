"""The motion of a test: deflection and velocity over time, with the duty below."""

from __future__ import annotations

from typing import TYPE_CHECKING

from erdctl.report import draw, style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def motion(figure: Figure, subject: Subject) -> None:
    """Three panels over the same time."""
    panels = figure.subplots(3, 1, sharex=True, height_ratios=[2, 2, 1])
    for ax, name in zip(panels, ("x", "xdot", "duty"), strict=True):
        t = draw.clock(subject, ax)
        if name != "duty":
            ax.set_xlabel("")
            ax.axhline(0.0, color="0.75", lw=0.8, zorder=1)
        quantity = style.AXES[name]
        how = {"drawstyle": "steps-post"} if name == "duty" else {}
        values = getattr(subject.recording, name)
        draw.over_time(
            ax, t, values, subject.recording.starts, quantity.scale,
            color=style.SERIES[1][0], lw=1.1, label=quantity.name, **how,
        )  # fmt: skip
        ax.set_ylabel(quantity.label.replace(", ", ",\n"))
        ax.margins(x=0.01)


PICTURE = Picture(
    title="Motion and control",
    figures="19, 20, 21",
    needs=(),
    draw=motion,
    size=(10.0, 5.6),
)
