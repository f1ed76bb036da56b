"""Where the model misses: over velocity and duty, and along the variable it was located in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.signals import Signals
from erdctl.diagnose.residual.localisation import UNITS, variables
from erdctl.report import style
from erdctl.report.kind import Picture
from erdctl.score.misfit import FEWEST, along, edges_of, misfit_map

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from erdctl.core.recording import Array
    from erdctl.report.subject import Subject

NAMES = {
    "xdot": "velocity, compression +",
    "x": "deflection, compression +",
    "duty": "duty cycle",
    "t": "time in the record",
    "since_reversal": "time since reversal",
    "since_duty_step": "time since duty step",
    "dissipated_energy": "dissipated energy",
}


def misfit(figure: Figure, subject: Subject) -> None:
    """The map shows the model before a correction, if there is one; the profile shows both."""
    from matplotlib.colors import LinearSegmentedColormap

    assert subject.measured is not None
    before = subject.modelled if subject.before is None else subject.before
    assert before is not None
    if subject.regions:
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        _profile(right, subject, before)
    else:
        left = figure.subplots()
    found = misfit_map(subject.recording, subject.measured - before)
    speed = style.AXES["xdot"]
    left.set_xlabel(speed.label)
    left.set_ylabel(style.AXES["duty"].label)
    left.set_facecolor("0.93")
    # Even misfit, as noise is, gets a middle shade: only what stands out is dark.
    heat = LinearSegmentedColormap.from_list("heat", style.HEAT)
    top = max(float(np.nanmax(found.rms)), 2.0 * float(np.nanmedian(found.rms)))
    mesh = left.pcolormesh(
        found.edges * speed.scale, np.arange(len(found.levels) + 1), found.rms,
        cmap=heat, vmin=0.0, vmax=top or 1.0, edgecolors="white", linewidth=0.3,
    )  # fmt: skip
    left.set_yticks(
        np.arange(len(found.levels)) + 0.5, [f"{100 * v:.4g}" for v in found.levels.tolist()]
    )
    left.grid(False)
    figure.colorbar(mesh, ax=left, label="misfit [N rms]", pad=0.02)
    left.set_title(f"by velocity and PWM duty; grey: fewer than {FEWEST} samples")


def _profile(ax: Axes, subject: Subject, before: Array) -> None:
    region = subject.regions[0]
    scale, unit = UNITS[region.variable]
    assert subject.measured is not None
    signals = Signals.of(subject.recording)
    values = variables(signals, subject.measured)[region.variable]
    width = region.high - region.low
    finite = values[np.isfinite(values)]
    low, high = float(finite.min()), float(finite.max())
    if high - low > 12 * width > 0:  # else the region would be a line
        low, high = max(low, region.low - 5 * width), min(high, region.high + 5 * width)
    edges = edges_of(np.array([low, high]))
    # One model alone is before nothing.
    forces = {subject.names[1 if subject.before is None else 2]: before}
    if subject.before is not None and subject.modelled is not None:
        forces[subject.names[1]] = subject.modelled
    for (name, force), (colour, ls) in zip(forces.items(), style.series(3)[1:], strict=False):
        rms = along(values, subject.measured - force, edges)
        ax.stairs(rms, edges * scale, color=colour, ls=ls, lw=1.4, baseline=None, label=name)
    ax.axvspan(region.low * scale, region.high * scale, color="0.88", zorder=0)
    ax.set_xlim(low * scale, high * scale)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel(f"{NAMES[region.variable.value]} [{unit}]")
    ax.set_ylabel("misfit [N rms]")
    ax.set_title(f"shaded: {region.text}", wrap=True)
    ax.legend(loc="upper right")


PICTURE = Picture(
    title="Where the model misses",
    needs=("measured", "modelled"),
    wants=("regions",),
    draw=misfit,
    size=lambda s: (11.0, 4.2) if s.regions else (7.0, 4.2),
)
