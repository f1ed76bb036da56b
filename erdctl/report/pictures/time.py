"""Force over time, measured against model, and what the model misses below it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.report import draw, style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def time(figure: Figure, subject: Subject) -> None:
    """The upper panel shows both forces, the lower their difference to its own scale."""
    measured, modelled, _ = subject.names
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1])
    t, starts = draw.clock(subject, lower), subject.recording.starts
    draw.clock(subject, upper)
    style.label(upper, "t", "force")
    upper.set_xlabel("")
    (c_measured, ls), (c_model, _) = style.SERIES[0], style.SERIES[2]
    for name, force in subject.cases.items():
        draw.over_time(upper, t, force, starts, color="0.8", lw=0.9, label=name)
    draw.over_time(upper, t, subject.force, starts, color=c_measured, ls=ls, lw=1.8, label=measured)
    assert subject.modelled is not None
    draw.over_time(upper, t, subject.modelled, starts, color=c_model, lw=0.9, label=modelled)
    upper.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)
    residual = subject.residual
    lower.axhline(0.0, color="0.75", lw=0.8, zorder=1)
    draw.over_time(lower, t, residual, starts, color=style.INK, lw=0.7, label="difference")
    lower.set_ylabel(f"difference [{style.AXES['force'].unit}]")
    rms = float(np.sqrt(np.mean(residual**2)))
    lower.set_title(f"{measured} less {modelled}: {rms:.3g} N rms")
    lower.margins(x=0.01)


PICTURE = Picture(
    title="Force over time",
    figures="12, 29",
    needs=("measured", "modelled"),
    draw=time,
    size=(10.0, 5.0),
)
