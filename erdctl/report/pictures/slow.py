"""Gas force and seal drag, from slow motion without field."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.bench.dyno import slow_test
from erdctl.report import style
from erdctl.report.kind import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


def slow(figure: Figure, subject: Subject) -> None:
    """Mean force of either direction over deflection, and half their sum and difference."""
    found = slow_test(subject.recording, subject.force)
    left, right = figure.subplots(1, 2)
    curves = (
        (left, (("compression", found.compression), ("release", found.release),
                ("gas force", found.gas))),
        (right, (("seal drag", found.drag),)),
    )  # fmt: skip
    looks = {"compression": 1, "release": 2, "gas force": 0, "seal drag": 3}
    for ax, named in curves:
        scale, _ = style.label(ax, "x", "force")
        for name, force in named:
            colour, ls = style.SERIES[looks[name]]
            ax.plot(found.x * scale, force, color=colour, ls=ls, marker=".", label=name)
        ax.legend(loc="best")
    left.set_title(f"gas force; at most {found.speed * 1e3:g} mm/s, no field")
    right.set_title(f"seal drag: mean {float(np.mean(found.drag)):.3g} N")
    right.set_ylim(bottom=min(0.0, float(found.drag.min()) * 1.1))


PICTURE = Picture(
    title="Gas force and seal drag from slow strokes",
    needs=("force",),
    draw=slow,
)
