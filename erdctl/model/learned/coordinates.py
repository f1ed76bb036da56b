"""What a learned law may depend on: quantities that motion and control give at every sample.

Each is a function of `Signals` alone. A record knows nothing of the one before it: what counts from
a beginning (travel, the largest deflection so far) counts from that of the record. The time and the
way since a turn or a step are infinite before the first one of a record.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.kernels import first_order

SPOTS = 64  # of the stroke, over each of which passes are counted

Function = Callable[[Signals], Array]


class CoordinateKind(NamedTuple):
    """One kind of coordinate: its unit, its words, and (n,) its values.

    late : whether it has a time constant, and `of` gives what a first-order lag follows
    less : the same, and the lag is taken from what it follows
    """

    unit: str
    words: str
    of: Function
    late: bool = False
    less: bool = False


def along(kind: str, s: Signals, tau: float | None) -> Array:
    """(n,) values of a coordinate, over a time constant [s] where it has one.

    Check: a duty of 1 from the beginning on, over 1 s: 1 - exp(-t), 0, 0.6321, 0.8647.
    >>> s = signals(np.zeros(3), duty=np.ones(3), step=1.0)
    >>> along("late_duty", s, 1.0).round(4).tolist()
    [0.0, 0.6321, 0.8647]
    """
    known = KINDS[kind]
    values = known.of(s)
    if not known.late:
        return values
    assert tau is not None
    lagged = _lagged(s, values, tau, at_rest=not known.less)
    return values - lagged if known.less else lagged


def _lagged(s: Signals, values: Array, tau: float, *, at_rest: bool) -> Array:
    """(n,) dy/dt = (values - y) / tau, from 0 in each record, or from its first value."""
    first = s.starts[:-1]
    initial = np.zeros(len(first)) if at_rest else values[first]
    decay = s.step / tau
    mean = 0.5 * (values + np.append(values[1:], 0.0))
    return first_order(decay, -np.expm1(-decay) * mean, initial, s.starts)


def _per_record(s: Signals, values: Array, function: Callable[[Array], Array]) -> Array:
    """(n,) what a function makes of the values of each record."""
    out = np.empty(len(s))
    for a, b in pairwise(s.starts.tolist()):
        out[a:b] = function(values[a:b])
    return out


def _since_start(s: Signals) -> Array:
    return s.t - np.repeat(s.t[s.starts[:-1]], np.diff(s.starts))


def _travel(s: Signals) -> Array:
    """(n,) way since the record began [m].

    Check: 0.1 m/s, sampled at 1 s: 0, 0.1, 0.2 m.
    >>> _travel(signals([0.1, 0.1, 0.1], step=1.0)).round(9).tolist()
    [0.0, 0.1, 0.2]
    """
    return _per_record(s, s.path[0], lambda way: np.cumsum(way) - way)


def _passes(s: Signals) -> Array:
    """(n,) how often the piston has passed the place where it is, in this record [1].

    A pass of a part of a place counts as that part of one.
    Check: to and fro over 1 m: 0 passes up to the far end, and 1 wherever it is on its way back.
    >>> x = np.array([0.0, 0.5, 1.0, 0.5, 0.0])
    >>> s = signals(np.array([1.0, 1.0, 1.0, -1.0, -1.0]), x=x, step=0.5)
    >>> _passes(s).round(1).tolist()
    [0.0, 0.0, 0.0, 1.0, 1.0]
    """
    out = np.empty(len(s))
    for a, b in pairwise(s.starts.tolist()):
        x = s.x[a:b]
        low = float(x.min())
        width = max(float(x.max()) - low, 1e-12) / SPOTS
        edges = low + width * np.arange(SPOTS)
        here = np.clip(((x - low) / width).astype(np.intp), 0, SPOTS - 1)
        covered = np.clip(x - edges[:, None], 0.0, width) / width
        count = np.zeros((SPOTS, b - a))
        np.cumsum(np.abs(np.diff(covered, axis=1)), axis=1, out=count[:, 1:])
        # Less what the present pass has covered of the place itself.
        passed = np.where(s.compressing[a:b], x - edges[here], edges[here] + width - x) / width
        before = count[here, np.arange(b - a)] - np.clip(passed, 0.0, 1.0)
        out[a:b] = np.maximum(before, 0.0)
    return out


def _so_far(values: Function) -> Function:
    """The largest size of a value since the record began."""

    def largest(s: Signals) -> Array:
        return _per_record(s, np.abs(values(s)), np.maximum.accumulate)

    return largest


KINDS: Mapping[str, CoordinateKind] = {
    "x": CoordinateKind("m", "the deflection", lambda s: s.x),
    "abs_x": CoordinateKind("m", "the size of the deflection", lambda s: np.abs(s.x)),
    "xdot": CoordinateKind("m/s", "the velocity", lambda s: s.xdot),
    "abs_xdot": CoordinateKind("m/s", "the speed", lambda s: np.abs(s.xdot)),
    "duty": CoordinateKind("1", "the duty cycle", lambda s: s.duty),
    "since_reversal": CoordinateKind(
        "s", "the time since the motion turned", lambda s: s.since_reversal
    ),
    "path_since_reversal": CoordinateKind(
        "m", "the travel since the motion turned", lambda s: s.path_since_reversal
    ),
    "since_duty_step": CoordinateKind(
        "s", "the time since the duty changed", lambda s: s.since_duty_step
    ),
    "t": CoordinateKind("s", "the time in the record", _since_start),
    "travel": CoordinateKind("m", "the travel in the record", _travel),
    "passes": CoordinateKind("1", "the passes over that place in the record", _passes),
    "largest_x": CoordinateKind("m", "the largest deflection so far", _so_far(lambda s: s.x)),
    "largest_xdot": CoordinateKind("m/s", "the largest speed so far", _so_far(lambda s: s.xdot)),
    "largest_duty": CoordinateKind("1", "the largest duty cycle so far", _so_far(lambda s: s.duty)),
    "late_duty": CoordinateKind("1", "the duty cycle of late", lambda s: s.duty, late=True),
    "late_xdot2": CoordinateKind(
        "m^2/s^2", "the squared speed of late", lambda s: s.xdot * s.xdot, late=True
    ),
    "late_flow": CoordinateKind(
        "m^2/s^2", "the squared velocity of late, with its sign",
        lambda s: s.xdot * np.abs(s.xdot), late=True,
    ),
    "fresh_x": CoordinateKind(
        "m", "the deflection beyond its mean of late", lambda s: s.x, late=True, less=True
    ),
    "fresh_duty": CoordinateKind(
        "1", "the duty cycle beyond its mean of late", lambda s: s.duty, late=True, less=True
    ),
}  # fmt: skip
