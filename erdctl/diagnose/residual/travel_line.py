"""A line in the spectrum of a residual over travel: what comes again with every so much way.

A seal that sticks, stretches and springs back makes a saw-tooth whose teeth are as long as it slips
at any speed of the piston; so does a bore with a ripple. Where the motion never repeats itself
no state in the log tells the phase of such teeth: a regression takes them for noise. Over travel
each stroke has some of them, of one length. Noise has a colour in time, which over travel is a
broad one, as the speed changes within a stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem


@dataclass(frozen=True)
class TravelLine:
    """Wavelength [m], and share of the residual's square."""

    wavelength: float
    share: float


def travel_line(problem: Problem, residual: Array) -> TravelLine | None:
    """The line over travel in a residual (n,) [N], if there is one.

    The mean over strokes of their spectra, on a grid of the travel of a usual sample, is compared
    with its own median around; of each stroke at least some cycles must be seen.
    """
    step = _usual_travel(problem)
    pieces = _strokes(problem, residual, step) if step > 0.0 else []
    if len(pieces) < thresholds.TRAVEL_STROKES:
        return None
    bins = thresholds.TRAVEL_BINS
    windowed = np.zeros((len(pieces), bins))
    power = 0.0
    for row, values in zip(windowed, pieces, strict=True):
        window = np.hanning(len(values))
        norm = float(np.sqrt(window @ window))
        row[: len(values)] = window * (values - values.mean()) / norm
        power += float(np.sum((window * values / norm) ** 2)) / len(pieces)
    spectrum = np.mean(np.abs(np.fft.rfft(windowed)) ** 2, axis=0)
    cycle = bins / float(np.median([len(values) for values in pieces]))  # of a usual stroke
    lowest = int(np.ceil(thresholds.TRAVEL_CYCLES * cycle))
    k = np.arange(len(spectrum))
    height, at, share = 0.0, 0, 0.0
    for i in range(lowest, len(spectrum) - 1):
        away = np.abs(k - i)
        core = away <= thresholds.TRAVEL_WIDTH * cycle  # a window makes a line as broad
        near = away <= max(thresholds.TRAVEL_AROUND * i, 2 * thresholds.TRAVEL_WIDTH * cycle)
        around = float(np.median(spectrum[near & ~core]))
        if around > 0.0 and spectrum[i] / around > height:
            height, at = float(spectrum[i]) / around, i
            line = float(np.maximum(spectrum[core] - around, 0.0).sum())
            share = 2 * line / bins / max(power, 1e-300)  # half of it is at -k
    if height < thresholds.TRAVEL_HEIGHT or share < thresholds.TRAVEL_SHARE:
        return None
    return TravelLine(wavelength=bins * step / at, share=min(share, 1.0))


def _usual_travel(problem: Problem) -> float:
    """Travel from sample to sample where there is any, the median [m]."""
    path = problem.block.signals.path[0]
    return float(np.median(path[path > 0.0])) if (path > 0.0).any() else 0.0


def _strokes(problem: Problem, residual: Array, step: float) -> list[Array]:
    """(m,) each: the residual over even steps of travel, from turn to turn, in pieces."""
    s, weight = problem.block.signals, problem.block.weight
    total = np.concatenate([[0.0], np.cumsum(s.path[0][:-1])])
    out = []
    for a, b in pairwise(np.unique(np.concatenate([s.starts, s.turns[0] + 1])).tolist()):
        told = a + np.flatnonzero(weight[a:b] > 0.0)
        if len(told) < thresholds.TRAVEL_LEAST:
            continue
        way = total[told]
        grid = np.arange(way[0], way[-1], step)
        even = np.interp(grid, way, residual[told])
        for i in range(0, len(even), thresholds.TRAVEL_BINS):
            piece = even[i : i + thresholds.TRAVEL_BINS]
            if len(piece) >= thresholds.TRAVEL_LEAST:
                out.append(piece)
    return out
