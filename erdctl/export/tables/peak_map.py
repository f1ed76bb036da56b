"""Force at the highest speed of steady sines, over speed and duty, with its standard error."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array, Index, Recording
from erdctl.export.tables.grid import Grid
from erdctl.model.parameters import NORMAL_95, Estimate, Parameters
from erdctl.model.simulate import simulate

SAMPLES = 400  # of a cycle; both peaks fall on one
CYCLES = 3  # at least, the last of which counts
MOST_CYCLES = 60
LAGS = 10.0  # time constants of the yield force that the sine goes on


@dataclass(frozen=True, eq=False)
class PeakMap:
    """A table of forces.

    grid : its places;  force, stderr : (2 n, m) by speed and duty [N], stderr NaN where unknown
    exact : parameters that have no standard error and count as exact
    """

    grid: Grid
    force: Array
    stderr: Array
    exact: tuple[str, ...]

    def at(self, xdot: Array, duty: Array) -> Array:
        """(n,) force [N], linear between the places, and at its end value beyond them.

        Check: 0 N at -1 m/s and 10 N at 1 m/s give 7.5 N at 0.5 m/s, and 10 N at 2 m/s.
        >>> at = Grid(
        ...     speed=np.array([-1.0, 1.0]), duty=np.zeros(1), centre=0.0, amplitude=1.0
        ... )
        >>> table = PeakMap(at, np.array([[0.0], [10.0]]), np.zeros((2, 1)), ())
        >>> table.at(np.array([0.5, 2.0]), np.zeros(2)).tolist()
        [7.5, 10.0]
        """
        v, u = self.grid.speed, self.grid.duty
        x = np.clip(xdot, v[0], v[-1])
        i = np.clip(np.searchsorted(v, x, side="right") - 1, 0, len(v) - 2)
        a = (x - v[i]) / (v[i + 1] - v[i])
        by_duty = (1.0 - a)[:, None] * self.force[i] + a[:, None] * self.force[i + 1]
        if len(u) == 1:
            return np.asarray(by_duty[:, 0])
        d = np.clip(duty, u[0], u[-1])
        j = np.clip(np.searchsorted(u, d, side="right") - 1, 0, len(u) - 2)
        b = (d - u[j]) / (u[j + 1] - u[j])
        row = np.arange(len(x))
        return np.asarray((1.0 - b) * by_duty[row, j] + b * by_duty[row, j + 1])


def peak_map(
    parameters: Parameters, grid: Grid, progress: Callable[[int, int], None] = lambda i, n: None
) -> PeakMap:
    """The table of a damper, by simulation of one steady sine for each speed and duty.

    The standard error of a force is that of the parameters, with effects of the order of one of
    their errors, and taken as independent of each other, since a parameter file holds no more:

        se_F^2 = sum_p [ (F(p + se_p) - F(p - se_p)) / 2 ]^2

    progress : called with the number of simulations done, and of all
    """
    errors = standard_errors(parameters)
    total = 1 + 2 * len(errors)
    force = _forces(parameters, grid)
    square = np.zeros_like(force)
    for number, (name, error) in enumerate(errors.items()):
        progress(1 + 2 * number, total)
        q, value = parameters.model.quantities[name], parameters.values[name]
        ends = max(value - error, q.low), min(value + error, q.high)
        low, high = (_forces(_with(parameters, name, end), grid) for end in ends)
        # At a bound the step to one side is shorter.
        square += ((high - low) * error / (ends[1] - ends[0])) ** 2
    progress(total, total)
    exact = tuple(n for n in parameters.estimates if n not in errors)
    unknown = np.full_like(force, np.nan)
    return PeakMap(grid, force, np.sqrt(square) if errors else unknown, exact)


def standard_errors(parameters: Parameters) -> dict[str, float]:
    """Standard errors above 0 by name; of an interval alone, its half width over 1.96."""
    out = {}
    for name, e in parameters.estimates.items():
        error = e.stderr
        if error is None and e.within is not None:
            error = 0.5 * (e.within[1] - e.within[0]) / NORMAL_95
        if e.value is not None and error is not None and error > 0.0:
            out[name] = error
    return out


def _with(parameters: Parameters, name: str, value: float) -> Parameters:
    unit = parameters.estimates[name].unit
    changed = {**parameters.estimates, name: Estimate(value=value, unit=unit)}
    return replace(parameters, estimates=changed)


def _forces(parameters: Parameters, grid: Grid) -> Array:
    """(2 n, m) force at the peaks; one sine has that of compression and that of release."""
    rows = {}
    lag = LAGS * max(parameters.values[f"{d}.T_d"] for d in DIRECTIONS)
    for speed in np.unique(np.abs(grid.speed)).tolist():
        r, peaks = sines(speed, grid, lag)
        force = simulate(parameters, r)
        rows[speed], rows[-speed] = force[peaks[0]], force[peaks[1]]
    return np.array([rows[v] for v in grid.speed.tolist()])


def sines(speed: float, grid: Grid, lag: float) -> tuple[Recording, tuple[Index, Index]]:
    """A steady sine of one highest speed [m/s], one record for each duty of a grid.

        x = centre + A sin(w t),  xdot = v cos(w t),  w = v / A

    lag : time that it goes on at least [s], up to 60 cycles
    Returns the recording, and the samples (m,) at which the last compression and the last release
    are fastest.
    """
    period = 2.0 * math.pi * grid.amplitude / speed
    cycles = min(max(CYCLES, math.ceil(lag / period) + 1), MOST_CYCLES)
    n, m = cycles * SAMPLES + 1, len(grid.duty)
    phase = 2.0 * math.pi * np.arange(n) / SAMPLES
    starts = n * np.arange(m + 1, dtype=np.intp)
    recording = Recording(
        t=np.tile(np.arange(n) * (period / SAMPLES), m),
        x=np.tile(grid.centre + grid.amplitude * np.sin(phase), m),
        xdot=np.tile(speed * np.cos(phase), m),
        duty=np.repeat(grid.duty, n),
        starts=starts,
        names=tuple(f"duty {u:g}" for u in grid.duty.tolist()),
        temperature=None if grid.temperature is None else np.full(n * m, grid.temperature),
        xdot_note="closed form",
    )
    last = starts[1:] - 1
    return recording, (last, last - SAMPLES // 2)
