"""What several pictures draw: clouds of samples, typical loops, lines over time, legends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from erdctl.bench.strokes import varied
from erdctl.core.recording import Array, Index
from erdctl.report import style, thin
from erdctl.score.nrmse import Codes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from erdctl.report.subject import Flags, Subject

LOOPS = 5  # typical cycles of a level
POINTS = 500  # pixel columns of one cycle
PART = 0.2  # of a cycle at one level that shows it, where the duty changes within every cycle
APART = 0.01  # of the range of the force: a cycle that reaches further than that is shown, too
MANY = 200  # stretches of a level that are drawn where there is no cycle
BEHIND = 0.55  # white in the colour of dots with a line over them
VECTOR = 3000  # points beyond which a drawing program would rather have pixels


@dataclass(frozen=True, eq=False)
class Groups:
    """What samples are told apart by: the PWM level, or of several logs the log.

    code : (n,) of each sample;  labels, colours : of each group;  title : of the legend
    """

    title: str
    code: Codes
    labels: list[str]
    colours: list[Any]


def groups(subject: Subject) -> Groups:
    """The groups of a subject."""
    if subject.overlay is not None:
        from matplotlib.colors import to_rgb

        told = subject.overlay
        names = list(told.names)
        colours: list[Any] = [to_rgb(colour) for colour, _ in style.series(len(names) + 1)[1:]]
        # Dates are lighter or darker by their order; so are more groups than there are colours.
        if told.ordered or len(names) >= len(style.SERIES):
            colours = list(style.shades(len(names)))
        return Groups(told.title, told.code, names, colours)
    return _levels(subject)


def _levels(subject: Subject) -> Groups:
    levels = [style.percent(v) for v in subject.levels.tolist()]
    return Groups("PWM duty", subject.codes, levels, list(style.shades(len(levels))))


def points(ax: Axes, subject: Subject, across: str, force: Array, name: str) -> None:
    """All samples as dots, coloured by group; thinned without losing outline or extremes.

    The lowest PWM level lies on top: higher ones reach beyond it, and would cover it.
    """
    pale = BEHIND if subject.modelled is not None else 0.1  # white mixed in
    r, told = subject.recording, groups(subject)
    fx, fy = style.AXES[across].scale, style.AXES["force"].scale
    values = getattr(r, across)
    kept = thin.outline(values, force, told.code, len(told.labels))
    for i, (label, colour, rows) in enumerate(zip(told.labels, told.colours, kept, strict=True)):
        ax.plot(
            values[rows] * fx, force[rows] * fy, ls="none", marker="s", ms=0.96, mew=0,
            antialiased=False, color=style.tinted(colour, pale), zorder=1.6 - 0.1 * i / len(kept),
            rasterized=len(rows) > VECTOR,
            label=f"{name} {label}",
        )  # fmt: skip


def lines(ax: Axes, subject: Subject, across: str, force: Array, name: str, **how: Any) -> None:
    """Typical cycles of each group as closed loops; the chosen ones differ most."""
    fx, fy = style.AXES[across].scale, style.AXES["force"].scale
    values = getattr(subject.recording, across)
    told = groups(subject)
    for code, label in enumerate(told.labels):
        x, y = thin.joined(typical(subject, force, code), values, force)
        options = {"color": told.colours[code], "lw": 1.1, **how}
        ax.plot(
            x * fx,
            y * fy,
            label=f"{name} {label}",
            zorder=2.6 - 0.1 * code / len(told.labels),
            **options,
        )


def typical(
    subject: Subject, force: Array, code: int, most: int = LOOPS, when: Flags | None = None
) -> list[Index]:
    """Samples of the cycles of one group that differ most in stroke, speed and force.

    when : (n,) samples that count; None for all

    The cycles with the highest and the lowest force are among them. Where the duty changes within
    every cycle, the parts at that level; where there is no cycle, all samples in their order.
    """
    r, own = subject.recording, groups(subject).code == code
    own = own if when is None else own & when
    first, end = subject.cycles
    here = np.concatenate([[0], np.cumsum(own)])
    share = (here[end] - here[first]) / np.maximum(end - first, 1)
    usable = np.flatnonzero(share == 1.0)
    if not usable.size:
        usable = np.flatnonzero(share > PART)
    if not usable.size:
        pieces = _runs(np.flatnonzero(own), r.starts)
        evenly = np.linspace(0, len(pieces) - 1, min(len(pieces), MANY)).astype(int)
        return [_thinned(pieces[i], force) for i in evenly.tolist()]
    a, b = first[usable], end[usable]
    features = np.column_stack([_span(v, a, b) for v in (r.x, r.xdot, force)])
    high, low = _over(np.maximum, force, a, b), _over(np.minimum, force, a, b)
    chosen = set(varied(features, most).tolist())
    some, least = sorted(chosen), APART * (high.max() - low.min())
    if high[some].max() < high.max() - least:
        chosen.add(int(high.argmax()))
    if low[some].min() > low.min() + least:
        chosen.add(int(low.argmin()))
    out = []
    for i in sorted(chosen):
        rows = np.arange(a[i], b[i])
        out += [_thinned(run, force) for run in _runs(rows[own[rows]], r.starts)]
    return out


def over_time(
    ax: Axes, t: Array, values: Array, starts: Index, scale: float = 1.0, **how: Any
) -> None:
    """A line over time, thinned to the pixels with its extremes, broken between records."""
    rows = thin.series(values, starts)
    x, y = thin.gapped(rows, starts, t, values * scale if scale != 1.0 else values)
    ax.plot(x, y, **how)


def clock(subject: Subject, ax: Axes) -> Array:
    """(n,) time to draw over: records one after the other; labels the axis and marks the seams."""
    r = subject.recording
    if len(r.names) == 1:
        ax.set_xlabel(style.AXES["t"].label)
        return r.t
    begin, end = r.t[r.starts[:-1]], r.t[r.starts[1:] - 1]
    seams = np.concatenate([[0.0], np.cumsum(end - begin)])
    if len(seams) < 60:
        for seam in seams[1:-1].tolist():
            ax.axvline(seam, color="0.8", lw=0.6, zorder=0.5)
    ax.set_xlabel(f"time, {len(r.names)} records end to end [{style.AXES['t'].unit}]")
    return r.t + np.repeat(seams[:-1] - begin, np.diff(r.starts))


def key_of_groups(out: Figure, subject: Subject, others: Sequence[Artist]) -> None:
    """The legend at the right: what dots and lines are, and the colours of the groups."""
    _key(out, groups(subject), others)


def key_of_levels(out: Figure, subject: Subject, others: Sequence[Artist]) -> None:
    """The same, with the shades of the PWM levels in any case."""
    _key(out, _levels(subject), others)


def _key(out: Figure, told: Groups, others: Sequence[Artist]) -> None:
    from matplotlib.lines import Line2D

    marks = [
        Line2D([], [], color=c, lw=5, solid_capstyle="butt", label=label)
        for label, c in zip(told.labels, told.colours, strict=True)
    ]
    title = Line2D([], [], ls="none", label=told.title)
    out.legend(handles=[*others, title, *marks], loc="outside right center")


def mark(name: str, **how: Any) -> Artist:
    """A handle for a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], label=name, **how)


DOTS = {"ls": "none", "marker": "o", "ms": 4, "mew": 0, "color": "0.6"}


def _span(values: Array, first: Index, end: Index) -> Array:
    return _over(np.maximum, values, first, end) - _over(np.minimum, values, first, end)


def _over(ufunc: np.ufunc, values: Array, first: Index, end: Index) -> Array:
    """(k,) of each piece; the last sample of a cycle is the first of the next, and left out."""
    out: Array = ufunc.reduceat(values, np.column_stack([first, end - 1]).ravel())[::2]
    return out


def _runs(rows: Index, starts: Index) -> list[Index]:
    """Ascending rows, cut where samples are missing in between or a record ends."""
    record = np.searchsorted(starts, rows, side="right")
    cut = np.flatnonzero((np.diff(record) != 0) | (np.diff(rows) != 1)) + 1
    return [run for run in np.split(rows, cut) if len(run) > 1]


def _thinned(rows: Index, force: Array) -> Index:
    return rows[thin.series(force[rows], np.array([0, len(rows)]), POINTS)]
