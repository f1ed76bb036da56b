"""The laws that may be learned of a log: curves over every coordinate, in every place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import Candidate
from erdctl.model.learned.coordinates import KINDS, CoordinateKind, Memory, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.learned.surface import Surface


def laws(problem: Problem) -> Iterator[Law]:
    """Splines over every coordinate that a log spans, in every slot.

    Of few knots and of many, where the coordinate has no time constant, and at some of these where
    it has one.
    """
    s = problem.block.signals
    longest = float((s.t[s.starts[1:] - 1] - s.t[s.starts[:-1]]).max())
    shortest = min(thresholds.LATE_STEPS * s.typical_step, longest)
    taus = np.geomspace(shortest, longest, thresholds.LATE_TIMES).tolist()
    stroke = float(np.ptp(s.x))
    ways = np.geomspace(thresholds.LEAST_OF_STROKE * stroke, stroke, thresholds.LATE_TIMES).tolist()
    ends = thresholds.RING_STEPS * s.typical_step, thresholds.RING_LONGEST * longest
    rates = np.geomspace(min(ends), ends[1], thresholds.RING_TIMES).tolist()
    for name, kind in _told(problem):
        if kind.sides:
            continue
        found = []
        if kind.late:
            times = rates if kind.rings else ways if kind.by_way else taus
            few = thresholds.FEW_KNOTS
            found = [(spread(problem, name, few, Memory(tau)), tau) for tau in times]
        else:
            counts = (thresholds.FEW_KNOTS, thresholds.MANY_KNOTS)
            many = dict.fromkeys(spread(problem, name, count, None) for count in counts)
            found = [(knots, 1.0) for knots in many]
        for knots, tau in found:
            if knots is not None:
                for slot in _places(problem, name):
                    yield Law(slot, Curve(name, knots, zero_first=not slot.adds, tau=tau))


def _told(problem: Problem) -> Iterator[tuple[str, CoordinateKind]]:
    """The coordinates that the log has."""
    for name, kind in KINDS.items():
        if not kind.logged or problem.block.signals.temperature is not None:
            yield name, kind


def _places(problem: Problem, name: str) -> Iterator[LawSlot]:
    """The slots in which a law of a coordinate may act, as far as a log tells.

    A deflection changes no faster than the motion; a time constant that nothing tells has no law;
    what rings is a force.
    """
    for slot in LawSlot:
        lags = [f"{d}.T_d" in problem.held for d in DIRECTIONS]
        told = slot is not LawSlot.LAG or not all(lags)
        kind = KINDS[name]
        if kind.rings and slot is not LawSlot.FORCE:
            continue
        if told and (slot is not LawSlot.DEFLECTION or kind.steady):
            yield slot


def plain_laws(problem: Problem) -> Iterator[Law]:
    """One law of each coordinate without memory in each slot behind the lag, to go on from."""
    for name, kind in _told(problem):
        knots = spread(problem, name, thresholds.KNOTS_ACROSS, None) if not kind.late else None
        if knots is not None and not kind.sides:
            for slot in LawSlot:
                if slot.adds or slot.groups:
                    yield Law(slot, Curve(name, knots))


def surfaces(problem: Problem, law: Law, memory: Memory | None) -> Iterator[Law]:
    """Laws in the same slot over the coordinate of one and a second one, of few knots each."""
    curve, few = law.curve, thresholds.KNOTS_ACROSS
    first = spread(problem, curve.coordinate, few, memory)
    for name, kind in _told(problem):
        if kind.late or name.removeprefix("abs_") == curve.coordinate.removeprefix("abs_"):
            continue
        second = (-1.0, 1.0) if kind.sides else spread(problem, name, few, None, least=2)
        if first is not None and second is not None:
            of = Surface(
                curve.coordinate, first, zero_first=not law.slot.adds,
                tau=curve.tau,
                across=Curve(name, second),
            )  # fmt: skip
            yield replace(law, curve=of)


def spread(
    problem: Problem, name: str, count: int, memory: Memory | None, least: int = 3
) -> tuple[float, ...] | None:
    """Knots where the samples lie, and evenly over what they span, half and half.

    Where a coordinate has so few levels, these; None where it has not as many as it must at least.
    """
    z = along(name, problem.block.signals, memory)
    z = z[(problem.block.weight > 0.0) & np.isfinite(z)]
    if z.size == 0:
        return None
    levels = _levels(z)
    if len(levels) <= count:
        return tuple(levels.tolist()) if len(levels) >= least else None
    part = np.linspace(0.0, 1.0, count)
    ends = thresholds.CURVE_ENDS
    dense = np.quantile(z, ends + part * (1.0 - 2.0 * ends))
    knots = 0.5 * (dense + dense[0] + part * (dense[-1] - dense[0]))
    return tuple(knots.tolist()) if (np.diff(knots) > 0.0).all() else None


def _levels(z: Array) -> Array:
    """The (k,) levels about which samples (n,) lie, or every value where these are no levels.

    Levels that a log writes with its last digits, or with noise, are one: a curve through two
    values of nearly one place has any value beside it.

    Check: 0.1 + 0.2 is 0.3 but for the last digit, so that these are 0.0, 0.3 and 0.5.
    >>> _levels(np.array([0.0, 0.3, 0.1 + 0.2, 0.5, 0.0])).round(12).tolist()
    [0.0, 0.3, 0.5]
    """
    values = np.unique(z)
    steps = np.diff(values)
    cut = steps > thresholds.SAME_LEVEL * (values[-1] - values[0])
    groups = np.split(values, np.flatnonzero(cut) + 1)
    widest = max(float(np.ptp(g)) for g in groups)
    if not cut.any() or widest > thresholds.LEVEL_WIDTH * float(steps[cut].min()):
        return values
    return np.array([0.5 * (g[0] + g[-1]) for g in groups])


def finer(problem: Problem, law: Law, memory: Memory | None) -> Law | None:
    """The same law with twice the knots; None where the log does not fill them."""
    curve, most = law.curve, thresholds.MOST_KNOTS[law.slot.adds]
    count = 2 * len(curve.knots)
    more = spread(problem, curve.coordinate, count, memory) if count <= most else None
    if more is None or len(more) <= len(curve.knots):
        return None
    return replace(law, curve=replace(curve, knots=more, tau=memory.tau if memory else 1.0))


def swings(problem: Problem, frequency: float) -> Iterator[Candidate]:
    """Laws that swing in time at the frequency of a line that the rest holds [Hz]."""
    s = problem.block.signals
    longest = float((s.t[s.starts[1:] - 1] - s.t[s.starts[:-1]]).max())
    for slot in LawSlot:
        effect = Law(slot, Curve("t", (0.0, longest), "swing")).effect
        size = thresholds.SWING * (float(np.ptp(problem.block.force)) if slot.adds else 1.0)
        starts = tuple(
            {effect.key("a"): size, effect.key("n"): frequency, effect.key("p"): phase}
            for phase in thresholds.PHASES
        )
        yield Candidate(effect, 0.0, starts)
