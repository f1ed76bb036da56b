"""The laws that may be learned of a log: curves over every coordinate, in every place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import Candidate
from erdctl.model.learned.coordinates import KINDS, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot


def laws(problem: Problem) -> Iterator[Law]:
    """Splines over every coordinate that a log spans, in every slot.

    Of few knots and of many, where the coordinate has no time constant, and at some of these where
    it has one.
    """
    s = problem.block.signals
    longest = float((s.t[s.starts[1:] - 1] - s.t[s.starts[:-1]]).max())
    shortest = min(thresholds.LATE_STEPS * s.typical_step, longest)
    taus = np.geomspace(shortest, longest, thresholds.LATE_TIMES).tolist()
    for name, kind in KINDS.items():
        found = []
        if kind.late:
            found = [(spread(problem, name, thresholds.FEW_KNOTS, tau), tau) for tau in taus]
        else:
            counts = (thresholds.FEW_KNOTS, thresholds.MANY_KNOTS)
            many = dict.fromkeys(spread(problem, name, count, None) for count in counts)
            found = [(knots, 1.0) for knots in many]
        for knots, tau in found:
            if knots is not None:
                for slot in LawSlot:
                    yield Law(slot, Curve(name, knots, zero_first=not slot.adds, tau=tau))


def spread(problem: Problem, name: str, count: int, tau: float | None) -> tuple[float, ...] | None:
    """Knots where the samples lie, and evenly over what they span, half and half.

    Where a coordinate has so few levels, these; None where it has not three values.
    """
    z = along(name, problem.block.signals, tau)
    z = z[(problem.block.weight > 0.0) & np.isfinite(z)]
    if z.size == 0:
        return None
    part = np.linspace(0.0, 1.0, count)
    ends = thresholds.CURVE_ENDS
    dense = np.quantile(z, ends + part * (1.0 - 2.0 * ends))
    levels: Array = np.unique(z)
    if len(levels) <= count:
        return tuple(levels.tolist()) if len(levels) > 2 else None
    knots = 0.5 * (dense + dense[0] + part * (dense[-1] - dense[0]))
    return tuple(knots.tolist()) if (np.diff(knots) > 0.0).all() else None


def finer(problem: Problem, law: Law, tau: float | None) -> Law | None:
    """The same law with twice the knots; None where the log does not fill them."""
    curve, most = law.curve, thresholds.MOST_KNOTS[law.slot.adds]
    count = 2 * len(curve.knots)
    more = spread(problem, curve.coordinate, count, tau) if count <= most else None
    if more is None or len(more) <= len(curve.knots):
        return None
    return replace(law, curve=replace(curve, knots=more, tau=tau or 1.0))


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
