"""What a table says of itself: how it was taken, what it cannot hold, and what that costs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.recording import DIRECTIONS
from erdctl.export.damper_alone import without
from erdctl.export.origin import Origin, lines, plain
from erdctl.export.tables.peak_map import PeakMap
from erdctl.export.tables.static_cost import Cost
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters

SEEN = 1e-3  # of the range of a table's forces: a step that is smaller is none


def taken(table: PeakMap) -> list[str]:
    """How the forces were taken, and what their errors are."""
    g = table.grid
    how = (
        f"force at the highest speed of steady sines of {1e3 * g.amplitude:.4g} mm about"
        f" x = {1e3 * g.centre:.4g} mm, the duty held; in between, interpolate linearly"
    )
    # In words, as a file may have the signs turned.
    between = (
        f"{1e3 * _inner(table, -1):.3g} mm/s in release and {1e3 * _inner(table, 1):.3g} mm/s in"
        " compression"
    )
    jump = f"no row at speed 0: what is looked up between {between} is a straight line"
    if _jumps(table):
        jump = (
            "no row at speed 0: the force jumps, or nearly so, where the motion turns, and what is"
            f" looked up between {between} is a line over that jump"
        )
    warm = [] if g.temperature is None else [f"at a temperature of {g.temperature:g} degC"]
    return [how, jump, *warm, *_errors(table)]


def _jumps(table: PeakMap) -> bool:
    """Whether the curve of any duty, drawn on to speed 0 from both sides, has a step there.

    Without control the paper's damper has none: F = k_nom x + c_vis xdot.
    """
    v, force = table.grid.speed, table.force
    n = len(v) // 2
    ends = [
        force[i] - v[i] * (force[k] - force[i]) / (v[k] - v[i])
        for i, k in ((n - 1, n - 2), (n, n + 1))
    ]
    return bool(np.abs(ends[1] - ends[0]).max() > SEEN * np.ptp(force))


def _inner(table: PeakMap, way: int) -> float:
    v = table.grid.speed
    return float(abs(v[v * way > 0][0 if way > 0 else -1]))


def _errors(table: PeakMap) -> list[str]:
    if np.isnan(table.stderr).all():
        return ["standard errors: none, since no parameter has one"]
    said = (
        "standard errors: from those of the parameters, taken as independent of each other (the"
        " parameter file holds no covariance); they hold no error of the model"
    )
    if table.exact:
        said += f"; taken as exact, for they have none: {', '.join(map(plain, table.exact))}"
    return [said]


def cannot(parameters: Parameters) -> list[str]:
    """What the damper does that no table over speed and duty holds."""
    v = parameters.values
    pairs = {s: [v[f"{d}.{s}"] for d in DIRECTIONS] for s in ("k_nom", "T_d")}
    out = [
        "the table cannot hold the gas spring over x: k_nom"
        f" {pairs['k_nom'][0]:.4g} N/m in compression, {pairs['k_nom'][1]:.4g} N/m in release",
        f"nor the lag of the yield force after steps of the duty: T_d {pairs['T_d'][0]:.4g} s in"
        f" compression, {pairs['T_d'][1]:.4g} s in release",
    ]
    # What depends on the speed alone, a table over speed holds.
    others = [f"{plain(e.title)} ({plain(e.name)})" for e in parameters.model.effects
              if not e.of_speed]  # fmt: skip
    if others:
        out.append("nor more than its value at the peaks of these sines of: " + "; ".join(others))
    return out


def cost(found: Cost) -> list[str]:
    """What that costs."""
    said = f"NRMSE of the table to the whole model on {found.sweep}: {found.held:.4g}, duty held"
    if found.stepping is not None:
        said += f"; {found.stepping:.4g}, duty stepping between the levels every 0.5 s"
    return [
        said,
        f"with a spring of {found.spring:.4g} N/m (force against x) beside the table:"
        f" {found.beside:.4g}, duty held",
    ]


def about(
    parameters: Parameters, table: PeakMap, found: Cost, origin: Origin, left_out: Sequence[Effect]
) -> list[str]:
    """All of it, a line for each thing."""
    out = [*lines(parameters, origin), *taken(table), *cannot(parameters), *cost(found)]
    out += without(left_out)
    faults = [plain(e.name) for e in parameters.model.effects if e.sets_in]
    if faults:
        out.append(f"of the damper after these have set in: {', '.join(faults)}")
    return out
