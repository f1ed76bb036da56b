"""Force at the peak velocity of each stroke against that velocity, per PWM level."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.bench.dyno import peak_force as peaks_of
from erdctl.report import draw, style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.core.recording import Array
    from erdctl.report.subject import Subject

DRAWN_ONE_BY_ONE = 2000  # strokes of a level that are drawn one by one


def peak_force(figure: Figure, subject: Subject) -> None:
    """Dots are strokes under a constant duty, lines their means at each speed; the model dashed."""
    ax = figure.subplots()
    scale, _ = style.label(ax, "xdot", "force")
    ax.set_xlabel("peak velocity of a stroke, compression + [mm/s]")
    ax.set_ylabel("force at peak velocity [N]")
    key = []
    forces = ((subject.names[0], subject.measured, "-"), (subject.names[1], subject.modelled, "--"))
    for name, force, ls in forces:
        if force is None:
            continue
        found = peaks_of(subject.recording, force)
        dots = ls == "-" or subject.measured is None
        for code, colour in enumerate(style.shades(len(subject.levels))):
            v, mean = _apart(*found.line(code))
            ax.plot(
                v * scale, mean, color=colour, ls=ls, lw=1.3, marker="o" if dots else None, ms=4,
                label=f"{name} {style.percent(subject.levels[code])}",
            )  # fmt: skip
            if dots:
                at = np.flatnonzero(found.code == code)
                at = at[:: len(at) // DRAWN_ONE_BY_ONE + 1]
                ax.plot(
                    found.velocity[at] * scale, found.force[at], ls="none", marker=".", ms=3,
                    mew=0, color=style.tinted(colour, 0.5), zorder=1.5,
                )  # fmt: skip
        key.append(draw.mark(name, color=style.INK, ls=ls))
    draw.key_of_levels(figure, subject, key)


def _apart(v: Array, force: Array) -> tuple[Array, Array]:
    """A line in two halves: no stroke joins compression and release."""
    at = np.searchsorted(v, 0.0)
    return np.insert(v, at, np.nan), np.insert(force, at, np.nan)


def no_stroke(subject: Subject) -> str | None:
    """Whether there is no stroke that counts."""
    if len(peaks_of(subject.recording, subject.force).velocity):
        return None
    return "no stroke goes from one reversal to the next under a duty that has settled"


PICTURE = Picture(
    title="Peak force against velocity",
    needs=("force",),
    nothing=no_stroke,
    draw=peak_force,
    size=(7.4, 4.6),
)
