"""How much of an effect there is: one parameter that says so, and ways from none of it to some."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import starts
from erdctl.model.effect import Effect


def amount_of(effect: Effect) -> Quantity:
    """The parameter that says how much of an effect there is: the first that its start turns on.

    >>> from erdctl.effects import get
    >>> amount_of(get("end_stop")).symbol, amount_of(get("cavitation")).symbol
    ('k_c', 'x_v')
    """
    on = [q for q in effect.quantities if _grows(effect, q)]
    return next((q for q in on if not q.linear), (on or list(effect.quantities))[0])


def _grows(effect: Effect, q: Quantity) -> bool:
    """Whether a parameter is more where there is more of the effect; any other is a shape."""
    shapes = dict(effect.earlier)  # of a form that came later: they add to what is there
    return q.start != q.off and q.symbol not in shapes


def ways(effect: Effect, problem: Problem, residual: Array) -> list[dict[str, float]]:
    """Values that an effect may have, by symbol: one for each shape, spread over its starts.

    residual : (n,) of the model without the effect [N]
    """
    ways_ = dict[tuple[float, ...], list[dict[str, float]]]()
    on = amount_of(effect)
    for start in starts(effect, problem, residual):
        values = {q.symbol: start.get(q.symbol, q.start) for q in effect.quantities}
        much = values[on.symbol] - on.off
        if much == 0.0:
            continue
        shape = [
            (values[q.symbol] - q.off) / (much if _grows(effect, q) else 1.0)
            for q in effect.quantities if not q.linear
        ]  # fmt: skip
        ways_.setdefault(tuple(float(f"{v:.6g}") for v in shape), []).append(values)
    # Of a way that several starts go along the first has least of it: in the end forces stop
    # growing with what makes them.
    apart = [min(same, key=lambda v: abs(v[on.symbol] - on.off)) for same in ways_.values()]
    count = thresholds.SIZE_SHAPES
    if len(apart) <= count:
        return apart
    return [apart[(2 * i + 1) * len(apart) // (2 * count)] for i in range(count)]


def point(effect: Effect, way: Mapping[str, float], s: float) -> dict[str, float]:
    """Values by symbol a part s of the way from off, or beyond; those that are a shape stay.

    A force that a nonlinear effect adds besides is what a fit solves for, and stays off.
    """
    linear = is_linear(effect)

    def value(q: Quantity) -> float:
        if not _grows(effect, q):
            return way[q.symbol]
        return q.off if q.linear and not linear else q.off + s * (way[q.symbol] - q.off)

    return {q.symbol: value(q) for q in effect.quantities}


def span(effect: Effect, way: Mapping[str, float]) -> tuple[float, float]:
    """Least and largest s that keep all parameters within their bounds."""
    low, high = 0.0, inf
    for q in effect.quantities:
        step = way[q.symbol] - q.off
        if not _grows(effect, q) or step == 0.0:
            continue
        ends = sorted(((q.low - q.off) / step, (q.high - q.off) / step))
        low, high = max(low, ends[0]), min(high, ends[1])
    return low, high


def is_linear(effect: Effect) -> bool:
    """Whether the force grows in proportion to the effect."""
    return all(q.linear for q in effect.quantities if _grows(effect, q))
