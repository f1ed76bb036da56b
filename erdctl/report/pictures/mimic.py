"""Force against velocity while each fault is mimicked: healthy, wanted, and to be expected."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.bench.strokes import stretches
from erdctl.report import style, thin
from erdctl.report.kind import Picture
from erdctl.score.nrmse import nrmse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject

ACROSS = 3
POINTS = 6000  # of a line; more is a long test, of which the first strokes are shown


def mimic(figure: Figure, subject: Subject) -> None:
    """A panel for each fault, over the samples at which it acts."""
    rows, columns = _shape(subject)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    ideal, expected, _ = subject.names
    assert subject.measured is not None
    assert subject.modelled is not None
    forces = {**subject.cases, ideal: subject.measured, expected: subject.modelled}
    looks = (("0.6", "-", 1.0), ("#E69F00", "-", 3.2), ("#0072B2", "-", 1.0))
    for ax, (fault, acting) in zip(panels.flat, subject.acting.items(), strict=False):
        first, end = stretches(acting, subject.recording.starts)
        pieces = [np.arange(a, b)[:POINTS] for a, b in zip(first, end, strict=True)][:20]
        scale, _ = style.label(ax, "xdot", "force")
        for (name, force), (colour, ls, lw) in zip(forces.items(), looks, strict=False):
            v, y = thin.joined(pieces, subject.recording.xdot, force)
            ax.plot(v * scale, y, color=colour, ls=ls, lw=lw, label=name)
        missed = nrmse(subject.measured[acting], subject.modelled[acting]).nrmse
        ax.set_title(f"{fault}\nNRMSE {missed:.4f}")
        ax.label_outer()
    for ax in list(panels.flat)[len(subject.acting) :]:
        ax.remove()
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower left", ncols=3)


def _shape(subject: Subject) -> tuple[int, int]:
    columns = min(len(subject.acting), ACROSS)
    return -(-len(subject.acting) // ACROSS), columns


def no_mimicry(subject: Subject) -> str | None:
    """Whether no mimicked fault acts."""
    if any(acting.any() for acting in subject.acting.values()):
        return None
    return "no fault acts during this log; look at their starts and ends"


PICTURE = Picture(
    title="Force against velocity while a fault is mimicked",
    figures="23, 25, 27, 30",
    needs=("acting", "measured", "modelled"),
    nothing=no_mimicry,
    draw=mimic,
    size=lambda s: (1.0 + 3.6 * max(_shape(s)[1], 2), 1.0 + 3.6 * _shape(s)[0]),
)
