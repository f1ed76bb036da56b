"""Where a misfit is large: over velocity and duty, and along one variable."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.messages import counted
from erdctl.core.recording import Array, Recording
from erdctl.score.nrmse import duty_levels

SPEEDS = 24  # bins of velocity
BINS = 40  # along a variable
FEWEST = 5  # samples that make a figure


@dataclass(frozen=True, eq=False)
class MisfitMap:
    """Root mean square misfit by velocity and PWM level.

    edges : (b + 1,) of the bins of velocity [m/s];  levels : (l,) [1]
    rms : (l, b) [N], NaN where there are too few samples;  count : (l, b) samples
    """

    edges: Array
    levels: Array
    rms: Array
    count: Array


def misfit_map(recording: Recording, residual: Array, bins: int = SPEEDS) -> MisfitMap:
    """Misfit (n,) [N] over velocity and duty.

    Raises InputProblem if no cell has FEWEST samples.
    """
    codes, levels = duty_levels(recording.duty)
    top = float(np.abs(recording.xdot).max()) or 1.0
    edges = np.linspace(-top, top, bins + 1)
    at = np.minimum(((recording.xdot + top) * (bins / (2 * top))).astype(np.intp), bins - 1)
    at += codes.astype(np.intp) * bins
    count = np.bincount(at, minlength=len(levels) * bins).reshape(-1, bins)
    square = np.bincount(at, residual**2, len(levels) * bins).reshape(-1, bins)
    if count.max() < FEWEST:
        raise InputProblem(f"too few for a map of the misfit: {counted(len(residual), 'sample')}")
    n = np.where(count >= FEWEST, count, np.nan)
    return MisfitMap(edges, levels, np.sqrt(square / n), count.astype(np.float64))


def along(values: Array, residual: Array, edges: Array) -> Array:
    """(b,) root mean square of a misfit (n,) [N] in bins of a variable (n,), NaN where unseen."""
    at = np.searchsorted(edges, values, side="right") - 1
    # The last bin holds its upper edge; values beyond the edges count nowhere.
    at[values == edges[-1]] = len(edges) - 2
    inside = (at >= 0) & (at < len(edges) - 1) & np.isfinite(values)
    count = np.bincount(at[inside], minlength=len(edges) - 1)
    square = np.bincount(at[inside], residual[inside] ** 2, len(edges) - 1)
    out: Array = np.sqrt(square / np.where(count >= FEWEST, count, np.nan))
    return out


def edges_of(values: Array, bins: int = BINS) -> Array:
    """(b + 1,) even edges over the finite values of a variable (n,)."""
    finite = values[np.isfinite(values)]
    if not finite.size or finite.min() == finite.max():
        centre = float(finite[0]) if finite.size else 0.0
        return np.array([centre - 0.5, centre + 0.5])
    return np.linspace(float(finite.min()), float(finite.max()), bins + 1)
