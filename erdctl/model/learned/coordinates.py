"""What a learned law may depend on: quantities that motion and control give at every sample.

Each is a function of `Signals` alone. A record knows nothing of the one before it: what counts from
a beginning (travel, the largest deflection so far) counts from that of the record. The time and the
way since a turn or a step are infinite before the first one of a record.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.kernels import first_order

SPOTS = 64  # of the stroke, over each of which passes are counted

Function = Callable[[Signals], Array]


class Memory(NamedTuple):
    """Of a coordinate that has one: time constant [s], and the damping ratio of what rings [1].

    Of what forgets as it goes the first is a travel [m].

    What rings has the natural frequency 1 / (2 pi tau).
    """

    tau: float
    zeta: float = 0.1

    @staticmethod
    def of(p: Mapping[str, float]) -> Memory | None:
        """That among some values; None where there is none."""
        return Memory(p["tau"], p.get("zeta", 0.1)) if "tau" in p else None


class CoordinateKind(NamedTuple):
    """One kind of coordinate: its unit, its words, and (n,) its values.

    late : whether it has a time constant, and `of` gives what a first-order lag follows
    less : the same, and the lag is taken from what it follows
    settles : `of` gives the direction, and what is left of the former one counts,
        (1 - sign lag) / 2: 1 behind a turn, and 0 where the motion has gone its way for long
    by_way : the lag is over the travel and not over the time
    steady : whether it changes no faster than the motion, so that a deflection can go with it
    rings : `of` gives what an oscillator with that time constant is driven by: "sine", as a mass on
        a spring, or "cosine", as what a measuring chain adds to what it measures
    logged : whether a log may lack it
    sides : it tells two sides apart and nothing between, which is a second coordinate only
    """

    unit: str
    words: str
    of: Function
    late: bool = False
    less: bool = False
    settles: bool = False
    by_way: bool = False
    steady: bool = False
    logged: bool = False
    sides: bool = False
    rings: str = ""

    @property
    def least(self) -> float:
        """Of a factor of a force that goes with it: behind a turn a force may still have the sign
        that it had.
        """
        return -1.0 if self.settles else 0.0

    @property
    def forgets(self) -> str:
        """Unit of what its memory goes by."""
        return "m" if self.by_way else "s"


def along(kind: str, s: Signals, memory: Memory | None) -> Array:
    """(n,) values of a coordinate, over its memory where it has one.

    Check: a duty of 1 from the beginning on, over 1 s: 1 - exp(-t), 0, 0.6321, 0.8647.
    >>> s = signals(np.zeros(3), duty=np.ones(3), step=1.0)
    >>> along("late_duty", s, Memory(1.0)).round(4).tolist()
    [0.0, 0.6321, 0.8647]
    """
    known = KINDS[kind]
    values = _plain(kind, s)
    if not known.late:
        return values
    assert memory is not None
    if known.rings:
        return _ringing(s, values, memory, cosine=known.rings == "cosine")
    at_rest = not (known.less or known.settles)
    lagged = _lagged(s, values, (s.path[0] if known.by_way else s.step) / memory.tau, at_rest)
    if known.settles:
        return 0.5 * (1.0 - s.sign * lagged)
    return values - lagged if known.less else lagged


@lru_cache(maxsize=32)
def _plain(kind: str, s: Signals) -> Array:
    """(n,) values before any memory: the same for all curves over them."""
    return KINDS[kind].of(s)


def _lagged(s: Signals, values: Array, decay: Array, at_rest: bool) -> Array:
    """(n,) what follows values by a part 1 - exp(-decay) in each step, from 0 in each record, or
    from its first value.

    With decay = h / tau it is dy/dt = (values - y) / tau.
    """
    first = s.starts[:-1]
    initial = np.zeros(len(first)) if at_rest else values[first]
    mean = 0.5 * (values + np.append(values[1:], 0.0))
    return first_order(decay, -np.expm1(-decay) * mean, initial, s.starts)


def _ringing(s: Signals, values: Array, memory: Memory, *, cosine: bool) -> Array:
    """(n,) an oscillator that changes of a value set swinging, at rest as a record begins.

        y = sum of dv exp(-zeta w t) sin(w_d t) w/w_d,   t the time since the value changed by dv
        y = -sum of dv exp(-zeta w t) (cos(w_d t) + zeta w/w_d sin(w_d t))

    with w = 1/tau, w_d = w sqrt(1 - zeta^2); a change is spread over its step.
    Check: 1 m/s more within 1 ms, w = 100 1/s, zeta = 0.1: after 10 ms exp(-0.1) sin(0.995) 1.005.
    >>> v = np.ones(12)
    >>> v[0] = 0.0
    >>> y = _ringing(signals(v, step=1e-3), v, Memory(0.01), cosine=False)
    >>> bool(abs(y[10] - np.exp(-0.095) * np.sin(0.945) * 1.005) < 2e-3)
    True
    """
    w = 1.0 / memory.tau
    fall, turn = memory.zeta * w, w * np.sqrt(1.0 - memory.zeta**2)
    pole = complex(-fall, turn)
    ends = s.starts[1:] - 1
    change = np.append(np.diff(values), 0.0)
    change[ends] = 0.0
    step = np.maximum(s.step, 1e-12)
    since = _since_start(s)
    phase = turn * np.append(since[1:], since[-1])
    pushed = change * np.expm1(pole * step) / (pole * step) * np.exp(-1j * phase)
    zero = np.zeros(len(ends))
    parts = [
        first_order(fall * s.step, part, zero, s.starts) for part in (pushed.real, pushed.imag)
    ]
    z = (parts[0] + 1j * parts[1]) * np.exp(1j * turn * since)
    ratio = memory.zeta * w / turn
    return np.asarray(-(z.real + ratio * z.imag) if cosine else z.imag * w / turn)


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


def _field_travel(s: Signals) -> Array:
    """(n,) travel since the record began times the duty at which it went [m].

    The work of a yield force of 1 N at full duty.
    """
    way, duty = s.path[0], s.duty
    return _per_record(s, way * duty, lambda w: np.cumsum(w) - w)


def _flow_work(s: Signals) -> Array:
    """(n,) integral of xdot^2 since the record began [m^2/s]: the work of 1 N s/m.

    Check: 2 m/s over 1 s a step: 0, 4, 8.
    >>> _flow_work(signals([2.0, 2.0, 2.0], step=1.0)).tolist()
    [0.0, 4.0, 8.0]
    """
    return _per_record(s, s.step * s.xdot**2, lambda w: np.cumsum(w) - w)


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


def _temperature(s: Signals) -> Array:
    if s.temperature is None:
        raise InputProblem(
            "a law of the model is one of the temperature, which the log does not have; expected a"
            " column temperature [degC]"
        )
    return s.temperature


def _so_far(values: Function) -> Function:
    """The largest size of a value since the record began."""

    def largest(s: Signals) -> Array:
        return _per_record(s, np.abs(values(s)), np.maximum.accumulate)

    return largest


KINDS: Mapping[str, CoordinateKind] = {
    "x": CoordinateKind("m", "the deflection", lambda s: s.x, steady=True),
    "abs_x": CoordinateKind("m", "the size of the deflection", lambda s: np.abs(s.x)),
    "direction": CoordinateKind("1", "the direction", lambda s: s.sign, sides=True),
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
    "t": CoordinateKind("s", "the time in the record", _since_start, steady=True),
    "travel": CoordinateKind("m", "the travel in the record", _travel, steady=True),
    "field_travel": CoordinateKind(
        "m", "the travel under the field in the record", _field_travel, steady=True
    ),
    "flow_work": CoordinateKind(
        "m^2/s", "the squared speed added up in the record", _flow_work, steady=True
    ),
    "passes": CoordinateKind("1", "the passes over that place in the record", _passes),
    "largest_x": CoordinateKind("m", "the largest deflection so far", _so_far(lambda s: s.x)),
    "largest_xdot": CoordinateKind("m/s", "the largest speed so far", _so_far(lambda s: s.xdot)),
    "largest_duty": CoordinateKind("1", "the largest duty cycle so far", _so_far(lambda s: s.duty)),
    "temperature": CoordinateKind(
        "degC", "the temperature", _temperature, steady=True, logged=True
    ),
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
    "unsettled_time": CoordinateKind(
        "1", "what time has left of the former direction", lambda s: s.sign, late=True,
        settles=True,
    ),
    "unsettled_way": CoordinateKind(
        "1", "what travel has left of the former direction", lambda s: s.sign, late=True,
        settles=True, by_way=True,
    ),
    "ringing_xdot": CoordinateKind(
        "m/s", "the swing of a mass that the velocity moves", lambda s: s.xdot, late=True,
        rings="sine",
    ),
    "ringing_field": CoordinateKind(
        "1", "the ringing after a jump of the field's force", lambda s: s.duty * s.sign, late=True,
        rings="cosine",
    ),
    "fresh_duty": CoordinateKind(
        "1", "the duty cycle beyond its mean of late", lambda s: s.duty, late=True, less=True
    ),
}  # fmt: skip
