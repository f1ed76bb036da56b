"""The duty sequence that mimics faults, with the stretches that no duty can mimic."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.bench.strokes import stretches
from erdctl.report import draw, style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def duty(figure: Figure, subject: Subject) -> None:
    """The sequence over the healthy duty; hatched where no duty gives the faulty force."""
    assert subject.programme is not None
    p, r = subject.programme, subject.recording
    ax = figure.subplots()
    t = draw.clock(subject, ax)
    unit = style.AXES["duty"]
    draw.over_time(
        ax, t, p.healthy, r.starts, unit.scale, color=style.SERIES[0][0], ls="--", lw=1.2,
        drawstyle="steps-post", label="healthy duty",
    )  # fmt: skip
    draw.over_time(
        ax, t, r.duty, r.starts, unit.scale, color=style.SERIES[1][0], lw=1.0,
        drawstyle="steps-post", label="sequence to push",
    )  # fmt: skip
    top = 1.12 * unit.scale * max(float(r.duty.max()), float(p.healthy.max()), 0.01)
    ax.set_ylim(0.0, top)
    first, end = stretches(p.out_of_reach, r.starts)
    name = f"out of reach ({100 * float(np.mean(p.out_of_reach)):.1f} % of the time)"
    edges = np.append(t, 2 * t[-1] - t[-2])
    # Bars as one patch collection: a sequence may have thousands of them.
    ax.fill_between(
        np.column_stack([t[first], t[first], edges[end], edges[end]]).ravel(),
        0.0, np.tile([0.0, top, top, 0.0], len(first)),
        facecolor="#D55E00", edgecolor="#D55E00", alpha=0.35, hatch="////", lw=0.0, label=name,
    )  # fmt: skip
    for fault, acting in subject.acting.items():
        for a, b in zip(*stretches(acting, r.starts), strict=True):
            ax.text(
                0.5 * (t[a] + t[b - 1]), top, fault, ha="center", va="bottom", size=7, color="0.3"
            )
            ax.axvline(t[a], color="0.6", lw=0.8, ls=":")
    ax.set_ylabel(unit.label)
    ax.margins(x=0.01)
    figure.legend(loc="outside lower left", ncols=3)


PICTURE = Picture(
    title="PWM duty sequence that mimics the faults",
    figures="22, 24, 26, 28",
    needs=("programme",),
    draw=duty,
    size=(10.0, 3.6),
)
