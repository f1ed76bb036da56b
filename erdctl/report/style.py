"""Colours, line styles and axes that all pictures share.

PWM levels are shades of one scale, from light to dark, so they keep their order in grey and for
every kind of colour vision, and pages take the same ones. What is no number (healthy, faulty;
before, after) has a colour of Okabe and Ito's set and a line style of its own.
"""

from __future__ import annotations

from colorsys import hls_to_rgb, rgb_to_hls
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from erdctl.core.recording import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK, PALE = "0.15", "0.62"
LEAST_ON_DARK = 0.13  # luminance that gives a contrast of 3 to 1 to the dark paper of a page
# Viridis from light to dark (van der Walt and Smith, CC0), here since pages need no more of
# matplotlib than this; of misfit maps whole, of PWM levels without its ends.
HEAT = (
    "#fde725", "#eae51a", "#d5e21a", "#c0df25", "#aadc32", "#95d840", "#81d34d", "#6ece58",
    "#5cc863", "#4cc26c", "#3dbc74", "#31b57b", "#27ad81", "#21a685", "#1f9f88", "#1f978b",
    "#21908d", "#23888e", "#26818e", "#29798e", "#2c718e", "#306a8e", "#33628d", "#375a8c",
    "#3b518b", "#3f4889", "#423f85", "#453581", "#472c7a", "#482173", "#481769", "#460b5e",
    "#440154",
)  # fmt: skip
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
    """Colours of so many levels, light to dark."""
    along = np.linspace(0.22, 0.97, count) if count > 1 else np.array([0.75])
    stops = np.array([[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in HEAT])
    even = np.linspace(0.0, 1.0, len(HEAT))
    r, g, b = (np.interp(along, even, channel).tolist() for channel in stops.T)
    return list(zip(r, g, b, strict=True))


def on_dark(colour: tuple[float, float, float]) -> tuple[float, float, float]:
    """The colour of the same hue that stands out from dark paper: as light as need be, no lighter.

    Check: the light yellow (0.8, 0.9, 0.2) stays as it is.
    >>> on_dark((0.8, 0.9, 0.2))
    (0.8, 0.9, 0.2)
    """
    r, g, b = colour
    hue, light, full = rgb_to_hls(r, g, b)
    while luminance((r, g, b)) < LEAST_ON_DARK:
        light += 0.01
        r, g, b = hls_to_rgb(hue, light, full)
    return r, g, b


def luminance(colour: tuple[float, float, float]) -> float:
    """Relative luminance of a colour of the sRGB standard, 0 to 1 (WCAG 2)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return sum(part * c for part, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def hexadecimal(colour: tuple[float, float, float]) -> str:
    """A colour as a page writes it."""
    return "#" + "".join(f"{round(255 * c):02x}" for c in colour)


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
