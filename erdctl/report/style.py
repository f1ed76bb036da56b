"""Colours, line styles and axes that all pictures share.

PWM levels are shades of one scale, from light to dark, so they keep their order in grey and for
every kind of colour vision. What is no number (healthy, faulty; before, after) has a colour of
Okabe and Ito's set and a line style of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from erdctl.core.recording import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK, PALE = "0.15", "0.62"
# Colour and line style of the first, second, ... thing to tell apart.
SERIES: tuple[tuple[str, Any], ...] = (
    ("0.45", "-"),
    ("#0072B2", "-"),
    ("#D55E00", "--"),
    ("#009E73", "-."),
    ("#CC79A7", ":"),
    ("#000000", (0, (5, 1, 1, 1, 1, 1))),
)


@dataclass(frozen=True)
class AxisScale:
    """What an axis shows: name, the unit that engineers read it in, and how many make an SI one."""

    name: str
    unit: str
    scale: float

    @property
    def label(self) -> str:
        """The axis label, with the unit."""
        return f"{self.name} [{self.unit}]"


AXES = {
    "t": AxisScale("time", "s", 1.0),
    "x": AxisScale("deflection, compression +", "mm", 1e3),
    "xdot": AxisScale("velocity, compression +", "mm/s", 1e3),
    "duty": AxisScale("duty cycle", "%", 100.0),
    "force": AxisScale("force", "N", 1.0),
}

SIGNED = ("x", "xdot", "force")  # whose zero means something


def label(ax: Axes, across: str, up: str) -> tuple[float, float]:
    """Label both axes by quantity; returns the scales of either from SI."""
    ax.set_xlabel(AXES[across].label)
    ax.set_ylabel(AXES[up].label)
    if across in SIGNED:
        ax.axvline(0.0, color="0.75", lw=0.8, zorder=1)
    if up in SIGNED:
        ax.axhline(0.0, color="0.75", lw=0.8, zorder=1)
    return AXES[across].scale, AXES[up].scale


def series(count: int) -> list[tuple[str, Any]]:
    """Colour and line style of so many things; more than there are styles begin again."""
    return [SERIES[i % len(SERIES)] for i in range(count)]


def shades(count: int) -> list[tuple[float, float, float]]:
    """Colours of so many levels, light to dark (viridis turned round, without its yellow end)."""
    import matplotlib as mpl

    along = np.linspace(0.22, 0.97, count) if count > 1 else np.array([0.75])
    return [tuple(c[:3]) for c in mpl.colormaps["viridis_r"](along).tolist()]


def tinted(colour: tuple[float, float, float], white: float) -> tuple[float, float, float]:
    """A colour mixed with white (> 0) or black (< 0)."""
    end = 1.0 if white > 0 else 0.0
    r, g, b = (c + (end - c) * abs(white) for c in colour)
    return r, g, b


def percent(level: float) -> str:
    """A PWM level as people say it."""
    return f"{100 * level:.4g} %"


def spread(values: Array) -> float:
    """Highest less lowest finite value."""
    return float(np.nanmax(values) - np.nanmin(values))
