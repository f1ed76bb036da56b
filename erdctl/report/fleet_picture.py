"""The fleet at a glance: which parameter of which damper changed, the surest ones over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from erdctl.compare.comparison import Compared, Damper
from erdctl.compare.pair import Change, Pair
from erdctl.compare.trend import Trend
from erdctl.core.errors import InputProblem
from erdctl.report import style
from erdctl.report.changes import head, noun, relative
from erdctl.report.readable import scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROWS, PANELS = 40, 6  # dampers of the chart, changes drawn over time


def fleet_figure(found: Compared) -> Figure:
    """A figure of a comparison.

    Raises InputProblem where there is neither a trend nor a difference to draw.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    from erdctl.report.picture import style_file

    # The surest of each damper before the second of any.
    ranked = [(k, i, t) for i, d in enumerate(found.dampers) for k, t in enumerate(d.changes)]
    trends = [t for _, _, t in sorted(ranked, key=lambda r: r[:2])]
    over_time = any(d.trends for d in found.dampers)
    pairs = [p for d in found.dampers for p in d.pairs]
    if not over_time and not pairs:
        raise InputProblem("the picture would show nothing: every damper has one log")
    with mpl.rc_context(fname=style_file()):
        if not over_time:
            out = Figure(figsize=(8.0, 4.6), layout="constrained")
            _differences(out, pairs)
        else:
            rows = min(len(found.dampers), ROWS)
            tall = max(3.2, 1.4 + 0.2 * rows, 1.5 * ((min(len(trends), PANELS) + 1) // 2))
            out = Figure(figsize=(12.0, tall), layout="constrained")
            parts: Any = out.subfigures(1, 2, width_ratios=(1.0, 1.25))
            left, right = parts
            _chart(left.subplots(), found.dampers[:ROWS])
            _panels(right, found, trends[:PANELS])
        out.suptitle(head(found), x=0.01, ha="left")
    return out


def _chart(ax: Axes, dampers: Any) -> None:
    """Dampers by parameters: the change from the first to the last date, in per cent."""
    names = list(dict.fromkeys(n for d in dampers for n in d.trends))
    names.sort(
        key=lambda n: (
            "." not in n,
            not any(d.trends[n].changed for d in dampers if n in d.trends),
            n,
        )
    )
    change = np.full((len(dampers), len(names)), np.nan)
    for i, d in enumerate(dampers):
        for j, name in enumerate(names):
            t = d.trends.get(name)
            if t is not None:
                change[i, j] = relative(t) if t.changed else 0.0
    ax.imshow(np.where(np.isnan(change), np.nan, np.sign(change)), cmap="PuOr_r", vmin=-2.5,
              vmax=2.5, aspect="auto")  # fmt: skip
    for i, j in np.argwhere(np.nan_to_num(change) != 0.0).tolist():
        t = dampers[i].trends[names[j]]
        text = f"{100 * change[i, j]:+.0f} %".replace("-", "−")
        text = "new" if t.absent_before else "gone" if t.absent_after else text
        ax.text(j, i, text, ha="center", va="center", size=6, color="black")
    ax.grid(visible=False)
    ax.set_xticks(range(len(names)), names, rotation=90, size=7)
    ax.set_yticks(range(len(dampers)), [d.history.damper for d in dampers], size=7)
    ax.set_title(
        "change from first to last date; those that need attention first", loc="left", size=8
    )


def _panels(figure: Any, found: Compared, trends: list[Trend]) -> None:
    """The surest changes over time, with the interval of their date and a year to come."""
    if not trends:
        figure.text(0.5, 0.5, "no parameter of any damper changed over time", ha="center")
        return
    of = {id(t): d for d in found.dampers for t in d.trends.values()}
    columns = 1 if len(trends) < 3 else 2
    axes = np.atleast_1d(figure.subplots(-(-len(trends) // columns), columns)).ravel()
    for ax in axes[len(trends) :]:
        ax.set_visible(False)
    for ax, t in zip(axes, trends, strict=False):
        _panel(ax, of[id(t)], t)


def _panel(ax: Axes, damper: Damper, t: Trend) -> None:
    from matplotlib import dates  # which count days since 1970, too

    s = t.series
    factor, unit = scaled(s.unit, float(np.nanmax(np.abs(s.value))))
    grid = np.linspace(s.t[0], s.t[-1] + t.ahead, 300)
    f, _ = t.at(grid)
    low, high = t.band(grid)
    to_come = grid >= s.t[-1]
    colour = style.series(2)[1][0]
    ax.fill_between(grid[to_come], low[to_come] * factor, high[to_come] * factor,
                    color=colour, alpha=0.2, lw=0)  # fmt: skip
    named = s.named
    ax.errorbar(
        s.t[named], s.value[named] * factor,
        yerr=1.96 * np.nan_to_num(s.error[named]) * factor, fmt="o", ms=2, lw=0.5, color="0.45",
    )  # fmt: skip
    ax.plot(grid, f * factor, color=colour, lw=1.4)
    if t.since is not None:
        first, last = np.array(t.since[1:])
        ax.axvspan(first, last, color="0.85", zorder=0)
    for judged in damper.judged:
        if judged.name == s.name:
            for end in (judged.band.low, judged.band.high):
                if np.isfinite(end):
                    ax.axhline(end * factor, color="#D55E00", lw=0.8, ls="--")
    ax.set_title(f"{damper.history.damper}: {noun(s.name)}", loc="left", size=8)
    ax.set_ylabel(unit if unit != "1" else "")
    mdates: Any = dates
    locator = mdates.AutoDateLocator(minticks=3, maxticks=8)
    ax.xaxis.set_major_locator(locator)
    ax.xaxis.set_major_formatter(mdates.ConciseDateFormatter(locator))


def _differences(figure: Figure, pairs: list[Pair]) -> None:
    """Each parameter's change over its error, pair by pair."""
    ax = figure.subplots()
    names = list(dict.fromkeys(d.name for p in pairs for d in p.differences if d.error > 0.0))
    row = {name: len(names) - i for i, name in enumerate(names)}
    for k, (p, (colour, _)) in enumerate(
        zip(pairs, style.series(len(pairs) + 1)[1:], strict=False)
    ):
        some = [d for d in p.differences if d.error > 0.0]
        y = [row[d.name] - 0.12 * k for d in some]
        sure = [d.verdict not in (Change.SAME, Change.UNKNOWN) for d in some]
        z = [d.change / d.error for d in some]
        label = f"{p.after[0].logs[p.after[1]]} against {p.before[0].logs[p.before[1]]}"
        ax.scatter(z, y, s=18, marker="o", edgecolors=colour,
                   facecolors=[colour if s else "none" for s in sure], label=label)  # fmt: skip
    ax.axvspan(-1.96, 1.96, color="0.9", zorder=0)
    ax.axvline(0.0, color="0.6", lw=0.8)
    ax.set_yticks(list(row.values()), list(row))
    ax.set_xlabel(
        "change over its standard error; filled: beyond its error, all parameters counted"
    )
    ax.legend(loc="best", fontsize=7)
