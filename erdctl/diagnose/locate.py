"""Where a misfit lives: the variable and the interval that hold most of its energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.diagnose.study import Study
from erdctl.effect import Variable
from erdctl.recording import Array
from erdctl.signals import Signals

HELD = 0.75  # share of the energy that a region must hold
BINS = 60
WIDE = 0.6  # of the time: a region that covers more says nothing

UNITS = {
    Variable.XDOT: (1e3, "mm/s"),
    Variable.X: (1e3, "mm"),
    Variable.DUTY: (1e2, "%"),
    Variable.TIME: (1.0, "s"),
    Variable.SINCE_REVERSAL: (1e3, "ms"),
    Variable.SINCE_DUTY_STEP: (1e3, "ms"),
    Variable.ENERGY: (1.0, "J"),
}


@dataclass(frozen=True)
class Region:
    """An interval of one variable, and the share of the misfit's energy in it.

    time : share of the samples in it, which is what the energy share is to be held against
    """

    variable: Variable
    low: float
    high: float
    share: float
    time: float
    text: str


def variables(signals: Signals, force: Array) -> dict[Variable, Array]:
    """(n,) values of every variable over which a misfit can gather; inf where there is none."""
    start = np.repeat(signals.starts[:-1], np.diff(signals.starts))
    power = np.maximum(force * signals.xdot, 0.0) * signals.step
    energy = np.cumsum(power)
    energy -= energy[start] - power[start]
    return {
        Variable.XDOT: signals.xdot,
        Variable.X: signals.x,
        Variable.DUTY: signals.duty,
        Variable.TIME: signals.t,
        Variable.SINCE_REVERSAL: signals.since_reversal,
        Variable.SINCE_DUTY_STEP: signals.since_duty_step,
        Variable.ENERGY: energy,
    }


def locate(study: Study, square: Array) -> list[Region]:
    """Regions in which a squared misfit (n,) [N^2] gathers, the sharpest first; none if nowhere."""
    weight = study.block.weight
    energy = weight * square
    total = float(energy.sum())
    if total <= 0.0:
        return []
    found = []
    for variable, values in variables(study.block.signals, study.block.force).items():
        region = _interval(variable, values, energy / total, weight / weight.sum())
        if region is not None and region.time < WIDE:
            found.append(region)
    return sorted(found, key=lambda r: r.time / r.share)


def _interval(variable: Variable, values: Array, energy: Array, time: Array) -> Region | None:
    """The interval of least time that holds HELD of the energy."""
    finite = np.isfinite(values) & (time > 0)
    if not finite.any() or float(energy[finite].sum()) < HELD:
        return None
    v, e, w = values[finite], energy[finite], time[finite]
    order = np.argsort(v, kind="stable")
    v, e, w = v[order], e[order], w[order]
    if v[0] == v[-1]:
        return None
    # Edges at equal steps of value and at equal shares of time: fine in either sense.
    edges = np.unique(
        np.concatenate([
            np.linspace(v[0], v[-1], BINS + 1),
            v[np.searchsorted(np.cumsum(w), np.linspace(0, w.sum(), BINS + 1)[1:-1])],
        ])
    )  # fmt: skip
    at = np.searchsorted(v, edges, side="left")
    at[-1] = len(v)
    E = np.concatenate([[0.0], np.cumsum(e)])[at]
    W = np.concatenate([[0.0], np.cumsum(w)])[at]
    best: tuple[float, int, int] | None = None
    j = 0
    for i in range(len(edges) - 1):
        j = max(j, i + 1)
        while j < len(edges) - 1 and E[j] - E[i] < HELD:
            j += 1
        if E[j] - E[i] < HELD:
            break
        length = W[j] - W[i]
        if best is None or length < best[0]:
            best = (float(length), i, j)
    if best is None:
        return None
    time_in, i, j = best
    low, high = float(edges[i]), float(edges[j])
    share = float(E[j] - E[i])
    return Region(variable, low, high, share, time_in, describe(variable, low, high, share))


def describe(variable: Variable, low: float, high: float, share: float) -> str:
    """A region in an engineer's words."""
    scale, unit = UNITS[variable]
    a, b = low * scale, high * scale
    percent = f"{100 * share:.0f} % of the misfit"
    match variable:
        case Variable.SINCE_REVERSAL:
            where = f"within {b:.3g} {unit} of a reversal"
            where = where if low <= 0.2 * high else f"{a:.3g} to {b:.3g} {unit} after a reversal"
        case Variable.SINCE_DUTY_STEP:
            where = f"within {b:.3g} {unit} of a duty step"
            where = where if low <= 0.2 * high else f"{a:.3g} to {b:.3g} {unit} after a duty step"
        case Variable.XDOT if low < 0 < high:
            where = f"at speeds from {a:.3g} to {b:.3g} {unit}, around reversal"
        case Variable.XDOT:
            side = "compression" if high > 0 else "release"
            where = f"in {side}, at {a:.3g} to {b:.3g} {unit}"
        case Variable.DUTY:
            where = f"at {a:.3g} to {b:.3g} {unit} duty"
        case Variable.X:
            where = f"at deflections from {a:.3g} to {b:.3g} {unit}"
        case Variable.TIME:
            where = f"from {a:.3g} to {b:.3g} {unit} in the records"
        case _:
            where = f"after {a:.3g} to {b:.3g} {unit} of dissipated energy"
    return f"{percent} lies {where}"
