"""Faults as loss-of-effectiveness factors on the terms of the model, Eqs. 20-23.

    oil leakage    F = f1 [gas + viscous + yield]                                    (20)
    electrical     F = gas + viscous + f2 yield                                      (22)
    deformation    F = gas + f3 [viscous + yield]                                    (23)

A factor lies in 0..1; 1 is healthy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.onset import AMOUNT, RAMP, START, onset_weight

EXAMPLE = "write for instance oil=0.5@15:31 or electrical=0.8@31,ramp=2,channel=fr"


class FaultKind(Enum):
    """The three faults of Sec. 5 that act on the force, by their names in the catalogue."""

    OIL = "oil_leakage"
    ELECTRICAL = "electrical_fault"
    DEFORMATION = "deformation_fault"

    @property
    def short(self) -> str:
        """The short name on the command line."""
        return self.name.lower()

    @property
    def groups(self) -> tuple[str, ...]:
        """The forces that it takes a part of."""
        return {
            FaultKind.OIL: ("gas", "viscous", "yield"),
            FaultKind.ELECTRICAL: ("yield",),
            FaultKind.DEFORMATION: ("viscous", "yield"),
        }[self]


class Corner(Enum):
    """Which of the vehicle's four dampers."""

    FRONT_LEFT = "fl"
    FRONT_RIGHT = "fr"
    REAR_LEFT = "rl"
    REAR_RIGHT = "rr"


@dataclass(frozen=True, kw_only=True)
class Fault:
    """One fault: what fails, by how much, when.

    factor : f [1] in 0..1, constant while the fault acts; None if `flow` is given
    flow : q [m/s] > 0 of the flow-dependent leakage f1 = min(1, q / |xdot|); only for OIL
    start : [s] in the time of each record as logged; None is the first sample of the record
    end : [s], the first healthy moment again; None is never
    ramp : [s] over which f falls linearly from 1, beginning at start; 0 is at once
    """

    kind: FaultKind
    factor: float | None = None
    flow: float | None = None
    start: float | None = None
    end: float | None = None
    ramp: float = 0.0
    channel: Corner = Corner.FRONT_LEFT

    @property
    def of_field(self) -> bool:
        """Whether it takes a part of the yield force alone: none without a duty."""
        return self.kind.groups == ("yield",)

    def __str__(self) -> str:
        """The specification that `parse_fault` reads back as an equal fault."""
        size = f"{self.factor!r}" if self.flow is None else f"flow:{self.flow!r}"
        text = f"{self.kind.short}={size}"
        if self.start is not None:
            text += f"@{self.start!r}" + ("" if self.end is None else f":{self.end!r}")
        if self.ramp:
            text += f",ramp={self.ramp!r}"
        if self.channel is not Corner.FRONT_LEFT:
            text += f",channel={self.channel.value}"
        return text


@dataclass(frozen=True, eq=False)
class FaultFactors:
    """(n,) multipliers in 0..1 of the three terms of Eq. 13 [1]; all 1 is healthy."""

    gas: Array
    viscous: Array
    yield_: Array


def parse_fault(spec: str) -> Fault:
    """The fault that one `--fault` describes.

        KIND=FACTOR[@START[:END]][,ramp=SECONDS][,channel=fl|fr|rl|rr]
        oil=flow:Q[@START[:END]]...

    Raises UsageProblem that names the part that makes no sense.
    Check: "oil=0.5@15:31" is OIL, factor 0.5, from 15 s until 31 s.
    >>> f = parse_fault("oil=0.5@15:31")
    >>> f.kind.name, f.factor, f.start, f.end
    ('OIL', 0.5, 15.0, 31.0)
    """
    head, *options = (part.strip() for part in spec.split(","))
    name, equals, rest = head.partition("=")
    if not equals:
        raise _bad(spec, "no '=' between the kind of fault and its factor")
    size, at, when = rest.partition("@")
    kind = _kind(spec, name.strip())
    factor, flow = _size(spec, kind, size.strip())
    start, end = _interval(spec, when) if at else (None, None)
    ramp, channel = _options(spec, options)
    return Fault(
        kind=kind, factor=factor, flow=flow, start=start, end=end, ramp=ramp, channel=channel
    )


def on_channel(faults: Iterable[Fault], channel: Corner) -> tuple[Fault, ...]:
    """The faults of one damper."""
    return tuple(fault for fault in faults if fault.channel is channel)


def factors(faults: Sequence[Fault], t: Array, xdot: Array, starts: Index) -> FaultFactors:
    """Multipliers of the gas, viscous and yield forces, Eqs. 20, 22 and 23.

    Oil leakage acts on all three, deformation on viscous and yield, an electrical fault on yield.
    Several faults multiply, also of the same kind.

    faults : of one damper (`on_channel` picks them);  t, xdot : (n,) [s], [m/s]
    starts : (r + 1,) offsets of the records; a fault with no start begins with each of them
    Returns three (n,) arrays [1].

    Check: oil=0.5@15:31 and deformation=0.7@20 give at 25 s gas 0.5, viscous and yield 0.35; at
    31 s gas 1, viscous and yield 0.7.
    >>> both = [parse_fault("oil=0.5@15:31"), parse_fault("deformation=0.7@20")]
    >>> f = factors(both, np.array([25.0, 31.0]), np.zeros(2), np.array([0, 2]))
    >>> [a.round(9).tolist() for a in (f.gas, f.viscous, f.yield_)]
    [[0.5, 1.0], [0.35, 0.7], [0.35, 0.7]]
    """
    left = {group: np.ones(len(t)) for group in FaultKind.OIL.groups}
    for fault in faults:
        f = effectiveness(fault, t, xdot, starts)
        for group in fault.kind.groups:
            left[group] *= f
    return FaultFactors(gas=left["gas"], viscous=left["viscous"], yield_=left["yield"])


def effectiveness(fault: Fault, t: Array, xdot: Array, starts: Index) -> Array:
    """The factor f(t) of one fault.

        f = 1 + w (f_full - 1),   w = min(1, (t - start) / ramp) while start <= t < end, else 0
        f_full = factor,  or  min(1, q / |xdot|) for a leakage given by its flow

    Eq. 21 says only f1 ~ 1 / xdot: no constant, and no bound as the piston stops, where f1 <= 1
    must hold. Here q carries the constant, the speed above which the leak is felt, and the bound
    is explicit.

    t, xdot : (n,) [s], [m/s];  starts : (r + 1,).  Returns (n,) [1] in 0..1.
    Check: q = 0.05 m/s gives 1 at rest and at 0.05 m/s, 0.5 at 0.1 m/s. factor 0.5 with a ramp of
    2 s from 10 s gives 0.75 at 11 s and 0.5 from 12 s.
    >>> t, xdot, starts = np.array([10.0, 11.0, 12.0]), np.array([0.0, 0.05, 0.1]), np.array([0, 3])
    >>> effectiveness(parse_fault("oil=flow:0.05"), t, xdot, starts).round(9).tolist()
    [1.0, 1.0, 0.5]
    >>> effectiveness(parse_fault("oil=0.5@10,ramp=2"), t, xdot, starts).round(9).tolist()
    [1.0, 0.75, 0.5]
    """
    full = np.full(len(t), fault.factor) if fault.flow is None else leakage(xdot, fault.flow)
    if fault.start is None:
        since = t - np.repeat(t[starts[:-1]], np.diff(starts))
    else:
        since = t - fault.start
    weight = np.where(since >= 0, 1.0, 0.0)
    if fault.ramp > 0:
        # Before a ramp starts `since` is negative; a very short ramp may overflow to inf, clipped.
        with np.errstate(over="ignore"):
            weight = np.clip(since / fault.ramp, 0.0, 1.0)
    if fault.end is not None:
        weight[t >= fault.end] = 0.0
    # As a mean of the two ends, w = 0 is exactly healthy and w = 1 exactly the factor asked for.
    f: Array = (1.0 - weight) + weight * full
    return f


def without_effect(fault: Fault, first: float, last: float) -> str:
    """That a fault does nothing in a log from `first` to `last` [s], in words."""
    return f"{fault} does nothing in this log, from {first:.9g} to {last:.9g} s"


def set_in(kind: FaultKind, s: Signals, p: Mapping[str, float]) -> dict[str, Array]:
    """Factors by group, (n,) each [1], of a fault that sets in once and stays, as an effect.

    p : f, effectiveness that is left [1]; t_0, onset [s] in the time of each record as logged; t_r,
    time over which it falls linearly from 1 [s]
    """
    f = p[AMOUNT]
    if f == 1.0:
        return {}
    # A sample stands for a step as long as the one before it, which an exported block knows.
    weight = onset_weight(s.t, p[START], p[RAMP], s.step_before)
    factor: Array = (1.0 - weight) + weight * f
    return dict.fromkeys(kind.groups, factor)


def set_in_c(kind: FaultKind) -> CLaw:
    """The same in C, by the clock of the record where that was stated."""
    lines = [
        f"real since = (s->clock - p->{START}) - s->clock_low;",
        f"real left = K(1.0) - (K(1.0) - p->{AMOUNT}) * onset_weight(since, p->{RAMP}, s->h);",
        "",
        *(f"f->{group} *= left;" for group in kind.groups),
    ]
    return CLaw(code="\n".join(lines))


def leakage(xdot: Array, flow: float) -> Array:
    """Flow-dependent leakage f1 = min(1, q / |xdot|), Eq. 21 with its constant and its bound.

    xdot : (n,) [m/s];  flow : q [m/s] > 0.  Returns (n,) [1].
    Check: q = 0.05, xdot = 0, -0.05, 0.1 gives 1, 1, 0.5.
    >>> leakage(np.array([0.0, -0.05, 0.1]), 0.05).round(9).tolist()
    [1.0, 1.0, 0.5]
    """
    f: Array = flow / np.maximum(np.abs(xdot), flow)
    return f


def _bad(spec: str, why: str) -> UsageProblem:
    return UsageProblem(f"fault '{spec}': {why}; {EXAMPLE}")


def _kind(spec: str, name: str) -> FaultKind:
    for kind in FaultKind:
        if name in (kind.short, kind.value):
            return kind
    known = ", ".join(f"{kind.short} (or {kind.value})" for kind in FaultKind)
    raise _bad(spec, f"unknown kind '{name}', known are {known}")


def _number(spec: str, what: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise _bad(spec, f"{what} '{text}' is not a number") from None
    if not math.isfinite(value):
        raise _bad(spec, f"{what} '{text}' is not finite")
    return value


def _size(spec: str, kind: FaultKind, text: str) -> tuple[float | None, float | None]:
    if text.startswith("flow:"):
        if kind is not FaultKind.OIL:
            raise _bad(spec, f"only oil leakage can depend on the flow, not '{kind.short}'")
        flow = _number(spec, "flow", text.removeprefix("flow:").strip())
        if flow <= 0:
            raise _bad(spec, f"flow {flow:g} m/s must be above 0")
        return None, flow
    factor = _number(spec, "factor", text)
    if not 0 <= factor <= 1:
        hint = f", {factor:g} % is {factor / 100:g}" if 1 < factor <= 100 else ""
        raise _bad(spec, f"factor {factor:g} is outside 0..1 (1 is healthy{hint})")
    return factor, None


def _interval(spec: str, text: str) -> tuple[float, float | None]:
    first, colon, last = (part.strip() for part in text.partition(":"))
    start = _number(spec, "START", first)
    if not colon:
        return start, None
    end = _number(spec, "END", last)
    if end <= start:
        raise _bad(spec, f"END {end:g} s is not after START {start:g} s")
    return start, end


def _options(spec: str, options: Sequence[str]) -> tuple[float, Corner]:
    given: dict[str, str] = {}
    for option in options:
        key, _, value = (part.strip() for part in option.partition("="))
        if key not in ("ramp", "channel"):
            raise _bad(spec, f"unknown option '{key}', allowed are ramp and channel")
        if key in given:
            raise _bad(spec, f"'{key}' is given twice")
        given[key] = value
    ramp = _number(spec, "ramp", given.get("ramp", "0"))
    if ramp < 0:
        raise _bad(spec, f"ramp {ramp:g} s must not be negative")
    name = given.get("channel", Corner.FRONT_LEFT.value)
    if name not in [channel.value for channel in Corner]:
        allowed = ", ".join(channel.value for channel in Corner)
        raise _bad(spec, f"unknown channel '{name}', allowed are {allowed}")
    return ramp, Corner(name)
