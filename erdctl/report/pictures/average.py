"""The averaged force-velocity curve per PWM level, with the spread of the samples."""

from __future__ import annotations

from typing import TYPE_CHECKING

from erdctl.bench.dyno import averaged
from erdctl.report import draw, style
from erdctl.report.kind import Picture
from erdctl.report.pictures.loops import still

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def average(figure: Figure, subject: Subject) -> None:
    """Lines are means over all samples of a velocity, bands one standard deviation."""
    ax = figure.subplots()
    scale, _ = style.label(ax, "xdot", "force")
    key = []
    forces = ((subject.names[0], subject.measured, "-"), (subject.names[1], subject.modelled, "--"))
    for name, force, ls in forces:
        if force is None:
            continue
        found = averaged(subject.recording, force)
        for code, colour in enumerate(style.shades(len(found.levels))):
            mean, spread = found.force[code], found.spread[code]
            ax.plot(
                found.velocity * scale, mean, color=colour, ls=ls, lw=1.3,
                label=f"{name} {style.percent(found.levels[code])}",
            )  # fmt: skip
            if ls == "-":
                ax.fill_between(
                    found.velocity * scale, mean - spread, mean + spread, color=colour,
                    alpha=0.1, lw=0,
                )  # fmt: skip
        key.append(draw.mark(name, color=style.INK, ls=ls))
    draw.key_of_levels(figure, subject, key)


PICTURE = Picture(
    title="Averaged force against velocity",
    needs=("force",),
    nothing=still,
    draw=average,
    size=(7.4, 4.6),
)
