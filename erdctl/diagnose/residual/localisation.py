"""Where a misfit lives: the variables and the intervals in which its energy exceeds its time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from erdctl.core.messages import duration, plain
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.model.effect import Effect, Variable
from erdctl.model.onset import START
from erdctl.model.slots import Values

UNITS = {
    Variable.XDOT: (1e3, "mm/s"),
    Variable.X: (1e3, "mm"),
    Variable.DUTY: (1e2, "%"),
    Variable.TIME: (1.0, "s"),
    Variable.SINCE_REVERSAL: (1e3, "ms"),
    Variable.SINCE_DUTY_STEP: (1e3, "ms"),
    Variable.ENERGY: (1.0, "J"),
    Variable.RECORD: (1.0, ""),
}

TWO_SIDED = (Variable.X, Variable.XDOT)  # what has both ends or both directions


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
    """(n,) values of every variable over which a misfit can gather; inf where there is none.

    Not the record, which no physics knows.
    """
    start = np.repeat(signals.starts[:-1], np.diff(signals.starts))
    power = np.maximum(force * signals.xdot, 0.0) * signals.step
    energy = np.cumsum(power)
    energy -= energy[start] - power[start]
    return {
        Variable.XDOT: signals.xdot,
        Variable.X: signals.x,
        Variable.DUTY: np.round(signals.duty, thresholds.DUTY_DIGITS),
        Variable.TIME: signals.t,
        Variable.SINCE_REVERSAL: signals.since_reversal,
        Variable.SINCE_DUTY_STEP: signals.since_duty_step,
        Variable.ENERGY: energy,
    }


def locate(problem: Problem, square: Array) -> list[Region]:
    """Regions in which a squared misfit (n,) [N^2] gathers, the sharpest first; none if nowhere.

    Both ends of the stroke, or both directions, are two regions of one variable, one after the
    other, the one with more of the misfit first.
    """
    weight = problem.block.weight
    energy = weight * square
    total = float(energy.sum())
    if total <= 0.0:
        return []
    found = []
    for variable, values in variables(problem.block.signals, problem.block.force).items():
        regions = _intervals(variable, values, energy / total, weight / weight.sum())
        if regions:
            found.append(regions)
    found.sort(key=excess, reverse=True)
    return [r for regions in found for r in regions]


def excess(regions: Sequence[Region]) -> float:
    """By how much the misfit in some regions exceeds their part of the time."""
    return sum(r.share - r.time for r in regions)


def points(regions: Sequence[Region], values: Array) -> bool:
    """Whether regions of a variable (n,) are narrow enough to point at something."""
    least, most = np.quantile(values, thresholds.REGION_RANGE)
    widest = thresholds.REGION_WIDEST * float(most - least)
    return all(
        r.time < thresholds.REGION_WIDEST and min(r.high, most) - max(r.low, least) <= widest
        for r in regions
    )


def since_onset(
    problem: Problem, effects: Sequence[Effect], values: Values, square: Array
) -> list[Region]:
    """From the onset on, for each effect that sets in at a time: there it acts, and only there.

    square : (n,) squared misfit [N^2], of which the region has its share. It may be less than the
        region's part of the time: a model that was fitted to before and after alike misses the
        shorter of the two by more.
    """
    s = problem.block.signals
    end = float(s.t.max())
    found = []
    for effect in effects:
        t_0 = values[effect.key(START)] if effect.sets_in else end
        if t_0 < end:
            inside = s.t >= t_0
            share, time = shares(problem, inside, square)
            low = max(t_0, float(s.t.min()))
            text = said(share, time, f"from {plain(low, 4)} s to the end of the records")
            found.append(Region(Variable.TIME, low, end, share, time, text))
    return found


def record_region(problem: Problem, square: Array) -> Region | None:
    """The record in which a squared misfit (n,) [N^2] gathers; None if in no single one."""
    names = problem.recording.names
    if len(names) == 1:
        return None
    number = np.repeat(np.arange(len(names)), np.diff(problem.recording.starts))
    weight = problem.block.weight
    energy = np.bincount(number, weight * square, len(names))
    time = np.bincount(number, weight, len(names))
    if energy.sum() <= 0.0:
        return None
    energy, time = energy / energy.sum(), time / time.sum()
    at = int((energy - time).argmax())
    share, spent = float(energy[at]), float(time[at])
    if share < thresholds.REGION_SHARE or share - spent < thresholds.REGION_EXCESS:
        return None
    text = said(share, spent, f"in record '{names[at]}'")
    return Region(Variable.RECORD, at + 1.0, at + 1.0, share, spent, text)


def _intervals(variable: Variable, values: Array, energy: Array, time: Array) -> list[Region]:
    """The interval whose share of the energy exceeds its share of the time by most.

    Or one on either side of rest or of the middle of the stroke, if two are ahead by enough.
    """
    finite = np.isfinite(values) & (time > 0)
    v, e, w = values[finite], energy[finite], time[finite]
    if v.size == 0 or v.min() == v.max():
        return []
    order = np.argsort(v, kind="stable")
    v, e, w = v[order], e[order], w[order]
    passed = np.cumsum(w)
    edges = np.unique(
        v[np.searchsorted(passed, np.linspace(0.0, passed[-1], thresholds.REGION_CELLS + 1)[1:-1])]
    )
    edges = np.unique(np.concatenate([[v[0]], edges, [v[-1]]]))
    at = np.searchsorted(v, edges, side="left")
    at[-1] = len(v)
    E = np.concatenate([[0.0], np.cumsum(e)])[at]
    W = np.concatenate([[0.0], passed])[at]
    ahead = E - W
    runs = [_most(ahead)]
    if variable in TWO_SIDED:
        middle = 0.0 if variable is Variable.XDOT else 0.5 * float(v[0] + v[-1])
        two = _either_side(ahead, int(np.searchsorted(edges, middle)))
        one, both = (sum(ahead[j] - ahead[i] for i, j in found) for found in (runs, two))
        if both - one >= thresholds.REGION_SECOND:
            runs = two
    found = []
    for i, j in runs:
        share, spent = float(E[j] - E[i]), float(W[j] - W[i])
        # Half way to what lies outside: levels of a duty have no width of their own.
        a, b = int(at[i]), int(at[j])
        low = float(v[0] if a == 0 else 0.5 * (v[a - 1] + v[a]))
        high = float(v[-1] if b == len(v) else 0.5 * (v[b - 1] + v[b]))
        text = said(share, spent, describe(variable, low, high))
        found.append(Region(variable, low, high, share, spent, text))
    share = sum(r.share for r in found)
    gathers = share >= thresholds.REGION_SHARE and excess(found) >= thresholds.REGION_EXCESS
    if not gathers or not points(found, v):
        return []
    return sorted(found, key=lambda r: r.time - r.share)


def _most(ahead: Array) -> tuple[int, int]:
    """Ends i < j of the run that gains most, ahead[j] - ahead[i]."""
    lowest = np.minimum.accumulate(ahead)
    j = 1 + int(np.argmax(ahead[1:] - lowest[:-1]))
    return int(np.argmin(ahead[:j])), j


def _either_side(ahead: Array, middle: int) -> list[tuple[int, int]]:
    """The run that gains most on either side of a place; none on a side that is not there."""
    lower, upper = ahead[: middle + 1], ahead[middle:]
    out = [_most(lower)] if len(lower) > 1 else []
    if len(upper) > 1:
        i, j = _most(upper)
        out.append((middle + i, middle + j))
    return out


def shares(problem: Problem, inside: NDArray[np.bool_], square: Array) -> tuple[float, float]:
    """Share of a squared misfit, and of the time, at some samples (n,)."""
    weight = problem.block.weight
    parts = (w[inside].sum() / max(w.sum(), 1e-300) for w in (weight * square, weight))
    share, time = map(float, parts)
    return share, time


def said(share: float, time: float, where: str) -> str:
    """A place in words, with its part of the misfit and of the time."""
    return f"{100 * share:.0f} % of the misfit lies {where}, in {100 * time:.0f} % of the time"


def describe(variable: Variable, low: float, high: float) -> str:
    """An interval in an engineer's words."""
    scale, unit = UNITS[variable]
    a, b = plain(low * scale), plain(high * scale)
    match variable:
        case Variable.SINCE_REVERSAL | Variable.SINCE_DUTY_STEP:
            of = "reversal" if variable is Variable.SINCE_REVERSAL else "duty step"
            where = f"within {duration(high)} of a {of}"
            where = where if low <= 0.2 * high else f"{_span(low, high)} after a {of}"
        case Variable.XDOT if min(-low, high) > 0.2 * max(-low, high):
            where = f"at speeds from {a} to {b} {unit}, around reversal"
        case Variable.XDOT:
            side = "compression" if high > -low else "release"
            where = f"in {side}, at {a} to {b} {unit}"
        case Variable.DUTY:
            where = f"at {a} to {b} {unit} duty"
        case Variable.X:
            where = f"at deflections from {a} to {b} {unit}"
        case Variable.TIME:
            # As logged: it may begin anew with each record, or run on over them.
            where = f"where t is from {a} to {b} {unit}"
        case _:
            where = f"after {a} to {b} {unit} of dissipated energy"
    return where


def _span(low: float, high: float) -> str:
    """Two times in one unit, that of the later one.

    Check: 0.3 to 1.2 s are no 300 ms to 1.2 s.
    >>> _span(0.3, 1.2), _span(0.03, 0.12)
    ('0.3 to 1.2 s', '30 to 120 ms')
    """
    last = duration(high)
    return f"{plain(low if last.endswith(' s') else 1e3 * low)} to {last}"
